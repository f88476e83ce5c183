//! References of an edit: to a take, to bones, to channels, to keys.

use dragonfly_anim::data::{BoneIndex, Skeleton};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A take, by its index in the list or by its name, or a layer of it. A name that several takes share means the first of them.
///
/// In JSON a number, a string, or an object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TakeRef {
    /// Index in the list of takes as it is now, from 0.
    Index(usize),
    /// Its name.
    Name(String),
    /// A layer of a take: `{"take": "Walk", "layer": "Arm up"}`.
    Layer {
        /// The take below it, by index or name.
        take: Box<TakeRef>,
        /// The layer.
        layer: LayerRef,
    },
}

/// A layer of a take, by its index, from 0 for the lowest, or by its name. A name that several layers share means the lowest of them.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum LayerRef {
    /// Index in the list of layers as it is now, from 0 for the lowest.
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

/// A mesh with shape keys, by its index in the list of meshes in the scene or by its name. A name that several meshes share means
/// the first of them that has the shape key.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MeshRef {
    /// Index in the list of meshes in the scene, from 0.
    Index(u32),
    /// Its name.
    Name(String),
}

/// A shape key of a mesh, by its index or by its name. A name that several shape keys share means the first of them.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ShapeRef {
    /// Index in the mesh, from 0.
    Index(u32),
    /// Its name; that of one without a name is `Shape 1`, counted from 1.
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

/// Finds bones of a skeleton. Names are looked up in a map, which is made for the first of them.
pub(crate) struct BoneFinder<'a> {
    skeleton: &'a Skeleton,
    names: Option<HashMap<&'a str, BoneIndex>>,
}

impl<'a> BoneFinder<'a> {
    /// Finds bones of `skeleton`.
    pub(crate) fn new(skeleton: &'a Skeleton) -> Self {
        Self { skeleton, names: None }
    }

    /// Returns what [`BoneRef::find_in`] returns.
    pub(crate) fn find(&mut self, bone: &BoneRef) -> Option<BoneIndex> {
        let BoneRef::Name(name) = bone else { return bone.find_in(self.skeleton) };
        let names = self.names.get_or_insert_with(|| {
            // From the last to the first, because the first of several bones of a name is meant.
            let bones = self.skeleton.bones.iter().enumerate().rev();
            bones.map(|(index, bone)| (bone.name.as_str(), index as BoneIndex)).collect()
        });
        names.get(name.as_str()).copied()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::about::tests::bone;

    #[test]
    fn a_finder_finds_the_same_bones_as_a_search_also_where_names_are_shared() {
        let skeleton = Skeleton { bones: ["Hip", "Hand", "Hand", ""].map(bone).into() };
        let mut finder = BoneFinder::new(&skeleton);
        let name = |name: &str| BoneRef::Name(name.to_owned());
        for (given, expected) in [
            (name("Hand"), Some(1)),
            (name(""), Some(3)),
            (name("Foot"), None),
            (BoneRef::Index(2), Some(2)),
            (BoneRef::Index(4), None),
        ] {
            assert_eq!(finder.find(&given), expected, "{given:?}");
            assert_eq!(given.find_in(&skeleton), expected, "{given:?}");
        }
    }
}
