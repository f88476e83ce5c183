//! Where keys go that are moved or scaled: the same arithmetic as the document's, so that what is drawn is what comes.

/// A change of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shift {
    /// Seconds later.
    Move(f32),
    /// Distances to `about` seconds become `factor` times as long.
    Scale {
        /// Stays where it is.
        about: f32,
        /// Not zero; a negative one turns round.
        factor: f32,
    },
    /// To the nearest of so many frames a second.
    Snap(f32),
}

impl Shift {
    /// Nothing moves.
    pub const NONE: Self = Self::Move(0.0);

    /// Where a key at `time` goes.
    pub fn apply(self, time: f32) -> f32 {
        match self {
            Self::Move(by) => time + by,
            Self::Scale { about, factor } => about + (time - about) * factor,
            Self::Snap(rate) => ((f64::from(time) * f64::from(rate)).round() / f64::from(rate)) as f32,
        }
    }

    /// As `time * factor + offset`; snapping is too small to be drawn.
    pub fn affine(self) -> (f64, f64) {
        match self {
            Self::Move(by) => (1.0, f64::from(by)),
            Self::Scale { about, factor } => {
                (f64::from(factor), f64::from(about) * (1.0 - f64::from(factor)))
            }
            Self::Snap(_) => (1.0, 0.0),
        }
    }

    /// Where a stretch goes, its ends in order; all of time stays all of time.
    pub fn stretch(self, [from, to]: [f32; 2]) -> [f32; 2] {
        let at = |time: f32| if time.is_finite() { self.apply(time) } else { time };
        match self {
            Self::Scale { factor, .. } if factor < 0.0 => [
                if to.is_finite() { at(to) } else { f32::NEG_INFINITY },
                if from.is_finite() { at(from) } else { f32::INFINITY },
            ],
            _ => [at(from), at(to)],
        }
    }
}
