//! Weights of actions that fade in and out.

use crate::stage::ease::smooth;
use crate::stage::script::StageScript;
use crate::stage::time::StageTime;

/// When an action is active, and how it fades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ActiveSpan {
    pub(super) action: usize,
    pub(super) begin: StageTime,
    pub(super) stop: StageTime,
    pub(super) fade_in: StageTime,
    pub(super) fade_out: StageTime,
    /// Whether it is released at its stop; otherwise it holds its last state.
    pub(super) is_released: bool,
}

impl ActiveSpan {
    /// Creates the span of an action. Without the attribute `fill` it is released if `releases`, or if it fades out.
    pub(super) fn new(
        action: usize,
        script: &StageScript,
        [begin, stop]: [StageTime; 2],
        releases: bool,
    ) -> Self {
        let element = script.element(action);
        let time = |name: &str| script.time(element, name).unwrap_or_default();
        let (fade_in, fade_out) = (time("fade-in"), time("fade-out"));
        let is_released = script.is_released(element, fade_out, releases);
        Self { action, begin, stop, fade_in, fade_out, is_released }
    }

    /// Returns the weight at `time`: 0 before the start and, if it is released, from the stop on.
    pub(super) fn weight(&self, time: StageTime) -> f64 {
        if time < self.begin || (self.is_released && time >= self.stop) {
            return 0.0;
        }
        let share = |part: StageTime, whole: StageTime| {
            if part < whole { smooth(part.ticks() as f64 / whole.ticks() as f64) } else { 1.0 }
        };
        let fading_in = share(time - self.begin, self.fade_in);
        if self.is_released { fading_in * share(self.stop - time, self.fade_out) } else { fading_in }
    }

    /// Returns the time since the start; that at the stop after it.
    pub(super) fn after(&self, time: StageTime) -> StageTime {
        time.min(self.stop) - self.begin
    }
}
