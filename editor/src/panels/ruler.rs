//! Time and place on the timeline: pure arithmetic, so that it can be tested without a window.

/// Which time lies at which place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ruler {
    /// Points: where `start` lies.
    pub left: f32,
    /// Points: from `left` to where the end lies.
    pub width: f32,
    /// Seconds.
    pub start: f32,
    /// Seconds; zero for a single pose.
    pub length: f32,
}

/// A line of the ruler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Seconds.
    pub time: f32,
    /// Does it carry a label?
    pub major: bool,
}

impl Ruler {
    /// Seconds at `x` points, within the take.
    pub fn time_at(&self, x: f32) -> f32 {
        if self.width > 0.0 && self.length > 0.0 {
            self.start + ((x - self.left) / self.width).clamp(0.0, 1.0) * self.length
        } else {
            self.start
        }
    }

    /// Points where `time` lies; a single pose lies at the left end.
    pub fn x_of(&self, time: f32) -> f32 {
        if self.length > 0.0 { self.left + (time - self.start) / self.length * self.width } else { self.left }
    }

    /// Lines at a distance that can be read, whole frames or whole seconds apart.
    pub fn ticks(&self, frame_rate: u32) -> Vec<Tick> {
        if self.length <= 0.0 || self.width <= 0.0 || !self.length.is_finite() {
            return vec![Tick { time: self.start, major: true }];
        }
        let points_a_second = self.width / self.length;
        let minor = step(points_a_second, frame_rate, 7.0);
        let major = step(points_a_second, frame_rate, 64.0);
        let (minor, major) = (minor.max(f64::from(self.length) / 2000.0), major);
        let first = (f64::from(self.start) / minor).ceil() as i64;
        let last = ((f64::from(self.start) + f64::from(self.length)) / minor + 1e-6).floor() as i64;
        (first..=last)
            .map(|index| {
                let time = index as f64 * minor;
                let nearest = (time / major).round() * major;
                Tick { time: time as f32, major: (time - nearest).abs() < minor * 0.25 }
            })
            .collect()
    }

    /// How many decimals the labels of [`Self::ticks`] need.
    pub fn decimals(&self, frame_rate: u32) -> usize {
        if self.length <= 0.0 {
            return 2;
        }
        let major = step(self.width / self.length, frame_rate, 64.0);
        if major >= 1.0 {
            0
        } else if (major * 10.0).fract() < 1e-6 {
            1
        } else {
            2
        }
    }
}

/// The smallest pleasant step, in seconds, that is at least `least` points wide.
fn step(points_a_second: f32, frame_rate: u32, least: f32) -> f64 {
    let frame = 1.0 / f64::from(frame_rate.max(1));
    let least = f64::from(least / points_a_second);
    let frames = [1.0, 2.0, 5.0, 10.0].map(|count| count * frame);
    let seconds = [0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0];
    let pleasant = frames.into_iter().filter(|&step| step < 0.5).chain(seconds);
    pleasant.into_iter().find(|&step| step >= least).unwrap_or_else(|| (least / 3600.0).ceil() * 3600.0)
}

/// The frame at `time`, counted from zero seconds.
pub fn frame_of(time: f32, frame_rate: u32) -> i64 {
    (f64::from(time) * f64::from(frame_rate)).round() as i64
}

/// Seconds at which frame `frame` begins.
pub fn time_of(frame: i64, frame_rate: u32) -> f32 {
    (frame as f64 / f64::from(frame_rate.max(1))) as f32
}

/// The time of the next (`+1`) or previous (`-1`) whole frame.
pub fn step_frame(time: f32, direction: i64, frame_rate: u32) -> f32 {
    let exact = f64::from(time) * f64::from(frame_rate);
    // A time that is not on a frame goes to the frame beside it, not past it.
    let frame =
        if direction > 0 { (exact + 1e-3).floor() as i64 } else { (exact - 1e-3).ceil() as i64 } + direction;
    time_of(frame, frame_rate)
}

/// The first of ascending `times` after `time`, or the last before it.
pub fn step_key(times: &[f32], time: f32, forward: bool) -> Option<f32> {
    const NEAR: f32 = 1e-4;
    if forward {
        let index = times.partition_point(|&key| key <= time + NEAR);
        times.get(index).copied()
    } else {
        let index = times.partition_point(|&key| key < time - NEAR);
        index.checked_sub(1).map(|index| times[index])
    }
}

/// At most one of ascending `times` in every pixel between `left` and the right end.
///
/// Draws a hundred thousand keys as fast as a thousand: it searches for the next pixel instead of visiting all.
pub fn thin(times: &[f32], ruler: &Ruler, pixel: f32) -> Vec<f32> {
    let mut out = Vec::new();
    let mut index = 0;
    while let Some(&time) = times.get(index) {
        out.push(time);
        let next = if ruler.width > 0.0 { time + pixel * ruler.length / ruler.width } else { f32::INFINITY };
        index += 1 + times[index + 1..].partition_point(|&later| later < next);
    }
    out
}
