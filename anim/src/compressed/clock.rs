//! The times of the keys.

/// Evenly spaced times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrameClock {
    /// Seconds.
    pub(super) start: f32,
    /// Seconds from the first frame to the last; zero for one frame.
    pub(super) length: f32,
    /// At least one.
    pub(super) frames: u32,
}

impl FrameClock {
    /// Returns the seconds between two frames; 1 where there is only one.
    pub(super) fn interval(&self) -> f64 {
        let steps = f64::from(self.frames.saturating_sub(1));
        if steps > 0.0 && self.length > 0.0 { f64::from(self.length) / steps } else { 1.0 }
    }

    /// Returns the time of `frame` in seconds.
    #[inline(always)]
    pub(super) fn time(&self, frame: u32, interval: f64) -> f32 {
        (f64::from(self.start) + interval * f64::from(frame)) as f32
    }
}
