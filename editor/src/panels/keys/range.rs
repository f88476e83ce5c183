//! The part of a take that plays.

use crate::panels::state::State;
use dragonfly_document::edit::SAME_TIME;

impl State {
    /// Start and length of the take that is shown.
    pub fn take_bounds(&self) -> (f32, f32) {
        self.take().map_or((0.0, 0.0), |take| (take.start, take.length))
    }

    /// Where playing begins and ends, seconds: the range, or the whole take.
    pub fn play_bounds(&self) -> (f32, f32) {
        let (start, length) = self.take_bounds();
        match self.keys.range {
            Some([from, to]) => {
                let (from, to) = (from.clamp(start, start + length), to.clamp(start, start + length));
                (from, to - from)
            }
            None => (start, length),
        }
    }

    /// Plays between these times from now on, in whichever order they come; a range of no length is none.
    pub(super) fn set_range(&mut self, range: Option<[f32; 2]>) {
        let (start, length) = self.take_bounds();
        let ordered = range
            .filter(|ends| ends.iter().all(|time| time.is_finite()))
            .map(|[a, b]| [a.min(b).clamp(start, start + length), a.max(b).clamp(start, start + length)]);
        self.keys.range = ordered.filter(|[from, to]| to - from > SAME_TIME);
    }

    /// While time passes it passes within the range; while it stands, any time of the take can be looked at.
    pub(in crate::panels) fn bound_playback(&mut self) {
        let (start, length) = if self.playback.playing { self.play_bounds() } else { self.take_bounds() };
        if (self.playback.start, self.playback.length) == (start, length) {
            return;
        }
        let time = self.playback.time_at(self.now);
        (self.playback.start, self.playback.length) = (start, length);
        let inside = (start..=start + length).contains(&time);
        let begin = if self.playback.speed < 0.0 { start + length } else { start };
        self.playback =
            self.playback.seek(if inside || !self.playback.playing { time } else { begin }, self.now);
    }
}
