//! Times and positions on the timeline: pure arithmetic, so that it can be tested without a window.

/// Mapping between time and horizontal position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ruler {
    /// Position of `start`, points.
    pub left: f32,
    /// Distance from `left` to the end, points.
    pub width: f32,
    /// Time at the left end, seconds.
    pub start: f32,
    /// Duration, seconds; zero for a single pose.
    pub length: f32,
}

/// A line of the ruler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Time of the line, seconds.
    pub time: f32,
    /// Whether the line has a label.
    pub major: bool,
}

impl Ruler {
    /// Returns the time at `x` points, limited to the take, seconds.
    pub fn time_at(&self, x: f32) -> f32 {
        if self.width > 0.0 && self.length > 0.0 {
            self.start + ((x - self.left) / self.width).clamp(0.0, 1.0) * self.length
        } else {
            self.start
        }
    }

    /// Returns the position of `time`, points; a take of a single pose is at the left end.
    pub fn x_of(&self, time: f32) -> f32 {
        if self.length > 0.0 { self.left + (time - self.start) / self.length * self.width } else { self.left }
    }

    /// Returns the lines of the ruler, at whole frames or whole seconds, at least `LINE` points apart.
    pub fn ticks(&self, frame_rate: impl Into<f64>) -> Vec<Tick> {
        if self.length <= 0.0 || self.width <= 0.0 || !self.length.is_finite() {
            return vec![Tick { time: self.start, major: true }];
        }
        let (minor, major) = self.steps(frame_rate.into());
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

    /// Returns how many decimals the labels of [`Self::ticks`] need.
    pub fn decimals(&self, frame_rate: impl Into<f64>) -> usize {
        let whole = |step: f64| (step - step.round()).abs() < 1e-6;
        let major = if self.length > 0.0 { self.steps(frame_rate.into()).1 } else { 0.01 };
        [1.0, 10.0, 100.0].into_iter().position(|factor| whole(major * factor)).unwrap_or(3)
    }

    /// Returns the seconds between lines, and between lines with labels: round numbers that are whole frames. At 29.97 frames a second, 30 frames
    /// count as a second.
    fn steps(&self, frame_rate: f64) -> (f64, f64) {
        let rate = frame_rate.max(1.0);
        let whole_rate = rate.round();
        let points_a_frame = f64::from(self.width / self.length) / rate;
        let frames = |seconds: f64| (seconds * whole_rate).round();
        let whole = |seconds: &f64| (seconds * whole_rate - frames(*seconds)).abs() < 1e-6;
        let pleasant =
            [0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0];
        let seconds = pleasant.into_iter().filter(whole).map(frames);
        // The distance for a range so long that labels at every hour would overlap: several hours.
        let hours = (LABEL / points_a_frame / (3600.0 * whole_rate)).ceil().max(1.0) * 3600.0 * whole_rate;
        let major = [1.0, 2.0]
            .into_iter()
            .chain(seconds)
            .find(|step| step * points_a_frame >= LABEL)
            .unwrap_or(hours);
        // The finest division of a labeled step whose lines are at least `LINE` points apart.
        let parts = [major, 30.0, 20.0, 15.0, 12.0, 10.0, 6.0, 5.0, 4.0, 3.0, 2.0];
        let fits = |parts: &f64| {
            let step = major / parts;
            (step - step.round()).abs() < 1e-6 && step * points_a_frame >= LINE
        };
        let parts = parts.into_iter().find(fits).unwrap_or(1.0);
        (major / parts / rate, major / rate)
    }
}

/// Minimum distance between lines, points.
const LINE: f64 = 7.0;
/// Minimum distance between labels, points.
const LABEL: f64 = 64.0;

/// Returns the frame nearest to `time`; frame 0 is at zero seconds.
pub fn frame_of(time: f32, frame_rate: impl Into<f64>) -> i64 {
    (f64::from(time) * frame_rate.into()).round() as i64
}

/// Returns the time of a frame, seconds.
pub fn time_of(frame: i64, frame_rate: impl Into<f64>) -> f32 {
    (frame as f64 / frame_rate.into().max(1.0)) as f32
}

/// Returns the time of the next (`+1`) or previous (`-1`) whole frame.
pub fn step_frame(time: f32, direction: i64, frame_rate: impl Into<f64>) -> f32 {
    let frame_rate = frame_rate.into();
    let exact = f64::from(time) * frame_rate;
    // A time between two frames goes to the nearest frame in that direction, not past it.
    let frame =
        if direction > 0 { (exact + 1e-3).floor() as i64 } else { (exact - 1e-3).ceil() as i64 } + direction;
    time_of(frame, frame_rate)
}

/// Returns the first of ascending `times` after `time`, or, if not `forward`, the last before it.
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

/// Returns at most one of ascending `times` for every pixel of the ruler.
///
/// A hundred thousand keys take as long as a thousand: it searches for the next pixel instead of visiting all.
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
