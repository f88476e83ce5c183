//! The sum of all sounds that play at a time.

use super::SoundSamples;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{PlayingSound, StagePlan};
use std::sync::Arc;

/// Frames after which the loudness of each sound is computed again; between them it changes along a line.
const BLOCK: usize = 128;

/// The sounds of what is open, and when they play.
#[derive(Clone, Debug)]
pub enum MixedSounds {
    /// The sounds of a scene, in the order of [`StagePlan::sounds`]; `None` for those that cannot be played.
    Scene {
        /// The plan, which has their times.
        plan: Arc<StagePlan>,
        /// The samples.
        samples: Vec<Option<Arc<SoundSamples>>>,
    },
    /// One sound beside a take.
    Take {
        /// The time at which it begins, seconds.
        begin: f64,
        /// The samples.
        samples: Arc<SoundSamples>,
    },
}

impl MixedSounds {
    /// Writes the sounds that play at a time, seconds.
    fn playing(&self, time: f64, out: &mut Vec<PlayingSound>) {
        match self {
            Self::Scene { plan, samples } => {
                plan.playing_sounds(StageTime::from_seconds(time), out);
                // The plan may not know how long its sounds are.
                out.retain_mut(|playing_sound| {
                    let Some(Some(samples)) = samples.get(playing_sound.sound) else { return false };
                    let times = [playing_sound.seconds, samples.seconds()].map(StageTime::from_seconds);
                    let within =
                        plan.sounds().get(playing_sound.sound).and_then(|cue| cue.within(times[0], times[1]));
                    playing_sound.seconds = within.map_or(playing_sound.seconds, StageTime::seconds);
                    within.is_some()
                });
            }
            Self::Take { begin, samples } => {
                out.clear();
                let seconds = time - begin;
                if (0.0..samples.seconds()).contains(&seconds) {
                    out.push(PlayingSound { sound: 0, seconds, gain: 1.0 });
                }
            }
        }
    }

    fn samples(&self, sound: usize) -> Option<&SoundSamples> {
        match self {
            Self::Scene { samples, .. } => samples.get(sound)?.as_deref(),
            Self::Take { samples, .. } => Some(samples).filter(|_| sound == 0).map(|samples| &**samples),
        }
    }
}

/// A mix of sounds, and the memory for it.
#[derive(Clone, Debug)]
pub struct SoundMix {
    sounds: MixedSounds,
    /// The sounds that play at the start and at the end of a block.
    ends: [Vec<PlayingSound>; 2],
}

impl SoundMix {
    /// Returns the mix of these sounds. It needs no more memory later while fewer than 64 sounds play at once.
    pub fn new(sounds: MixedSounds) -> Self {
        Self { sounds, ends: [Vec::with_capacity(64), Vec::with_capacity(64)] }
    }

    /// Adds the sounds to frames of left and right: the first is at the time `from`, and each next one `step` seconds later; a negative step plays
    /// backwards. The same moments always have the same samples, up to changes of loudness within 128 frames.
    pub fn add(&mut self, from: f64, step: f64, out: &mut [[f32; 2]]) {
        let mut time = from;
        for block in out.chunks_mut(BLOCK) {
            let after = time + step * block.len() as f64;
            let [start, end] = &mut self.ends;
            self.sounds.playing(time, start);
            self.sounds.playing(after, end);
            for playing_sound in &*start {
                let Some(samples) = self.sounds.samples(playing_sound.sound) else { continue };
                // One that is over at the end of the block fades out within it, without a click.
                let last =
                    end.iter().find(|last| last.sound == playing_sound.sound).map_or(0.0, |last| last.gain);
                let at = |frame: f64| {
                    repeated(playing_sound.seconds + step * frame, samples, end, playing_sound.sound)
                };
                add(block, samples, [playing_sound.gain, last], at);
            }
            for playing_sound in &*end {
                if let Some(samples) = self.sounds.samples(playing_sound.sound)
                    && !start.iter().any(|first| first.sound == playing_sound.sound)
                {
                    // It begins within the block: before its start there is silence.
                    let back = block.len() as f64;
                    let at = |frame: f64| playing_sound.seconds + step * (frame - back);
                    add(block, samples, [playing_sound.gain; 2], at);
                }
            }
            time = after;
        }
    }
}

/// Returns a time in a sound, which starts again at its end where it still plays at the end of the block.
fn repeated(seconds: f64, samples: &SoundSamples, end: &[PlayingSound], sound: usize) -> f64 {
    let length = samples.seconds();
    let goes_on = || end.iter().any(|last| last.sound == sound);
    if length > 0.0 && !(0.0..length).contains(&seconds) && goes_on() {
        seconds.rem_euclid(length)
    } else {
        seconds
    }
}

/// Adds a sound to a block, with its loudness at the first frame and after the last one.
fn add(block: &mut [[f32; 2]], samples: &SoundSamples, gain: [f32; 2], at: impl Fn(f64) -> f64) {
    let count = block.len() as f32;
    for (number, frame) in block.iter_mut().enumerate() {
        let loud = gain[0] + (gain[1] - gain[0]) * (number as f32 / count);
        let playing_sound = samples.at(at(number as f64));
        frame[0] += playing_sound[0] * loud;
        frame[1] += playing_sound[1] * loud;
    }
}
