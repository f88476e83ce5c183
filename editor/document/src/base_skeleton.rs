//! The skeleton with which a history starts, where edits added root bones: the file that is opened for the history may have been
//! saved with other root bones.

use dragonfly_anim::data::{Bone, ModelData, Skeleton};
use dragonfly_anim::root_bone::{BoneShift, skeleton_with_root};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The root bones of a history, relative to the bones that no edit added.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct BaseSkeleton {
    /// Number of bones that no edit added.
    bones: usize,
    /// Names of the root bones above them when the history starts, from the topmost one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    roots: Vec<String>,
    /// Names of all root bones that edits ever added, which the file may have.
    ever: Vec<String>,
}

impl BaseSkeleton {
    /// Describes a history that starts with a skeleton to which no edit has added bones.
    pub(super) fn of(skeleton: &Skeleton) -> Self {
        Self { bones: skeleton.len(), roots: Vec::new(), ever: Vec::new() }
    }

    /// Returns whether edits ever added root bones.
    pub(super) fn has_roots(&self) -> bool {
        !self.ever.is_empty()
    }

    /// Notes that an edit added a root bone.
    pub(super) fn note(&mut self, name: &str) {
        if !self.ever.iter().any(|other| other == name) {
            self.ever.push(name.to_owned());
        }
    }

    /// Notes that the history starts after the edit that added a root bone.
    pub(super) fn start_with(&mut self, name: &str) {
        self.roots.insert(0, name.to_owned());
    }

    /// Returns the skeleton with which the history starts, from the model in the file; `None` where the file has other bones.
    pub(super) fn skeleton(&self, model: &ModelData) -> Option<Arc<Skeleton>> {
        let file = &model.animation.skeleton;
        let above = file.len().checked_sub(self.bones)?;
        let names: Vec<&String> = file.bones.iter().take(above).map(|bone| &bone.name).collect();
        if names.iter().copied().eq(&self.roots) {
            return Some(Arc::clone(file));
        }
        if !names.into_iter().all(|name| self.ever.contains(name)) {
            return None;
        }
        let of_skins = model.skins.iter().flat_map(|skin| &skin.bones).copied();
        let mut carriers = model.instances.iter().filter_map(|instance| instance.bone).chain(of_skins);
        if carriers.any(|bone| (bone as usize) < above) {
            return None;
        }
        let mut skeleton = without_roots(file, above)?;
        for name in self.roots.iter().rev() {
            skeleton = skeleton_with_root(&skeleton, name).ok()?;
        }
        Some(Arc::new(skeleton))
    }
}

/// Returns a skeleton without its topmost bones; `None` where they are not one above the other, and above all others.
fn without_roots(skeleton: &Skeleton, count: usize) -> Option<Skeleton> {
    let below = |bone: &Bone| {
        let parent = bone.parent.and_then(|parent| parent.checked_sub(count as u32));
        Bone { parent, ..bone.clone() }
    };
    let rest = Skeleton { bones: skeleton.bones.iter().skip(count).map(below).collect() };
    let shift = BoneShift::between(skeleton, &rest)?;
    (shift.removed() == count).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::about::tests::bone;
    use crate::adapter::ModelAdapter;
    use crate::edit::{AddRootBone, RenameTake, TakeRef};
    use crate::history::{Edited, MAX_STEPS};
    use crate::recorded::{EditsOrigin, Snapshot};
    use dragonfly_anim::data::{AnimationData, Skin, Take, Track};

    fn model(names: &[&str]) -> ModelData {
        let mut bones: Vec<_> = names.iter().map(|name| bone(name)).collect();
        for (index, bone) in bones.iter_mut().enumerate() {
            bone.parent = index.checked_sub(1).map(|parent| parent as u32);
        }
        let animation = AnimationData { skeleton: Arc::new(Skeleton { bones }), takes: Vec::new() };
        ModelData { animation, ..ModelData::default() }
    }

    #[test]
    fn the_first_skeleton_follows_from_a_file_saved_before_or_after_any_edit() {
        let opened = model(&["Hips", "Leg"]);
        let skeleton = &opened.animation.skeleton;
        let mut base = BaseSkeleton::of(skeleton);
        assert!(Arc::ptr_eq(&base.skeleton(&opened).unwrap(), skeleton));
        base.note("Root");
        base.note("Mover");
        let files = [&["Hips", "Leg"][..], &["Root", "Hips", "Leg"], &["Mover", "Root", "Hips", "Leg"]];
        for file in files {
            assert_eq!(base.skeleton(&model(file)).as_ref(), Some(skeleton), "{file:?}");
        }
        // The oldest step is forgotten.
        base.start_with("Root");
        let with_root = model(&["Root", "Hips", "Leg"]);
        for file in files {
            assert_eq!(base.skeleton(&model(file)).as_ref(), Some(&with_root.animation.skeleton), "{file:?}");
        }
    }

    #[test]
    fn a_history_whose_oldest_steps_are_forgotten_starts_with_their_root_bones() {
        let mut opened = model(&["Hips", "Leg"]);
        let tracks = (0..2).map(|bone| Track { bone, ..Track::default() }).collect();
        opened.animation.takes.push(Arc::new(Take { tracks, ..Take::default() }));
        let mut edited = Edited::new(ModelAdapter::of(&opened));
        edited.apply(AddRootBone { name: "Root".to_owned() }.into(), None).unwrap();
        for step in 0..MAX_STEPS {
            let name = step.to_string();
            edited.apply(RenameTake { take: TakeRef::Index(0), name }.into(), None).unwrap();
        }
        assert!(edited.is_cut());
        let bytes = Snapshot::bytes(EditsOrigin::new(None, Default::default()), &edited, None).unwrap();
        let (snapshot, takes) = Snapshot::read(&bytes).unwrap();
        let start = snapshot.skeleton.unwrap().skeleton(&opened).unwrap();
        assert_eq!(&start, edited.adapter().skeleton());
        assert!(crate::base::read(takes.unwrap(), start.len()).is_some());
    }

    #[test]
    fn a_file_with_other_bones_or_a_mesh_on_a_root_bone_is_refused() {
        let mut base = BaseSkeleton::of(&model(&["Hips", "Leg"]).animation.skeleton);
        base.note("Root");
        for other in [&["Leg"][..], &["Armature", "Hips", "Leg"], &["Hips", "Leg", "Foot"]] {
            assert_eq!(base.skeleton(&model(other)), None, "{other:?}");
        }
        let mut skinned = model(&["Root", "Hips", "Leg"]);
        assert!(base.skeleton(&skinned).is_some());
        skinned.skins.push(Skin { bones: vec![0], ..Skin::default() });
        assert_eq!(base.skeleton(&skinned), None);
    }
}
