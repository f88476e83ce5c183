//! A drag of the gizmo or the motion path: its gesture, and the bones that follow those that it moves.

use crate::control::gizmo::BoneDrag;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::edit::{BonePose, BoneRef};
use dragonfly_document::history::Gesture;
use dragonfly_document::posing::{self, Goal, poses_of_drag};
use dragonfly_picture::gizmo::{GizmoTarget, Tool};
use glam::Vec3;

/// The bones that follow a drag. Decided once for a drag, so that it moves the same bones from its first move to its
/// last, even if settings change during the drag.
#[derive(Debug, Default)]
enum Following {
    /// No drag is in progress, or it has not moved yet.
    #[default]
    Undecided,
    /// Bones move alone: the edit has what the gizmo computed, to the bit.
    Nothing,
    /// The poses at the start of the drag, with pins and IK.
    From(Box<posing::PoseDragState>),
}

/// A drag of the gizmo or the motion path.
#[derive(Debug, Default)]
pub struct ToolDrag {
    /// The gesture, once the drag changed something.
    gesture: Option<Gesture>,
    following: Following,
}

impl ToolDrag {
    /// Returns the gesture of the drag, once it changed something.
    pub fn gesture(&self) -> Option<Gesture> {
        self.gesture
    }

    /// Notes the gesture of the drag.
    pub(super) fn begin(&mut self, gesture: Gesture) {
        self.gesture = Some(gesture);
    }

    /// Ends the drag and returns its gesture, if it changed something.
    pub(super) fn end(&mut self) -> Option<Gesture> {
        self.following = Following::Undecided;
        self.gesture.take()
    }

    /// Returns whether the bones that follow are still to be decided.
    pub(super) fn is_undecided(&self) -> bool {
        matches!(self.following, Following::Undecided)
    }

    /// Decides for the whole drag which bones follow; with `None`, bones move alone.
    pub(super) fn follow(&mut self, hold: Option<posing::PoseDragState>) {
        self.following = hold.map_or(Following::Nothing, |hold| Following::From(Box::new(hold)));
    }

    /// Returns the poses for bones that the gizmo dragged: with IK on also the poses of the bones above them, and the
    /// poses that keep pinned bones in place.
    pub(super) fn poses<'a>(
        &mut self,
        tool: Tool,
        dragged: impl Iterator<Item = (&'a BoneDrag, &'a GizmoTarget)>,
    ) -> Vec<BonePose> {
        let Following::From(hold) = &mut self.following else {
            return dragged.map(|(drag, before)| pose_of(tool, drag, before)).collect();
        };
        let (mut poses, mut goals) = (Vec::new(), Vec::new());
        for (drag, before) in dragged {
            if tool == Tool::Move && hold.moves_by_chain(drag.bone) {
                let parent = before.parent_to_root.as_dmat4();
                let place = parent.transform_point3(drag.to_parent.translation.as_dvec3()).as_vec3();
                goals.push(Goal { bone: drag.bone, place });
            } else {
                poses.push(pose_of(tool, drag, before));
            }
        }
        poses_of_drag(hold, &poses, &goals)
    }

    /// Returns the poses that move the joint of `bone` to `place`, scene space. `Err` where the bone moves alone, `Ok(None)`
    /// where it cannot be moved there.
    pub(super) fn poses_of_path(
        &mut self,
        bone: BoneIndex,
        place: Vec3,
    ) -> Result<Option<Vec<BonePose>>, Alone> {
        let Following::From(hold) = &mut self.following else { return Err(Alone) };
        let (mut poses, mut goals) = (Vec::new(), Vec::new());
        if hold.moves_by_chain(bone) {
            goals.push(Goal { bone, place });
        } else {
            let Some(to) = hold.in_parent(bone, place) else { return Ok(None) };
            poses.push(moved(bone, to));
        }
        Ok(Some(poses_of_drag(hold, &poses, &goals)))
    }
}

/// No other bone follows the one that is dragged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Alone;

/// Returns the pose that moves a bone to `to`, parent space.
pub(super) fn moved(bone: BoneIndex, to: Vec3) -> BonePose {
    let translation = Some(to.to_array());
    BonePose { bone: BoneRef::Index(bone), translation, rotation: None, scale: None }
}

/// Returns the channel that the tool changes; also the translation if a pivot outside of the bone moves it.
fn pose_of(tool: Tool, drag: &BoneDrag, before: &GizmoTarget) -> BonePose {
    let (now, was) = (drag.to_parent, before.to_parent);
    let translation = tool == Tool::Move || now.translation != was.translation;
    BonePose {
        bone: BoneRef::Index(drag.bone),
        translation: translation.then(|| now.translation.to_array()),
        rotation: (tool == Tool::Rotate).then(|| now.rotation.to_array()),
        scale: (tool == Tool::Scale).then(|| now.scale.to_array()),
    }
}
