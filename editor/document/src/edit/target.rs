//! References of an edit: to a take, to bones, to channels, to keys.

use dragonfly_anim::data::{BoneIndex, Skeleton};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A take, by its index in the list or by its name. A name that several takes share means the first of them.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TakeRef {
    /// Index in the list of takes as it is now, from 0.
    Index(usize),
    /// Its name.
    Name(String),
}

/// A bone, by its index or by its name. A name that several bones share means the first of them.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum BoneRef {
    /// Index in the skeleton, from 0.
    Index(u32),
    /// Its name.
    Name(String),
}

impl BoneRef {
    /// Returns the index of the bone in a skeleton; `None` where the skeleton does not have it.
    pub fn find_in(&self, skeleton: &Skeleton) -> Option<BoneIndex> {
        match self {
            Self::Index(index) => Some(*index).filter(|&index| (index as usize) < skeleton.len()),
            Self::Name(name) => skeleton.find(name),
        }
    }
}

/// The part of a bone's pose that a channel animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Property {
    /// Meters, parent space.
    Translation,
    /// Unit quaternion, parent space.
    Rotation,
    /// Factors per axis.
    Scale,
}

impl Property {
    /// All three channels of a bone.
    pub const ALL: [Self; 3] = [Self::Translation, Self::Rotation, Self::Scale];

    /// Returns its name in files and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
        }
    }
}

/// Keys of a take, selected by channel and by time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeySet {
    /// The bones; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// The channels of these bones; all three where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub properties: Vec<Property>,
    /// Seconds: only the keys at these times, to within [`SAME_TIME`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f32>>,
    /// Seconds: only keys at or after this time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f32>,
    /// Seconds: only keys at or before this time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f32>,
}

impl KeySet {
    /// Returns whether a key at `time` seconds belongs to the set.
    pub fn holds(&self, time: f32) -> bool {
        let at = |times: &Vec<f32>| times.iter().any(|&wanted| (wanted - time).abs() <= SAME_TIME);
        self.at.as_ref().is_none_or(at)
            && self.from.is_none_or(|from| time >= from - SAME_TIME)
            && self.to.is_none_or(|to| time <= to + SAME_TIME)
    }
}

/// Seconds: keys nearer to each other than this are at the same time. Half of a tenth of a millisecond, so that a time typed with four
/// digits finds its key, and 10,000 keys a second are still distinct.
pub const SAME_TIME: f32 = 5e-5;
