//! Fades from one take to another while each plays at its own time.

use super::fade::{Fade, FadeCurve, Faded};
use super::playback::Playback;

/// A fade between two unrelated takes: from standing to jumping, from a wave that ends to a walk that repeats.
///
/// Each take plays at its own speed, before, during and after the fade; only the weight changes. A take that plays once
/// stops at its end. For two cycles of the same movement this makes feet slide, because the feet are on the ground at
/// different times in the two takes: [`super::CrossFade`] keeps the cycles in step.
///
/// The same steps give the same bits, and the result does not depend on how time is cut into steps, up to rounding.
///
/// ```
/// use dragonfly_anim::blend::{FadeCurve, FreeFade, Playback};
/// let (stand, jump) = (Playback::new(0.0, 4.0, true), Playback::new(0.0, 1.0, false));
/// let mut fade = FreeFade::new(stand.starting_at(3.0), jump, 0.5, FadeCurve::Linear);
/// let now = fade.advance(0.25);
/// assert_eq!((now.from_time, now.to_time, now.weight), (3.25, 0.25, 0.5));
/// // The next fade starts at the current time of the second take.
/// let next = FreeFade::new(fade.to(), Playback::new(0.0, 4.0, true), 0.5, FadeCurve::Linear);
/// assert_eq!(next.now().from_time, 0.25);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FreeFade {
    from: Playback,
    to: Playback,
    fade: Fade,
}

impl FreeFade {
    /// Creates a fade that lasts `seconds`, from the current times of both takes.
    ///
    /// If `seconds` is negative, zero or NaN, the second take is reached at once; infinite counts as the largest `f32`.
    pub fn new(from: Playback, to: Playback, seconds: f32, curve: FadeCurve) -> Self {
        Self { from, to, fade: Fade::new(seconds, curve) }
    }

    /// Advances by `dt` seconds and returns [`Self::now`]. Negative and NaN count as 0. Allocates nothing.
    pub fn advance(&mut self, dt: f32) -> Faded {
        self.from.advance(dt);
        self.to.advance(dt);
        self.fade.advance(f64::from(super::weight_or_zero(dt)));
        self.now()
    }

    /// Returns the times in both takes, and the weight of the second. Allocates nothing.
    pub fn now(&self) -> Faded {
        Faded { from_time: self.from.time(), to_time: self.to.time(), weight: self.fade.weight() as f32 }
    }

    /// Returns the second take in its current state.
    pub fn to(&self) -> Playback {
        self.to
    }

    /// Returns whether the fade is over, so that only the second take is left.
    pub fn is_done(&self) -> bool {
        self.fade.is_done()
    }
}
