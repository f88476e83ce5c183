//! The skeleton: a tree of bones stored as a list, and the skins that bind geometry to it.

use super::Transform;
use glam::Mat4;

/// Position of a bone in [`Skeleton::bones`].
pub type BoneIndex = u32;

/// A bone (joint): its parent by index, its rest pose, its bind pose (thesis §2.1.2.2, §3.1.2).
///
/// Any scene node that moves is a bone: joints of skins, animated nodes, and the ancestors of both.
#[derive(Clone, Debug, PartialEq)]
#[doc(alias = "joint")]
pub struct Bone {
    /// As in the file; need not be unique, may be empty.
    pub name: String,
    /// Always smaller than the bone's own index, so one forward pass visits parents first; `None` for a root.
    pub parent: Option<BoneIndex>,
    /// Pose relative to the parent when nothing animates it.
    pub rest: Transform,
    /// The exact rest matrix, kept only where it is sheared and `rest` cannot express it; used while no channel
    /// animates the bone.
    pub rest_matrix: Option<Mat4>,
    /// Offset (inverse bind matrix): bind space → bone space, never modified. That of the first skin that uses the
    /// bone; for bones of no skin the inverse of the rest pose's to-root.
    #[doc(alias = "inverse bind matrix")]
    pub offset: Mat4,
    /// Index of the node in a glTF file; `None` for other formats.
    pub node: Option<u32>,
}

impl Bone {
    /// Returns a root bone of no file, which rests at the origin.
    pub fn root(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            parent: None,
            rest: Transform::IDENTITY,
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        }
    }
}

/// All bones, parents before children.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias("rig", "armature"))]
pub struct Skeleton {
    /// The bones; every parent comes before its children.
    pub bones: Vec<Bone>,
}

impl Skeleton {
    /// Returns the index of the first bone called `name`.
    pub fn find(&self, name: &str) -> Option<BoneIndex> {
        self.bones.iter().position(|bone| bone.name == name).map(|index| index as BoneIndex)
    }

    /// Returns the children of `bone` in index order; for `None`, the roots.
    pub fn children(&self, bone: Option<BoneIndex>) -> impl Iterator<Item = BoneIndex> + '_ {
        (0..self.bones.len() as BoneIndex).filter(move |&index| self.bones[index as usize].parent == bone)
    }

    /// Returns the parent of `bone`; `None` for a root and for a bone that does not exist. A parent that does not come before its child is
    /// ignored, so that going from parent to parent ends for any data.
    pub fn parent(&self, bone: BoneIndex) -> Option<BoneIndex> {
        self.bones.get(bone as usize)?.parent.filter(|&parent| parent < bone)
    }

    /// Returns the bones above `bone`, the nearest first, see [`Self::parent`].
    pub fn ancestors(&self, bone: BoneIndex) -> impl Iterator<Item = BoneIndex> + '_ {
        std::iter::successors(self.parent(bone), |&bone| self.parent(bone))
    }

    /// Returns `bone` and the bones above it, the nearest first; none for a bone that does not exist.
    pub fn with_ancestors(&self, bone: BoneIndex) -> impl Iterator<Item = BoneIndex> + '_ {
        let first = Some(bone).filter(|&bone| (bone as usize) < self.bones.len());
        std::iter::successors(first, |&bone| self.parent(bone))
    }

    /// Returns all bones from the root down, those with the same number of bones above them by name: the same order in every version of a model, whatever
    /// that of its file. Bones that share a name are in the order of the file.
    pub fn by_depth_and_name(&self) -> Vec<BoneIndex> {
        let mut depths: Vec<u32> = Vec::with_capacity(self.len());
        for bone in 0..self.len() {
            let parent = self.parent(bone as BoneIndex);
            depths.push(parent.map_or(0, |parent| depths[parent as usize] + 1));
        }
        let mut order: Vec<BoneIndex> = (0..self.len() as BoneIndex).collect();
        let key = |bone: BoneIndex| (depths[bone as usize], self.bones[bone as usize].name.as_str());
        order.sort_by(|a, b| key(*a).cmp(&key(*b)));
        order
    }

    /// Returns the number of bones.
    pub fn len(&self) -> usize {
        self.bones.len()
    }

    /// Returns whether there is no bone.
    pub fn is_empty(&self) -> bool {
        self.bones.is_empty()
    }
}

/// The bones that move a mesh, and the offset of each.
///
/// Vertices refer to positions in `bones`, not to bones, so several skins can share a skeleton.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// As in the file; may be empty.
    pub name: String,
    /// The joints, in the skin's order.
    pub bones: Vec<BoneIndex>,
    /// Bind space → bone space, one per joint (inverse bind matrices).
    #[doc(alias = "inverse bind matrices")]
    pub offsets: Vec<Mat4>,
}
