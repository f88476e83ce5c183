//! The times of keys that are moved or scaled, computed as the document does, so that the drawing matches the result.

/// A change of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shift {
    /// Moves keys later, seconds.
    Move(f32),
    /// Multiplies distances to `about` seconds by `factor`.
    Scale {
        /// Time that stays where it is, seconds.
        about: f32,
        /// Not zero; a negative factor reverses the keys.
        factor: f32,
    },
    /// Moves keys to the nearest frame, at this number of frames per second.
    Snap(f32),
}

impl Shift {
    /// No change.
    pub const NONE: Self = Self::Move(0.0);

    /// Returns the new time of a key at `time`.
    pub fn apply(self, time: f32) -> f32 {
        match self {
            Self::Move(by) => time + by,
            Self::Scale { about, factor } => about + (time - about) * factor,
            Self::Snap(rate) => ((f64::from(time) * f64::from(rate)).round() / f64::from(rate)) as f32,
        }
    }

    /// Returns the new ends of an interval, in order; all of time stays all of time.
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
