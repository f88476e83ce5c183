//! A take that plays once on top of another and then ends by itself: a wave, a hit, a step aside.

use super::fade::{FadeCurve, Faded};
use super::playback::Playback;

/// A take that is faded in, plays once, and is faded out so that the fade ends together with the take.
///
/// With `t` the seconds that the shot has played and `l` its length:
///
/// ```text
/// weight = min(curve(t / fade_in), curve((l - t) / fade_out))
/// ```
///
/// so its weight is 0 at its start and at its end, and 1 in between. Where both fades together are longer than the
/// take, both are shortened in the same proportion until they are as long. The take below plays at its own speed during
/// the shot and after it.
///
/// In [`Faded`], `from` is the take below, `to` the shot. The same steps give the same bits, and the result does not
/// depend on how time is cut into steps, up to rounding.
///
/// ```
/// use dragonfly_anim::blend::{FadeCurve, OneShot, Playback};
/// let (walk, wave) = (Playback::new(0.0, 1.0, true), Playback::new(0.0, 2.0, false));
/// let mut shot = OneShot::new(walk, wave, 0.5, 0.25, FadeCurve::Linear);
/// assert_eq!(shot.now().weight, 0.0);
/// assert_eq!(shot.advance(0.25).weight, 0.5);
/// assert_eq!(shot.advance(1.5).weight, 1.0);
/// assert_eq!(shot.advance(0.125).weight, 0.5);
/// assert!(!shot.is_done());
/// shot.advance(0.125);
/// assert!(shot.is_done());
/// assert_eq!((shot.now().weight, shot.now().to_time), (0.0, 2.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct OneShot {
    below: Playback,
    shot: Playback,
    /// Seconds, 0 or more; both fades together are no longer than the shot.
    fade_in: f64,
    /// Seconds, 0 or more.
    fade_out: f64,
    curve: FadeCurve,
}

impl OneShot {
    /// Creates a shot on top of `below`, from the current times of both; `shot` plays once even if it would repeat.
    ///
    /// If the seconds are negative, zero or NaN, there is no fade on that side; infinite counts as the largest `f32`.
    pub fn new(below: Playback, shot: Playback, fade_in: f32, fade_out: f32, curve: FadeCurve) -> Self {
        let [fade_in, fade_out] =
            [fade_in, fade_out].map(|seconds| f64::from(super::weight_or_zero(seconds)));
        let shorter = (f64::from(shot.length()) / (fade_in + fade_out)).min(1.0);
        // NaN where both the fades and the length are zero.
        let shorter = if shorter >= 0.0 { shorter } else { 0.0 };
        let (fade_in, fade_out) = (fade_in * shorter, fade_out * shorter);
        Self { below, shot: shot.to_play_once(), fade_in, fade_out, curve }
    }

    /// Advances by `dt` seconds and returns [`Self::now`]. Negative and NaN count as 0. Allocates nothing.
    pub fn advance(&mut self, dt: f32) -> Faded {
        self.below.advance(dt);
        self.shot.advance(dt);
        self.now()
    }

    /// Returns the times in both takes, and the weight of the shot. Allocates nothing.
    pub fn now(&self) -> Faded {
        Faded { from_time: self.below.time(), to_time: self.shot.time(), weight: self.weight() as f32 }
    }

    /// Returns the take below in its current state.
    pub fn below(&self) -> Playback {
        self.below
    }

    /// Returns whether the shot is over, so that only the take below is left.
    pub fn is_done(&self) -> bool {
        self.shot.has_ended()
    }

    fn weight(&self) -> f64 {
        if self.is_done() {
            return 0.0;
        }
        let (passed, left) = (self.shot.passed(), f64::from(self.shot.length()) - self.shot.passed());
        let part =
            |seconds: f64, fade: f64| if seconds < fade { self.curve.weight(seconds / fade) } else { 1.0 };
        part(passed, self.fade_in).min(part(left, self.fade_out))
    }
}
