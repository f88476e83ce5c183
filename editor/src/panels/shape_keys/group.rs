//! Groups of shape keys by the names that programs agree on: ARKit's 52 blend shapes, and the expressions of VRM.

/// A part of the face that shape keys move, or what they are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ShapeGroup {
    /// Whole expressions, such as `happy`.
    Expressions,
    /// Shapes of the mouth for vowels, such as `aa`.
    Vowels,
    /// Eyelids and directions of the eyes.
    Eyes,
    /// Eyebrows.
    Brows,
    /// The jaw.
    Jaw,
    /// The lips.
    Mouth,
    /// Cheeks.
    Cheeks,
    /// The nose.
    Nose,
    /// The tongue.
    Tongue,
    /// All others.
    Other,
}

/// Starts of names in lower case without separators, with their groups.
const PREFIXES: &[(&str, ShapeGroup)] = &[
    ("eye", ShapeGroup::Eyes),
    ("blink", ShapeGroup::Eyes),
    ("look", ShapeGroup::Eyes),
    ("brow", ShapeGroup::Brows),
    ("jaw", ShapeGroup::Jaw),
    ("mouth", ShapeGroup::Mouth),
    ("cheek", ShapeGroup::Cheeks),
    ("nose", ShapeGroup::Nose),
    ("tongue", ShapeGroup::Tongue),
];

/// Whole names in lower case, with their groups. VRM 0 and 1 name the expressions differently.
const NAMES: &[(&str, ShapeGroup)] = &[
    ("happy", ShapeGroup::Expressions),
    ("angry", ShapeGroup::Expressions),
    ("sad", ShapeGroup::Expressions),
    ("relaxed", ShapeGroup::Expressions),
    ("surprised", ShapeGroup::Expressions),
    ("neutral", ShapeGroup::Expressions),
    ("joy", ShapeGroup::Expressions),
    ("sorrow", ShapeGroup::Expressions),
    ("fun", ShapeGroup::Expressions),
    ("aa", ShapeGroup::Vowels),
    ("ih", ShapeGroup::Vowels),
    ("ou", ShapeGroup::Vowels),
    ("ee", ShapeGroup::Vowels),
    ("oh", ShapeGroup::Vowels),
];

impl ShapeGroup {
    /// Returns the group of a shape key with this name.
    pub fn of(name: &str) -> Self {
        let plain: String =
            name.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect();
        let named = NAMES.iter().find(|(whole, _)| *whole == plain);
        let named = named.or_else(|| PREFIXES.iter().find(|(start, _)| plain.starts_with(start)));
        named.map_or(Self::Other, |(_, group)| *group)
    }

    /// Returns its title in the panel.
    pub fn title(self) -> &'static str {
        match self {
            Self::Expressions => "Expressions",
            Self::Vowels => "Vowels",
            Self::Eyes => "Eyes",
            Self::Brows => "Brows",
            Self::Jaw => "Jaw",
            Self::Mouth => "Mouth",
            Self::Cheeks => "Cheeks",
            Self::Nose => "Nose",
            Self::Tongue => "Tongue",
            Self::Other => "Other",
        }
    }
}
