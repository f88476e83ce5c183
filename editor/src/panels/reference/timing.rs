//! The frame of a reference that is shown at a time of the take.

/// The times of the frames of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceTiming {
    /// Time of the take at which the first frame is shown, seconds.
    pub start: f64,
    /// Frames per second.
    pub rate: f64,
    /// Number of frames.
    pub frames: usize,
    /// Whether they start again at the end; otherwise the first and the last one are held.
    pub repeats: bool,
}

impl ReferenceTiming {
    /// Returns the index of the frame that is shown at a time, seconds.
    pub fn frame_at(&self, time: f32) -> usize {
        /// Part of a frame by which a time may be too early: times of frames are rounded.
        const SLACK: f64 = 1e-3;
        let count = self.frames.max(1) as i64;
        let at = ((f64::from(time) - self.start) * self.rate + SLACK).floor();
        let at = if at.is_finite() { at as i64 } else { 0 };
        let at = if self.repeats { at.rem_euclid(count) } else { at.max(0).min(count - 1) };
        at as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_of_the_take_shows_the_frame_of_the_reference_with_the_same_number() {
        for rate in [24.0f64, 25.0, 29.97, 30.0, 60.0, 120.0] {
            let timing = ReferenceTiming { start: 10.0 / rate, rate, frames: 5000, repeats: false };
            for frame in 0..5000u32 {
                let time = (f64::from(frame + 10) / rate) as f32;
                assert_eq!(timing.frame_at(time), frame as usize, "{rate}");
            }
        }
    }

    #[test]
    fn the_ends_are_held_or_the_frames_start_again() {
        let held = ReferenceTiming { start: 1.0, rate: 10.0, frames: 4, repeats: false };
        let frames =
            |timing: ReferenceTiming| [0.0, 0.95, 1.0, 1.25, 1.3, 1.4, 9.0].map(|at| timing.frame_at(at));
        assert_eq!(frames(held), [0, 0, 0, 2, 3, 3, 3]);
        assert_eq!(frames(ReferenceTiming { repeats: true, ..held }), [2, 3, 0, 2, 3, 0, 0]);
        assert_eq!(held.frame_at(f32::NAN), 0);
    }

    #[test]
    fn a_reference_with_another_frame_rate_keeps_its_speed() {
        // 12 frames a second under a take of 24: each is shown for two frames.
        let timing = ReferenceTiming { start: 0.0, rate: 12.0, frames: 100, repeats: false };
        let shown: Vec<usize> = (0..6u8).map(|frame| timing.frame_at(f32::from(frame) / 24.0)).collect();
        assert_eq!(shown, [0, 0, 1, 1, 2, 2]);
    }
}
