//! Curves and progress of a fade, shared by every kind of fade.

/// How the weight of the second take rises during a fade.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum FadeCurve {
    /// `x`: linear.
    Linear,
    /// `3 x² - 2 x³`: starts and ends smoothly.
    #[default]
    SmoothStep,
}

impl FadeCurve {
    /// All curves.
    pub const ALL: [Self; 2] = [Self::Linear, Self::SmoothStep];

    /// Returns the weight of the second take at fraction `x` of the fade: 0 at 0, 1 at 1, never falling. `x` is clamped
    /// to 0..=1; NaN counts as 0.
    pub fn weight(self, x: f64) -> f64 {
        let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
        match self {
            Self::Linear => x,
            Self::SmoothStep => x * x * (3.0 - 2.0 * x),
        }
    }
}

/// The two times to sample and the weight to blend with: take `from` at `from_time` and take `to` at `to_time`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faded {
    /// Seconds inside the first take.
    pub from_time: f32,
    /// Seconds inside the second take.
    pub to_time: f32,
    /// Weight of the second take, 0..=1; the `mix` of [`super::blend_two`].
    pub weight: f32,
}

/// Progress of a fade.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fade {
    /// Duration: finite, 0 or more.
    seconds: f64,
    curve: FadeCurve,
    /// Seconds since the start, at most `seconds`.
    elapsed: f64,
}

impl Fade {
    /// Creates a fade. If `seconds` is negative, zero or NaN, it is over at once; infinite counts as the largest `f32`.
    pub(super) fn new(seconds: f32, curve: FadeCurve) -> Self {
        Self { seconds: f64::from(super::weight_or_zero(seconds)), curve, elapsed: 0.0 }
    }

    /// Advances by `dt` seconds (0 or more) and returns the part of `dt` that belonged to the fade.
    pub(super) fn advance(&mut self, dt: f64) -> f64 {
        let fading = dt.min(self.seconds - self.elapsed);
        self.elapsed = if fading < dt { self.seconds } else { self.elapsed + fading };
        fading
    }

    pub(super) fn is_done(&self) -> bool {
        self.elapsed >= self.seconds
    }

    /// Returns the weight of the second take.
    pub(super) fn weight(&self) -> f64 {
        if self.is_done() { 1.0 } else { self.curve.weight(self.elapsed / self.seconds) }
    }
}
