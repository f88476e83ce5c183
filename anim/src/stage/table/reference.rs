//! Attributes that refer to things and actions.

use super::row::AttributeRow;

/// How a value names a thing or an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameReference {
    /// The value is the name of a thing.
    Name,
    /// The name of an action and one of its moments: `walk.end-0.5`. A value without a point is a time.
    Moment,
    /// The name of a thing, or of a thing and a bone: `anna`, `anna.Head`. Numbers are a point or an angle.
    Spot,
}

/// Attributes with references, whatever element they are of.
const REFERENCES: [(&str, NameReference); 9] = [
    ("who", NameReference::Name),
    ("path", NameReference::Name),
    ("begin", NameReference::Moment),
    ("end", NameReference::Moment),
    ("at", NameReference::Spot),
    ("to", NameReference::Spot),
    ("look", NameReference::Spot),
    ("focus", NameReference::Spot),
    ("facing", NameReference::Spot),
];

impl AttributeRow {
    /// Returns how its value names a thing or an action; `None` where it names neither.
    pub fn reference(&self) -> Option<NameReference> {
        REFERENCES.iter().find(|(name, _)| *name == self.name).map(|(_, kind)| *kind)
    }
}
