//! Fades from one repeating take to another while both stay in step, such as from walking to running.

use super::cycle::{Cycle, wrapped};
use super::fade::{Fade, FadeCurve, Faded};

/// A fade between two cycles with synchronized phases.
///
/// Both takes are always at the same phase (see [`Cycle`]), and their speeds change to keep them there: one step from
/// mark to mark takes
///
/// ```text
/// seconds = (1 - weight) * seconds in the first take  +  weight * seconds in the second
/// ```
///
/// so at the start the first plays at its own speed, and at the end the second. Two cycles with different numbers of
/// marks have no corresponding marks: then marks are ignored, and the phase is the plain fraction of the cycle.
///
/// For takes that are unrelated, or do not repeat, use [`super::FreeFade`] or [`super::OneShot`].
///
/// The state is two numbers, changed only by [`Self::advance`]: the same steps give the same bits. After the fade the
/// second take continues at its own speed, and [`Self::now`] returns the time in it at which another fade may start.
///
/// ```
/// use dragonfly_anim::blend::{CrossFade, Cycle, FadeCurve};
/// let (walk, run) = (Cycle::new(0.0, 1.0), Cycle::new(0.0, 0.5));
/// let mut fade = CrossFade::new(walk, run, 0.25, FadeCurve::Linear).starting_at(0.5);
/// let now = fade.advance(0.125);
/// assert_eq!(now.weight, 0.5);
/// // Half way through one is half way through the other.
/// assert_eq!(now.from_time, now.to_time * 2.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[doc(alias = "transition")]
pub struct CrossFade {
    from: Cycle,
    to: Cycle,
    fade: Fade,
    /// Phase of both cycles, 0..1.
    phase: f64,
}

impl CrossFade {
    /// Creates a fade that lasts `seconds`, with both cycles at phase 0.
    ///
    /// If `seconds` is negative, zero or NaN, the second take is reached at once; infinite counts as the largest `f32`.
    pub fn new(from: Cycle, to: Cycle, seconds: f32, curve: FadeCurve) -> Self {
        let alike = from.marks() == to.marks();
        let (from, to) = if alike { (from, to) } else { (from.without_marks(), to.without_marks()) };
        Self { from, to, fade: Fade::new(seconds, curve), phase: 0.0 }
    }

    /// Returns the same fade with the first take at `time` seconds.
    pub fn starting_at(mut self, time: f32) -> Self {
        self.phase = self.from.phase_at(time);
        self
    }

    /// Advances by `dt` seconds and returns [`Self::now`]. Negative and NaN count as 0. Allocates nothing.
    ///
    /// During the fade the weight of a step is the mean of those at its two ends, so the phase hardly depends on the
    /// size of the steps. The part of `dt` after the end of the fade is played at the speed of the second take.
    pub fn advance(&mut self, dt: f32) -> Faded {
        let dt = f64::from(super::weight_or_zero(dt));
        let before = self.fade.weight();
        let fading = self.fade.advance(dt);
        self.turn(fading, 0.5 * (before + self.fade.weight()));
        self.turn(dt - fading, 1.0);
        self.now()
    }

    /// Returns the times in both takes, and the weight of the second. Allocates nothing.
    pub fn now(&self) -> Faded {
        Faded {
            from_time: self.from.time_at(self.phase),
            to_time: self.to.time_at(self.phase),
            weight: self.fade.weight() as f32,
        }
    }

    /// Returns the phase of both cycles, 0..1.
    pub fn phase(&self) -> f64 {
        self.phase
    }

    /// Returns whether the fade is over, so that only the second take is left.
    pub fn is_done(&self) -> bool {
        self.fade.is_done()
    }

    /// Advances the phase by `dt` seconds with a fixed weight, from mark to mark.
    fn turn(&mut self, dt: f64, weight: f64) {
        let mixed = |from: f64, to: f64| (1.0 - weight) * from + weight * to;
        let round = mixed(f64::from(self.from.length()), f64::from(self.to.length()));
        // A cycle without length has no phase to advance.
        if dt <= 0.0 || round <= 0.0 {
            return;
        }
        let mut left = dt % round;
        let marks = self.from.marks();
        let (mut mark, mut fraction) = self.from.split(self.phase);
        // Complete rounds were removed from `left`, so it spans each step between marks at most once, and the first
        // step twice: its rest at the start, and its beginning at the end.
        for _ in 0..=marks {
            let seconds = mixed(self.from.seconds_after(mark), self.to.seconds_after(mark));
            let to_next = (1.0 - fraction) * seconds;
            if left < to_next {
                fraction += left / seconds;
                break;
            }
            left -= to_next;
            (mark, fraction) = ((mark + 1) % marks, 0.0);
        }
        self.phase = wrapped((mark as f64 + fraction) / marks as f64);
    }
}
