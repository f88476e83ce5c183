//! Settings of a frame that is the mean of several sub-frames, and their times.

use super::pixel_filter::jitter_radius;
use super::sub_frame::SubFrame;
use dragonfly_anim::stage::time::{LONGEST, StageRate, StageTime};
use glam::Vec2;

/// Largest number of sub-frames of a frame.
pub const MOST_SAMPLES: u32 = 1024;

/// Settings of the sub-frames of which a frame is the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSampling {
    /// Number of sub-frames, from 1 to [`MOST_SAMPLES`]. A frame of one is drawn as in the viewport: sharp, at one time.
    pub samples: u32,
    /// Angle of the opening in the rotating shutter of a film camera, degrees: at 360 a frame shows all the time until the next one, at 0
    /// one moment.
    pub shutter: f32,
    /// Frames per second of the movie.
    pub rate: StageRate,
    /// Whether a camera of a scene that focuses on something blurs what is nearer and farther.
    pub depth_of_field: bool,
}

impl Default for FrameSampling {
    /// One sub-frame. With more, the shutter is open for half of the time, and cameras have their depth of field.
    fn default() -> Self {
        Self { samples: 1, shutter: 180.0, rate: StageRate::default(), depth_of_field: true }
    }
}

impl FrameSampling {
    /// Returns the number of sub-frames, within its limits.
    pub fn count(&self) -> u32 {
        self.samples.clamp(1, MOST_SAMPLES)
    }

    /// Returns the time that the shutter is open, ticks.
    fn open_ticks(&self) -> i64 {
        let angle = if self.shutter.is_finite() { f64::from(self.shutter).clamp(0.0, 360.0) } else { 0.0 };
        (self.rate.frame(1).ticks() as f64 * angle / 360.0).round() as i64
    }
}

/// A frame to draw as the mean of its sub-frames. The shutter is open for an equal time before and after the time of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledFrame {
    sampling: FrameSampling,
    time: StageTime,
    opens: StageTime,
    closes: StageTime,
}

impl SampledFrame {
    /// A frame at `time`.
    pub fn new(sampling: FrameSampling, time: StageTime) -> Self {
        let open = sampling.open_ticks();
        let opens = time - StageTime::from_ticks(open / 2);
        Self { sampling, time, opens, closes: opens + StageTime::from_ticks(open) }
    }

    /// Returns the same frame with a shutter that is open only from `first` to `last`, so that no frame shows two shots.
    pub fn within(self, (first, last): (StageTime, StageTime)) -> Self {
        Self {
            opens: self.opens.max(first).min(self.time),
            closes: self.closes.min(last).max(self.time),
            ..self
        }
    }

    /// Returns the number of sub-frames.
    pub fn count(&self) -> u32 {
        self.sampling.count()
    }

    /// Returns sub-frame `index`, for a target with this number of samples per pixel.
    pub fn sub_frame(&self, index: u32, samples_per_pixel: u32) -> SubFrame {
        let sub_frame = SubFrame::new(index, self.count(), jitter_radius(samples_per_pixel));
        if self.sampling.depth_of_field { sub_frame } else { SubFrame { lens: Vec2::ZERO, ..sub_frame } }
    }

    /// Returns the time of a sub-frame in seconds: a whole number of ticks.
    pub fn seconds(&self, sub_frame: &SubFrame) -> f64 {
        if self.count() == 1 {
            return self.time.seconds();
        }
        let open = (self.closes - self.opens).ticks() as f64;
        let since = StageTime::from_ticks((open * sub_frame.shutter).round() as i64);
        (self.opens + since).max(-LONGEST).min(LONGEST).seconds()
    }
}
