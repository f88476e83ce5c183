//! Which time of which take is on screen: a function of the clock, so that playing needs no message a frame.

use std::time::Instant;

/// What happens at the end of the take.
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

/// Latest time that can be looked at, seconds: a day.
pub const LATEST: f32 = 86_400.0;

/// At the instant `anchor` the take stood at `anchor_time`, and moves on from there at `speed`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Position in the model's takes; `None` shows the rest pose.
    pub take: Option<usize>,
    /// Seconds: where the take begins.
    pub start: f32,
    /// Seconds from begin to end; zero for a single pose.
    pub length: f32,
    /// Seconds in the take at `anchor`; while it stands also beside it.
    pub anchor_time: f64,
    /// When `anchor_time` was true.
    pub anchor: Instant,
    /// Take seconds a second; negative plays backwards.
    pub speed: f32,
    /// Does time pass?
    pub playing: bool,
    /// What happens at the end.
    pub repeat: Repeat,
}

impl Playback {
    /// Stands still at the begin of nothing.
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

    /// Seconds in the take at `now`; within `start ..= start + length` while it plays.
    pub fn time_at(&self, now: Instant) -> f32 {
        if !self.playing {
            return self.anchor_time as f32;
        }
        let passed = now.saturating_duration_since(self.anchor).as_secs_f64() * f64::from(self.speed);
        let (start, length) = (f64::from(self.start), f64::from(self.length));
        // Also catches a length that is not a number: nothing to move in.
        #[allow(clippy::neg_cmp_op_on_partial_ord, reason = "the negation is how NaN is caught")]
        if !(length > 0.0) {
            return self.start;
        }
        let inside = self.anchor_time - start + passed;
        let wrapped = match self.repeat {
            Repeat::Once => inside.clamp(0.0, length),
            // Exactly the end stays the end: who begins to play there backwards begins there.
            Repeat::Loop if (0.0..=length).contains(&inside) => inside,
            Repeat::Loop => inside.rem_euclid(length),
            Repeat::PingPong => {
                let twice = inside.rem_euclid(2.0 * length);
                if twice > length { 2.0 * length - twice } else { twice }
            }
        };
        (start + wrapped) as f32
    }

    /// Will the picture change by itself after `now`?
    pub fn moves(&self, now: Instant) -> bool {
        self.playing
            && self.take.is_some()
            && self.length > 0.0
            && self.speed != 0.0
            && !(self.repeat == Repeat::Once && self.at_end(now))
    }

    /// Has a take that plays once arrived?
    pub fn at_end(&self, now: Instant) -> bool {
        let time = self.time_at(now);
        if self.speed < 0.0 { time <= self.start } else { time >= self.start + self.length }
    }

    /// The same, anchored at `now` and at `time` seconds; while it plays as near to that as the take goes. While it stands
    /// time may lie beside the take: a key that is put there makes it longer.
    pub fn seek(mut self, time: f32, now: Instant) -> Self {
        let (mut first, mut last) = (self.start, self.start + self.length.max(0.0));
        if !self.playing && self.take.is_some() {
            (first, last) = (first.min(0.0), last.max(LATEST));
        }
        let time = if time.is_finite() { time.clamp(first, last) } else { self.start };
        (self.anchor_time, self.anchor) = (f64::from(time), now);
        self
    }

    /// The same time, but playing or not, at another speed, with another end.
    pub fn with(mut self, playing: bool, speed: f32, repeat: Repeat, now: Instant) -> Self {
        self.anchor_time = f64::from(self.time_at(now));
        self.anchor = now;
        self.playing = playing;
        self.speed = speed;
        self.repeat = repeat;
        self
    }
}
