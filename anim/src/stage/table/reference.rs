//! Attributes that refer to things and actions.

use super::row::AttributeRow;

/// How a value names a thing or an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceKind {
    /// The value is the name of a thing.
    Name,
    /// The name of an action and one of its moments: `walk.end-0.5`. A value without a point is a time.
    Moment,
    /// The name of a thing, or of a thing and a bone: `anna`, `anna.Head`. Numbers are a point or an angle.
    Spot,
}

/// Attributes with references, whatever element they are of.
const REFERENCES: [(&str, ReferenceKind); 9] = [
    ("who", ReferenceKind::Name),
    ("path", ReferenceKind::Name),
    ("begin", ReferenceKind::Moment),
    ("end", ReferenceKind::Moment),
    ("at", ReferenceKind::Spot),
    ("to", ReferenceKind::Spot),
    ("look", ReferenceKind::Spot),
    ("focus", ReferenceKind::Spot),
    ("facing", ReferenceKind::Spot),
];

impl AttributeRow {
    /// Returns how its value names a thing or an action; `None` where it names neither.
    pub fn reference(&self) -> Option<ReferenceKind> {
        REFERENCES.iter().find(|(name, _)| *name == self.name).map(|(_, kind)| *kind)
    }
}
