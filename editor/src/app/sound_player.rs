//! Plays the sounds of what is open along the playhead.

use crate::panels::scene::SceneSound;
use crate::panels::status::MessageSeverity;
use crate::panels::{PanelContext, State};
use dragonfly_anim::stage::StagePlan;
use dragonfly_document::SoundSource;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_runtime::{Address, Job, JobContext};
use dragonfly_sound::{
    MixedSounds, OutputCommand, OutputError, SoundClock, SoundMix, SoundOutput, SoundSamples,
};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use std::time::Instant;

/// Memory for the samples of all sounds of what is open, bytes.
const MOST_BYTES: usize = 512 << 20;

/// The answer of a job: a sound, and its samples.
pub type SamplesAnswer = (SoundSource, Result<SoundSamples, String>);

/// Opens the audio device.
type OpenOutput = Box<dyn Fn() -> Result<SoundOutput, OutputError>>;

/// Sends the sounds to the audio device while the playhead moves. The device is opened, and samples are read, when something with sounds is
/// played for the first time.
pub struct SoundPlayer {
    open: OpenOutput,
    output: PlayerOutput,
    /// Whether a message has explained that nothing is played.
    is_explained: bool,
    /// The samples of each sound; `None` for one that cannot be played.
    samples: BTreeMap<SoundSource, Option<Arc<SoundSamples>>>,
    reading: Option<Job>,
    /// What the device plays.
    played: Option<PlayedSounds>,
}

/// The state of the audio device.
enum PlayerOutput {
    Unopened,
    Open(SoundOutput),
    /// It does not work. It is tried again when something is played the next time.
    Failed,
}

/// Sounds with the time that they follow.
#[derive(Clone, Debug)]
struct PlayedSounds {
    clock: PlaybackClock,
    sounds: AudibleSounds,
    /// Number of sounds with samples.
    known: usize,
}

/// The sounds of what is open.
#[derive(Clone, Debug)]
enum AudibleSounds {
    /// Those of a scene, in the order of its plan.
    Scene(Arc<StagePlan>, Vec<SoundSource>),
    /// That of a take, with the time at which it begins, seconds.
    Take(f64, SoundSource),
}

impl AudibleSounds {
    /// Returns the sounds of what is open whose files could be read; `None` where there is no sound.
    fn of(read: &PanelContext<'_>) -> Option<Self> {
        if let Some(scene) = read.scene() {
            let plan = scene.plan.as_ref().filter(|plan| !plan.sounds().is_empty())?;
            let folder = read.model_folder()?;
            let source = |name: &str| SoundSource::Below { folder: folder.clone(), name: name.to_owned() };
            return Some(Self::Scene(
                Arc::clone(plan),
                plan.sounds().iter().map(|sound| source(&sound.source)).collect(),
            ));
        }
        let settings = read.sound.settings();
        read.sound.peaks().filter(|_| settings.is_chosen())?;
        let begin = f64::from(settings.start) / f64::from(read.frame_rate.max(1));
        Some(Self::Take(begin, SoundSource::File(settings.file.clone())))
    }

    fn sources(&self) -> &[SoundSource] {
        match self {
            Self::Scene(_, sources) => sources,
            Self::Take(_, source) => std::slice::from_ref(source),
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Scene(plan, sources), Self::Scene(other, others)) => {
                Arc::ptr_eq(plan, other) && sources == others
            }
            (Self::Take(begin, source), Self::Take(other, others)) => begin == other && source == others,
            (Self::Scene(..), Self::Take(..)) | (Self::Take(..), Self::Scene(..)) => false,
        }
    }
}

impl Default for SoundPlayer {
    fn default() -> Self {
        Self::with_output(SoundOutput::open)
    }
}

impl fmt::Debug for SoundPlayer {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "SoundPlayer({} sounds)", self.samples.len())
    }
}

impl SoundPlayer {
    /// Returns a player for the device that `open` opens.
    pub fn with_output(open: impl Fn() -> Result<SoundOutput, OutputError> + 'static) -> Self {
        Self {
            open: Box::new(open),
            output: PlayerOutput::Unopened,
            is_explained: false,
            samples: BTreeMap::new(),
            reading: None,
            played: None,
        }
    }

    /// Follows the playhead, and starts to read samples that are missing.
    pub fn update(&mut self, state: &mut State, to: &Address<SamplesAnswer>) {
        let read = state.read();
        let clock = read.playback;
        let sounds = AudibleSounds::of(&read).filter(|_| clock.moves(read.now));
        let Some(sounds) = sounds else { return self.stop() };
        if matches!(self.output, PlayerOutput::Unopened) {
            self.output = match (self.open)() {
                Ok(output) => PlayerOutput::Open(output),
                Err(error) => {
                    if !std::mem::replace(&mut self.is_explained, true) {
                        let text = format!("The sounds are shown and not played: {error}");
                        state.say(MessageSeverity::Info, text);
                    }
                    PlayerOutput::Failed
                }
            };
        }
        if !matches!(self.output, PlayerOutput::Open(_)) {
            return;
        }
        self.samples.retain(|source, _| sounds.sources().contains(source));
        self.read_next(state, &sounds, to);
        let known = sounds.sources().iter().filter(|source| self.samples_of(source).is_some()).count();
        let is_same = self.played.as_ref().is_some_and(|played| {
            played.clock == clock && played.known == known && played.sounds.is_same(&sounds)
        });
        if !is_same {
            self.play(state, PlayedSounds { clock, sounds, known });
        }
    }

    /// Receives the samples of a sound.
    pub fn receive(&mut self, state: &mut State, (source, samples): SamplesAnswer) {
        self.reading = None;
        let used: usize = self.samples.values().flatten().map(|samples| samples.bytes()).sum();
        let samples = samples.and_then(|samples| match used + samples.bytes() <= MOST_BYTES {
            true => Ok(Arc::new(samples)),
            false => Err(format!("the sounds of this scene are longer than {} MB", MOST_BYTES >> 20)),
        });
        if let Err(reason) = &samples {
            state.say(MessageSeverity::Warning, format!("A sound is not played: {reason}"));
        }
        self.samples.insert(source, samples.ok());
    }

    fn samples_of(&self, source: &SoundSource) -> Option<&Arc<SoundSamples>> {
        self.samples.get(source)?.as_ref()
    }

    /// Reads the next sound whose waveform is known, so that its file can be read.
    fn read_next(&mut self, state: &State, sounds: &AudibleSounds, to: &Address<SamplesAnswer>) {
        if self.reading.is_some() {
            return;
        }
        let read = state.read().scene_editing.sounds();
        let is_readable = |source: &SoundSource| match source {
            SoundSource::Below { name, .. } => matches!(read.get(name), Some(SceneSound::Read(_))),
            SoundSource::File(_) => true,
        };
        let is_missing = |source: &&SoundSource| !self.samples.contains_key(source) && is_readable(source);
        let Some(source) = sounds.sources().iter().find(is_missing).cloned() else { return };
        let (own, failed_source) = (source.clone(), source.clone());
        let work = move |job: &JobContext<SamplesAnswer>| {
            let samples = own.samples(job.cancel_flag());
            (own, samples)
        };
        let failed = move |reason: &str| (failed_source, Err(reason.to_owned()));
        match Job::start(to, "read samples of a sound", work, failed) {
            Ok(job) => self.reading = Some(job),
            Err(_) => _ = self.samples.insert(source, None),
        }
    }

    fn play(&mut self, state: &mut State, now: PlayedSounds) {
        let samples = |source: &SoundSource| self.samples_of(source).cloned();
        let sounds = match &now.sounds {
            AudibleSounds::Scene(plan, sources) => Some(MixedSounds::Scene {
                plan: Arc::clone(plan),
                samples: sources.iter().map(samples).collect(),
            }),
            AudibleSounds::Take(begin, source) => {
                samples(source).map(|samples| MixedSounds::Take { begin: *begin, samples })
            }
        };
        let command = match sounds {
            Some(sounds) => {
                let (clock, begun) = (now.clock, Instant::now());
                let time_at = move |passed| clock.seconds_at(begun + passed);
                let clock = SoundClock { begun, time_at: Box::new(time_at), speed: f64::from(clock.speed) };
                OutputCommand::Play(Box::new(SoundMix::new(sounds)), clock)
            }
            None => OutputCommand::Stop,
        };
        self.played = Some(now);
        self.send(command, Some(state));
    }

    fn stop(&mut self) {
        if matches!(self.output, PlayerOutput::Failed) {
            self.output = PlayerOutput::Unopened;
        }
        if self.played.take().is_some() {
            self.send(OutputCommand::Stop, None);
        }
    }

    /// Sends a command. Where the device does not work any more, a message explains it, and the next playback opens it again.
    fn send(&mut self, command: OutputCommand, state: Option<&mut State>) {
        let PlayerOutput::Open(output) = &self.output else { return };
        if let Err(error) = output.send(command) {
            self.output = PlayerOutput::Failed;
            if let Some(state) = state {
                state.say(MessageSeverity::Warning, format!("The sounds are not played any more: {error}"));
            }
        }
    }
}
