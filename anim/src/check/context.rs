//! The context of a rule that examines takes.

use super::path::{ModelPath, PathKind};
use crate::data::{ModelData, Skeleton, Take};

/// A take with its context.
pub(crate) struct TakeContext<'a> {
    pub(crate) take: &'a Take,
    pub(crate) skeleton: &'a Skeleton,
    /// Number of the take in its model.
    pub(crate) number: usize,
    /// The model; `None` where the take is checked by itself.
    pub(crate) model: Option<&'a ModelData>,
}

impl TakeContext<'_> {
    /// Returns the path of the take.
    pub(crate) fn path(&self) -> ModelPath {
        ModelPath::of(PathKind::Take, self.number, &self.take.name)
    }

    /// Returns the path of a bone of the skeleton, within the take.
    pub(crate) fn bone(&self, bone: usize) -> ModelPath {
        let name = self.skeleton.bones.get(bone).map_or("", |bone| bone.name.as_str());
        self.path().then(PathKind::Bone, bone, name)
    }
}
