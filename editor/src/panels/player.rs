//! Playback: the take and the time that are shown, and whether the take is playing.

use dragonfly_picture::playback::{PlaybackClock, Repeat};
use std::time::{Duration, Instant};

/// The playback that the viewport and the panels show, and the moment of the frame that is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Player {
    playback: PlaybackClock,
    now: Instant,
}

impl Player {
    /// Returns a player at the rest pose.
    pub(super) fn new(speed: f32, repeat: Repeat, now: Instant) -> Self {
        Self { playback: PlaybackClock::rest(now).with(false, speed, repeat, now), now }
    }

    /// Returns the playback as the viewport gets it.
    pub(super) fn playback(&self) -> PlaybackClock {
        self.playback
    }

    /// Returns the moment of the frame that is drawn.
    pub(super) fn now(&self) -> Instant {
        self.now
    }

    /// Sets the moment that the frame shows.
    pub(super) fn set_now(&mut self, now: Instant) {
        self.now = now;
    }

    /// Returns the time shown, seconds in the take.
    pub(super) fn time(&self) -> f32 {
        self.playback.time_at(self.now)
    }

    /// Returns the index of the take that is shown; `None` for the rest pose.
    pub(super) fn take(&self) -> Option<usize> {
        self.playback.take
    }

    /// Returns whether time is passing.
    pub(super) fn is_playing(&self) -> bool {
        self.playback.playing
    }

    /// Starts or stops time, with this signed speed and at the time shown.
    pub(super) fn set_playing(&mut self, playing: bool, speed: f32, repeat: Repeat) {
        self.playback = self.playback.with(playing, speed, repeat, self.now);
    }

    /// Moves to `time`; playback keeps running or stays paused.
    pub(super) fn seek(&mut self, time: f32) {
        self.playback = self.playback.seek(time, self.now);
    }

    /// Moves to `time` and pauses there.
    pub(super) fn stop_at(&mut self, time: f32) {
        let (speed, repeat) = (self.playback.speed, self.playback.repeat);
        self.playback = self.playback.with(false, speed, repeat, self.now).seek(time, self.now);
    }

    /// Stops a take that plays once and has reached its end, so that the play button shows it and nothing wakes the
    /// window up.
    pub(super) fn stop_at_end(&mut self) {
        let own = self.playback;
        if own.playing && own.take.is_some() && !own.moves(self.now) && own.speed != 0.0 {
            let time = self.time();
            self.playback.playing = false;
            self.seek(time);
        }
    }

    /// Shows a take from its start. `bounds` are start and length of it, `None` if there is no such take.
    pub(super) fn show(&mut self, take: Option<usize>, bounds: Option<(f32, f32)>) {
        self.playback.take = bounds.and(take);
        (self.playback.start, self.playback.length) = bounds.unwrap_or((0.0, 0.0));
        // A take with a single pose does not play, but the time can be moved to where the next pose will be.
        self.playback.playing &= bounds.is_none_or(|(_, length)| length > 0.0);
        self.seek(self.playback.start);
    }

    /// Follows the take that is shown to its new index in the list.
    pub(super) fn follow(&mut self, take: usize) {
        self.playback.take = Some(take);
    }

    /// Adapts to new bounds of the take, at the same time; shows the rest pose if the take is gone.
    pub(super) fn keep(&mut self, bounds: Option<(f32, f32)>) {
        if bounds == Some(self.bounds()) {
            return;
        }
        let time = self.time();
        self.playback.take = bounds.and(self.playback.take);
        self.set_bounds(bounds.unwrap_or((0.0, 0.0)));
        self.playback.playing &= self.playback.length > 0.0;
        self.seek(time);
    }

    /// Plays within `bounds`, start and length in seconds, from now on. While playing, a time outside of them jumps to the
    /// start of playback; while paused, the time stays.
    pub(super) fn play_within(&mut self, bounds: (f32, f32)) {
        if self.bounds() == bounds {
            return;
        }
        let time = self.time();
        self.set_bounds(bounds);
        let (start, length) = bounds;
        let inside = (start..=start + length).contains(&time);
        self.seek(if inside || !self.playback.playing { time } else { self.first_time() });
    }

    /// Plays within `bounds` in the direction of `speed`. Starts at the first time where the time shown is outside of
    /// the bounds, or a take that plays once has reached its end.
    pub(super) fn play(&mut self, bounds: (f32, f32), speed: f32) {
        let (start, length) = bounds;
        let outside = !(start..=start + length).contains(&self.time());
        self.set_bounds(bounds);
        let repeat = self.playback.repeat;
        self.set_playing(true, speed, repeat);
        if outside || (repeat == Repeat::Once && self.playback.at_end(self.now)) {
            self.seek(self.first_time());
        }
    }

    /// Sets the speed without its sign: the direction stays.
    pub(super) fn set_speed(&mut self, speed: f32) {
        let signed = speed * if self.playback.speed < 0.0 { -1.0 } else { 1.0 };
        self.set_playing(self.playback.playing, signed, self.playback.repeat);
    }

    /// Sets what happens at the end of the take.
    pub(super) fn set_repeat(&mut self, repeat: Repeat) {
        self.set_playing(self.playback.playing, self.playback.speed, repeat);
    }

    /// Returns when the time display must be drawn again, if it must.
    pub(super) fn next_display(&self) -> Option<Duration> {
        self.playback.moves(self.now).then_some(Duration::from_millis(33))
    }

    fn bounds(&self) -> (f32, f32) {
        (self.playback.start, self.playback.length)
    }

    fn set_bounds(&mut self, (start, length): (f32, f32)) {
        (self.playback.start, self.playback.length) = (start, length);
    }

    /// Returns the time at which playing begins in the direction of the speed.
    fn first_time(&self) -> f32 {
        self.playback.start + if self.playback.speed < 0.0 { self.playback.length } else { 0.0 }
    }
}
