//! Plays the sounds of what is open along the playhead.

use crate::panels::scene::SceneSound;
use crate::panels::status::MessageSeverity;
use crate::panels::{PanelContext, State};
use dragonfly_anim::stage::StagePlan;
use dragonfly_document::{FileView, SoundSource};
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_runtime::{Address, Job, JobContext};
use dragonfly_sound::{
    MOST_SOUND_BYTES, MixedSounds, OutputCommand, OutputError, SoundClock, SoundMix, SoundOutput,
    SoundSamples,
};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Least length of the piece of sound at a new time of a paused playhead, seconds.
const PIECE: f64 = 0.04;

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
    /// The sounds of what is open, found when something plays.
    sounds: Option<AudibleSounds>,
    /// Grows when other sounds are open, and when more samples are known.
    revision: u64,
    /// The time that the device follows, and the revision of its sounds.
    played: Option<(PlaybackClock, u64)>,
    /// Whether the playhead moved by itself the last time.
    was_playing: bool,
    /// The file and the time of the paused playhead the last time, seconds.
    paused_at: Option<(*const FileView, f64)>,
}

/// The state of the audio device.
enum PlayerOutput {
    Unopened,
    Open(SoundOutput),
    /// It does not work. It is tried again when something is played the next time.
    Failed,
}

/// The sounds of what is open.
#[derive(Clone, Debug)]
enum AudibleSounds {
    /// Those of a scene, in the order of its plan, and the file in whose folder they are.
    Scene(Arc<StagePlan>, Arc<FileView>, Vec<SoundSource>),
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
            let sources = plan.sounds().iter().map(|sound| source(&sound.source)).collect();
            return Some(Self::Scene(Arc::clone(plan), Arc::clone(&read.view?.file), sources));
        }
        let settings = read.sound.settings();
        read.sound.peaks().filter(|_| settings.is_chosen())?;
        Some(Self::Take(begin_of_take(read), SoundSource::File(settings.file.clone())))
    }

    fn sources(&self) -> &[SoundSource] {
        match self {
            Self::Scene(_, _, sources) => sources,
            Self::Take(_, source) => std::slice::from_ref(source),
        }
    }

    /// Returns whether these are the sounds of what is open. Allocates nothing.
    fn is_of(&self, read: &PanelContext<'_>) -> bool {
        match (self, read.scene()) {
            (Self::Scene(plan, file, _), Some(scene)) => {
                let is_same = |own: &Arc<StagePlan>| Arc::ptr_eq(own, plan);
                scene.plan.as_ref().is_some_and(is_same)
                    && read.view.is_some_and(|view| Arc::ptr_eq(&view.file, file))
            }
            (Self::Take(begin, SoundSource::File(file)), None) => {
                read.sound.peaks().is_some()
                    && read.sound.settings().file == *file
                    && begin_of_take(read) == *begin
            }
            (Self::Take(..), _) | (Self::Scene(..), None) => false,
        }
    }
}

/// Returns when the sound of a take begins, seconds.
fn begin_of_take(read: &PanelContext<'_>) -> f64 {
    f64::from(read.sound.settings().start) / f64::from(read.frame_rate.max(1))
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
            sounds: None,
            revision: 0,
            played: None,
            was_playing: false,
            paused_at: None,
        }
    }

    /// Follows the playhead, and starts to read samples that are missing. While the playhead does not move by itself, a short piece is played at each new
    /// time of it, where the settings have that.
    pub fn update(&mut self, state: &mut State, to: &Address<SamplesAnswer>) {
        let read = state.read();
        let clock = read.playback;
        let is_playing = clock.moves(read.now);
        let scrubbed = match is_playing {
            true => None,
            false => self.scrubbed_to(&read),
        };
        self.was_playing = is_playing;
        if !is_playing {
            // A piece ends by itself.
            self.stop();
            if scrubbed.is_none() {
                return;
            }
        }
        let read = state.read();
        if !self.sounds.as_ref().is_some_and(|sounds| sounds.is_of(&read)) {
            self.sounds = AudibleSounds::of(&read);
            let sources = self.sounds.as_ref().map_or(&[][..], AudibleSounds::sources);
            self.samples.retain(|source, _| sources.contains(source));
            self.revision += 1;
        }
        if self.sounds.is_none() {
            return self.stop();
        }
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
        self.read_next(state, to);
        if let Some(time) = scrubbed {
            let piece = (1.0 / state.read().frames_per_second().max(1.0)).max(PIECE);
            let command = self.command(SoundClock {
                begun: Instant::now(),
                time_at: piece_clock(time, piece),
                speed: 1.0,
            });
            self.send(command, Some(state));
        } else if self.played != Some((clock, self.revision)) {
            self.play(state, clock);
        }
    }

    /// Returns the time of a paused playhead, seconds, if the user has put it there since the last time.
    fn scrubbed_to(&mut self, read: &PanelContext<'_>) -> Option<f64> {
        let file = read.view.map_or(std::ptr::null(), |view| Arc::as_ptr(&view.file));
        let now = (file, read.playback.seconds_at(read.now));
        let before = self.paused_at.replace(now);
        if std::mem::take(&mut self.was_playing) {
            // The device is tried again with the next playback.
            if matches!(self.output, PlayerOutput::Failed) {
                self.output = PlayerOutput::Unopened;
            }
            return None;
        }
        let is_moved = before.is_some_and(|before| before.0 == now.0 && before.1 != now.1);
        (is_moved && read.settings.scrub_sounds).then_some(now.1)
    }

    /// Receives the samples of a sound.
    pub fn receive(&mut self, state: &mut State, (source, samples): SamplesAnswer) {
        self.reading = None;
        let used: usize = self.samples.values().flatten().map(|samples| samples.bytes()).sum();
        let samples = samples.and_then(|samples| match used + samples.bytes() <= MOST_SOUND_BYTES {
            true => Ok(Arc::new(samples)),
            false => Err(format!("the sounds of this scene are longer than {} MB", MOST_SOUND_BYTES >> 20)),
        });
        if let Err(reason) = &samples {
            state.say(MessageSeverity::Warning, format!("A sound is not played: {reason}"));
        }
        self.samples.insert(source, samples.ok());
        self.revision += 1;
    }

    fn samples_of(&self, source: &SoundSource) -> Option<&Arc<SoundSamples>> {
        self.samples.get(source)?.as_ref()
    }

    /// Reads the next sound whose waveform is known, so that its file can be read.
    fn read_next(&mut self, state: &State, to: &Address<SamplesAnswer>) {
        let Some(sounds) = self.sounds.as_ref().filter(|_| self.reading.is_none()) else { return };
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

    fn play(&mut self, state: &mut State, clock: PlaybackClock) {
        let begun = Instant::now();
        let time_at = move |passed| clock.seconds_at(begun + passed);
        let speed = f64::from(clock.speed);
        let command = self.command(SoundClock { begun, time_at: Box::new(time_at), speed });
        self.played = Some((clock, self.revision));
        self.send(command, Some(state));
    }

    /// Returns the command that plays the sounds of what is open along a clock.
    fn command(&self, clock: SoundClock) -> OutputCommand {
        let samples = |source: &SoundSource| self.samples_of(source).cloned();
        let sounds = self.sounds.as_ref().and_then(|sounds| match sounds {
            AudibleSounds::Scene(plan, _, sources) => Some(MixedSounds::Scene {
                plan: Arc::clone(plan),
                samples: sources.iter().map(samples).collect(),
            }),
            AudibleSounds::Take(begin, source) => {
                samples(source).map(|samples| MixedSounds::Take { begin: *begin, samples })
            }
        });
        match sounds {
            Some(sounds) => OutputCommand::Play(Box::new(SoundMix::new(sounds)), clock),
            None => OutputCommand::Stop,
        }
    }

    fn stop(&mut self) {
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

/// Returns a clock for `piece` seconds from `time` on, which stops after that: no sound is mixed then. It begins when the device first asks, since devices are
/// later than the playhead by about a piece.
fn piece_clock(time: f64, piece: f64) -> Box<dyn Fn(Duration) -> f64 + Send> {
    let first: Cell<Option<Duration>> = Cell::new(None);
    Box::new(move |passed| {
        let begun = first.get().unwrap_or(passed);
        first.set(Some(begun));
        time + passed.saturating_sub(begun).as_secs_f64().min(piece)
    })
}
