//! How far a fade is, and what every kind of fade says.

/// How the weight of the second take grows while the fade lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum FadeCurve {
    /// `x`: evenly.
    Linear,
    /// `3 x² - 2 x³`: begins and ends gently.
    #[default]
    SmoothStep,
}

impl FadeCurve {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Linear, Self::SmoothStep];

    /// Weight of the second take when `x` of the fade has passed: 0 at 0, 1 at 1, never falling. `x` is held within
    /// 0..=1; NaN counts as 0.
    pub fn weight(self, x: f64) -> f64 {
        let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
        match self {
            Self::Linear => x,
            Self::SmoothStep => x * x * (3.0 - 2.0 * x),
        }
    }
}

/// What to sample and how to blend it: take `from` at `from_time`, take `to` at `to_time`, `weight` of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faded {
    /// Seconds inside the first take.
    pub from_time: f32,
    /// Seconds inside the second take.
    pub to_time: f32,
    /// 0: the first take alone; 1: the second alone. What [`super::blend_two`] takes as `mix`.
    pub weight: f32,
}

/// How much of a fade has passed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fade {
    /// How long it lasts: finite, 0 or more.
    seconds: f64,
    curve: FadeCurve,
    /// Seconds since it began, at most `seconds`.
    elapsed: f64,
}

impl Fade {
    /// Seconds that are negative, zero or NaN: over at once; infinite: the largest `f32`.
    pub(super) fn new(seconds: f32, curve: FadeCurve) -> Self {
        Self { seconds: f64::from(super::weight_or_zero(seconds)), curve, elapsed: 0.0 }
    }

    /// Lets `dt` seconds pass (0 or more) and says how many of them the fade still lasted.
    pub(super) fn advance(&mut self, dt: f64) -> f64 {
        let fading = dt.min(self.seconds - self.elapsed);
        self.elapsed = if fading < dt { self.seconds } else { self.elapsed + fading };
        fading
    }

    pub(super) fn is_done(&self) -> bool {
        self.elapsed >= self.seconds
    }

    /// Of the second take.
    pub(super) fn weight(&self) -> f64 {
        if self.is_done() { 1.0 } else { self.curve.weight(self.elapsed / self.seconds) }
    }
}
