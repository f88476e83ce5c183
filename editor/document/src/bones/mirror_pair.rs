//! A mirror pair: a left and a right bone, and the reason for it.

use dragonfly_anim::data::BoneIndex;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodySide {
    /// Left, usually of the character.
    Left,
    /// Right.
    Right,
}

/// The reason for a pair, the most reliable first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MirrorGuess {
    /// The same name with the side exchanged.
    Name,
    /// The same name except for capitals.
    Capitals,
    /// The same words in another spelling.
    Words,
    /// The same name except for a number at its end.
    Numbers,
    /// The side is part of another word, as in `leftarm`.
    Glued,
    /// Their positions are symmetric; their names disagree or name only the side.
    Place,
    /// The user chose it.
    Chosen,
}

impl MirrorGuess {
    /// The reasons from names, the most reliable first.
    pub const NAMES: [Self; 5] = [Self::Name, Self::Capitals, Self::Words, Self::Numbers, Self::Glued];

    /// Returns the text for lists.
    pub fn title(self) -> &'static str {
        match self {
            Self::Name => "by name",
            Self::Capitals => "by name, except for capitals",
            Self::Words => "by name, in another spelling",
            Self::Numbers => "by name, except for a number",
            Self::Glued => "by a side inside another word",
            Self::Place => "by mirrored positions",
            Self::Chosen => "chosen",
        }
    }
}

/// Two bones that mirror each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MirrorPair {
    /// The left bone.
    pub left: BoneIndex,
    /// The right bone.
    pub right: BoneIndex,
    /// The reason for the pair.
    pub guess: MirrorGuess,
}
