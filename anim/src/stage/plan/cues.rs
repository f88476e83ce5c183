//! Shots, titles, sounds and runs of effects.

use super::fade::ActiveSpan;
use crate::stage::script::StageRepeat;
use crate::stage::time::StageTime;

/// A camera that is seen from a time on.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShotCue {
    pub(super) camera: usize,
    pub(super) begin: StageTime,
    pub(super) blend: StageTime,
}

/// A title of a script.
#[derive(Clone, Debug)]
pub struct TitleCue {
    /// The text.
    pub text: Box<str>,
    /// Position in the image: 0 0 is the upper left corner, 1 1 the lower right one.
    pub at: [f32; 2],
    pub(super) span: ActiveSpan,
}

/// A sound of a script.
#[derive(Clone, Debug)]
pub struct SoundCue {
    /// The file, as the script names it.
    pub source: Box<str>,
    pub(super) gain: f64,
    pub(super) span: ActiveSpan,
    /// Length of the sound; `None` where it is not known.
    pub(super) length: Option<StageTime>,
    pub(super) repeat: StageRepeat,
}

impl SoundCue {
    /// Returns its action: a position in [`StageScript::actions`](crate::stage::script::StageScript::actions).
    pub fn action(&self) -> usize {
        self.span.action
    }

    /// Returns when it stops; the end of the script where the length of its file is not known.
    pub fn stop(&self) -> StageTime {
        self.span.stop
    }

    /// Returns the time in the sound; `None` where it does not play.
    pub(super) fn time(&self, time: StageTime) -> Option<StageTime> {
        if time < self.span.begin || time >= self.span.stop {
            return None;
        }
        let after = time - self.span.begin;
        match self.length {
            Some(length) => self.within(after, length),
            None => Some(after),
        }
    }

    /// Returns the time in a sound of this length that has played for `after`: where it repeats, it starts again at its end. `None` once it is
    /// over. For plans that do not know how long their sounds are.
    pub fn within(&self, after: StageTime, length: StageTime) -> Option<StageTime> {
        if length <= StageTime::ZERO {
            return Some(after);
        }
        let is_over = match self.repeat {
            StageRepeat::Times(times) => after >= length.times(times),
            StageRepeat::Fill => false,
        };
        (!is_over).then(|| StageTime::from_ticks(after.ticks() % length.ticks()))
    }
}

/// An effect that is on.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunCue {
    pub(super) span: ActiveSpan,
    pub(super) seed: u32,
}

/// Returns the start of the random numbers of one run of an effect: of the script's seed, the effect and the number of the run.
pub(super) fn run_seed(seed: u32, effect: &str, run: u32) -> u32 {
    // FNV-1a over all parts: a run keeps its numbers when others are added elsewhere in the script.
    let bytes = seed.to_le_bytes().into_iter().chain(effect.bytes()).chain(run.to_le_bytes());
    bytes.fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}
