//! The choice of the take with which the one shown is compared, and the file that it may be from.

use dragonfly_anim::compare::pair_bones;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_document::LoadedModel;
use dragonfly_document::adapter::TakeId;
use std::sync::Arc;

/// The choice of the take with which the one shown is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CompareWith {
    /// Nothing.
    #[default]
    Nothing,
    /// The same take as it was when the file was opened.
    Opened,
    /// Another take of the model.
    Take(TakeId),
    /// A take of another file, by its index there.
    File(usize),
}

/// The other file, as the document read it, with its bones paired by name with those of the open model.
#[derive(Debug, Default)]
pub struct ComparedFile {
    file: Option<Arc<LoadedModel>>,
    /// The skeleton of the open model.
    of: Option<Arc<Skeleton>>,
    /// For each bone of the file, the bone of the open model.
    first_of: Arc<[Option<BoneIndex>]>,
}

impl ComparedFile {
    /// Returns the file.
    pub fn file(&self) -> Option<&Arc<LoadedModel>> {
        self.file.as_ref()
    }

    /// Returns for each bone of the file the bone of the open model with its name.
    pub fn first_of(&self) -> &Arc<[Option<BoneIndex>]> {
        &self.first_of
    }

    /// Returns whether no bone has the name of a bone of the open model.
    pub fn is_unpaired(&self) -> bool {
        self.first_of.iter().all(Option::is_none)
    }

    pub(super) fn set_file(&mut self, file: Arc<LoadedModel>) {
        *self = Self { file: Some(file), ..Self::default() };
    }

    /// Pairs the bones with those of the model that is open now.
    pub(super) fn update(&mut self, own: Option<&Arc<Skeleton>>) {
        let (Some(file), Some(own)) = (&self.file, own) else { return };
        if self.of.as_ref().is_some_and(|of| Arc::ptr_eq(of, own)) {
            return;
        }
        let skeleton = &file.model.animation.skeleton;
        let mut first_of = vec![None; skeleton.len()];
        for (first, second) in pair_bones(own, skeleton).both {
            first_of[second as usize] = Some(first);
        }
        (self.of, self.first_of) = (Some(Arc::clone(own)), first_of.into());
    }
}
