//! What an edit is about: which take, which bones, which channels, which keys.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A take, by its place in the list or by its name; of several takes with one name the first is meant.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TakeRef {
    /// Place in the list of takes as it is now, from 0.
    Index(usize),
    /// Its name.
    Name(String),
}

/// A bone, by its index or by its name; of several bones with one name the first is meant.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum BoneRef {
    /// Place in the skeleton, from 0.
    Index(u32),
    /// Its name.
    Name(String),
}

/// What of a bone's pose a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Property {
    /// Metres, parent space.
    Translation,
    /// Unit quaternion, parent space.
    Rotation,
    /// Factors per axis.
    Scale,
}

impl Property {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Translation, Self::Rotation, Self::Scale];

    /// As people and files call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
        }
    }
}

/// Keys of a take: those of some channels, at some times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeySet {
    /// Which bones; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// Which of their channels; all three where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub properties: Vec<Property>,
    /// Seconds: the keys at just these times. A key nearer than [`SAME_TIME`] is meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f32>>,
    /// Seconds: no key before this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f32>,
    /// Seconds: no key after this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f32>,
}

impl KeySet {
    /// Does a key at `time` seconds belong to it?
    pub fn holds(&self, time: f32) -> bool {
        let at = |times: &Vec<f32>| times.iter().any(|&wanted| (wanted - time).abs() <= SAME_TIME);
        self.at.as_ref().is_none_or(at)
            && self.from.is_none_or(|from| time >= from - SAME_TIME)
            && self.to.is_none_or(|to| time <= to + SAME_TIME)
    }
}

/// Seconds: keys nearer to each other than this are at the same time. A tenth of a millisecond, so that a time typed
/// with four digits finds its key, and 10,000 keys a second are still apart.
pub const SAME_TIME: f32 = 5e-5;
