//! Playback: the take and time on screen as a function of the clock, so that playing needs no message per frame.

use crate::between;
use std::time::Instant;

/// Behavior at the end of the take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Repeat {
    /// Stops at the end (B-033: clamped).
    Once,
    /// Starts again (B-038).
    #[default]
    Loop,
    /// Plays back and forth.
    PingPong,
}

/// Latest time that can be shown, seconds: a day.
pub const LATEST: f32 = 86_400.0;

/// Playback state: the take was at `anchor_time` at the instant `anchor`, and time advances at `speed` from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaybackClock {
    /// Index of the take; `None` shows the rest pose.
    pub take: Option<usize>,
    /// Start of the take, seconds.
    pub start: f32,
    /// Length of the take, seconds; zero for a single pose.
    pub length: f32,
    /// Time in the take at `anchor`, seconds; while paused it may be outside the take.
    pub anchor_time: f64,
    /// Instant that `anchor_time` belongs to.
    pub anchor: Instant,
    /// Take seconds per second; negative plays backwards.
    pub speed: f32,
    /// Whether time advances.
    pub playing: bool,
    /// Behavior at the end of the take.
    pub repeat: Repeat,
}

impl PlaybackClock {
    /// Paused at the start of the rest pose.
    pub fn rest(now: Instant) -> Self {
        Self {
            take: None,
            start: 0.0,
            length: 0.0,
            anchor_time: 0.0,
            anchor: now,
            speed: 1.0,
            playing: false,
            repeat: Repeat::Loop,
        }
    }

    /// Paused at the start of the scene of a script, which lasts `length` seconds. The number of the take means nothing.
    pub fn of_scene(length: f64, now: Instant) -> Self {
        Self { take: Some(0), length: length as f32, ..Self::rest(now) }
    }

    /// Time in the take at `now`, seconds; within `start ..= start + length` while playing.
    pub fn time_at(&self, now: Instant) -> f32 {
        self.seconds_at(now) as f32
    }

    /// The same as [`Self::time_at`] with the precision of the clock, for scenes, whose times are exact.
    pub fn seconds_at(&self, now: Instant) -> f64 {
        if !self.playing {
            return self.anchor_time;
        }
        let passed = now.saturating_duration_since(self.anchor).as_secs_f64() * f64::from(self.speed);
        let (start, length) = (f64::from(self.start), f64::from(self.length));
        // Also catches a length of NaN, in which nothing can move.
        #[allow(clippy::neg_cmp_op_on_partial_ord, reason = "the negation is how NaN is caught")]
        if !(length > 0.0) {
            return start;
        }
        let inside = self.anchor_time - start + passed;
        let wrapped = match self.repeat {
            Repeat::Once => between(inside, 0.0, length),
            // A time exactly at the end stays there, so that playing backwards starts at the end.
            Repeat::Loop if (0.0..=length).contains(&inside) => inside,
            Repeat::Loop => inside.rem_euclid(length),
            Repeat::PingPong => {
                let twice = inside.rem_euclid(2.0 * length);
                if twice > length { 2.0 * length - twice } else { twice }
            }
        };
        start + wrapped
    }

    /// Returns whether the image changes by itself after `now`.
    pub fn moves(&self, now: Instant) -> bool {
        self.playing
            && self.take.is_some()
            && self.length > 0.0
            && self.speed != 0.0
            && !(self.repeat == Repeat::Once && self.at_end(now))
    }

    /// Returns whether a take that plays once has reached its end.
    pub fn at_end(&self, now: Instant) -> bool {
        let time = self.time_at(now);
        if self.speed < 0.0 { time <= self.start } else { time >= self.start + self.length }
    }

    /// Moves to `time` seconds at `now`; while playing, clamped to the take. While paused the time may be outside the
    /// take, because setting a key there extends the take.
    pub fn seek(mut self, time: f32, now: Instant) -> Self {
        let (mut first, mut last) = (self.start, self.start + self.length.max(0.0));
        if !self.playing && self.take.is_some() {
            (first, last) = (first.min(0.0), last.max(LATEST));
        }
        let time = if time.is_finite() { between(time, first, last) } else { self.start };
        (self.anchor_time, self.anchor) = (f64::from(time), now);
        self
    }

    /// Changes whether it plays, its speed and its behavior at the end, keeping the time.
    pub fn with(mut self, playing: bool, speed: f32, repeat: Repeat, now: Instant) -> Self {
        self.anchor_time = f64::from(self.time_at(now));
        self.anchor = now;
        self.playing = playing;
        self.speed = speed;
        self.repeat = repeat;
        self
    }
}
