//! Courses of speed, and how values mix over a fade.

/// The course of an action from 0 to 1.
///
/// ```text
/// linear  x        in  x²        out  1 - (1 - x)²        in-out  2 x² to the middle, then 1 - 2 (1 - x)²
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StageEase {
    /// The same speed all the time.
    #[default]
    Linear,
    /// Starts slowly.
    In,
    /// Ends slowly.
    Out,
    /// Both.
    InOut,
}

impl StageEase {
    /// Returns the course called `name`; linear for an unknown one.
    pub(super) fn called(name: Option<&str>) -> Self {
        match name {
            Some("in") => Self::In,
            Some("out") => Self::Out,
            Some("in-out") => Self::InOut,
            Some(_) | None => Self::Linear,
        }
    }

    /// Returns the share of the way at the share `x` of the time; clamped to 0..=1.
    pub fn at(self, x: f64) -> f64 {
        let x = x.clamp(0.0, 1.0);
        match self {
            Self::Linear => x,
            Self::In => x * x,
            Self::Out => 1.0 - (1.0 - x) * (1.0 - x),
            Self::InOut if x < 0.5 => 2.0 * x * x,
            Self::InOut => 1.0 - 2.0 * (1.0 - x) * (1.0 - x),
        }
    }

    /// Returns the share of the time at which [`Self::at`] is `way`.
    pub fn inverse(self, way: f64) -> f64 {
        let way = way.clamp(0.0, 1.0);
        match self {
            Self::Linear => way,
            Self::In => way.sqrt(),
            Self::Out => 1.0 - (1.0 - way).sqrt(),
            Self::InOut if way < 0.5 => (0.5 * way).sqrt(),
            Self::InOut => 1.0 - (0.5 * (1.0 - way)).sqrt(),
        }
    }
}

/// Returns `3 x² - 2 x³`, clamped to 0..=1: the weight of what fades in at the share `x` of the fade.
pub(super) fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
