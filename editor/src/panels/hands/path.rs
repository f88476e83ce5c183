//! The motion path of the selected bone: where its joint is, frame by frame.

use crate::control::gizmo::GizmoTarget;
use crate::control::path::PathKey;
use crate::document::edit::{BonePose, BoneRef, Edit};
use crate::panels::state::State;

impl State {
    /// The edit that puts the joint of the selected bone there at a key.
    pub(super) fn path_edit(&mut self, key: PathKey) -> Option<Edit> {
        let (view, bone, take) = (self.view.as_ref()?, self.selection.active()?, self.take_ref()?);
        let skeleton = &view.loaded.model.animation.skeleton;
        let animation = self.trail.posed.update(view, self.playback.take, key.time);
        let target = GizmoTarget::of(skeleton, animation.poses(), animation.to_root(), bone)?;
        let to_parent = target.parent_to_root.as_dmat4();
        let place = to_parent.inverse().transform_point3(key.place.as_dvec3()).as_vec3();
        let translation = Some(place.to_array()).filter(|_| place.is_finite())?;
        let pose = BonePose {
            bone: BoneRef::Index(bone),
            translation: Some(translation),
            rotation: None,
            scale: None,
        };
        Some(Edit::Set { take, time: key.time, poses: vec![pose] })
    }
}

/// What is known of the path.
#[derive(Debug, Default)]
pub struct Trail {
    /// Poses at other times than the one shown.
    pub(super) posed: crate::panels::state::Posed,
}
