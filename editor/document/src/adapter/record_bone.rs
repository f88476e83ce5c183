//! Bones in the records that a file keeps in its extras.

use dragonfly_anim::data::{BoneIndex, Skeleton};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A bone, by its name and, because names may occur twice, by its node in the file.
#[derive(Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(super) struct RecordBone {
    bone: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    node: Option<u32>,
}

impl RecordBone {
    pub(super) fn of(skeleton: &Skeleton, bone: BoneIndex) -> Option<Self> {
        let found = skeleton.bones.get(bone as usize)?;
        Some(Self { bone: found.name.clone(), node: found.node })
    }
}

/// Finds the bones of records in a skeleton.
pub(super) struct RecordBones<'a>(HashMap<(&'a str, Option<u32>), BoneIndex>);

impl<'a> RecordBones<'a> {
    pub(super) fn of(skeleton: &'a Skeleton) -> Self {
        let mut found = HashMap::new();
        for (index, bone) in skeleton.bones.iter().enumerate() {
            found.entry((bone.name.as_str(), bone.node)).or_insert(index as BoneIndex);
            // The first bone of a name, for a file in which another program has renumbered the nodes.
            found.entry((bone.name.as_str(), None)).or_insert(index as BoneIndex);
        }
        Self(found)
    }

    pub(super) fn find(&self, record: &RecordBone) -> Option<BoneIndex> {
        let name = record.bone.as_str();
        self.0.get(&(name, record.node)).or_else(|| self.0.get(&(name, None))).copied()
    }
}
