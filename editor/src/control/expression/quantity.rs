//! The quantity of a number, which decides its units.

/// Quantity of a number, which decides its units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// A plain number or factor: the only unit is `%`, at the end of the text.
    #[default]
    Number,
    /// Meters, which are scene units: `mm`, `cm`, `dm`, `m`, `km`, `in`, `ft`.
    Length,
    /// Degrees: `deg`, `°`, `rad`, `turn`.
    Angle,
}
