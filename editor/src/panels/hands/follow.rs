//! What follows the bones that a hand moves: those above them with IK on, and whatever keeps pinned bones in place.

use crate::control::gizmo::BoneDrag;
use crate::panels::state::State;
use dragonfly_document::edit::{BonePose, BoneRef};
use dragonfly_document::posing::{self, Goal, poses_of_drag};
use dragonfly_picture::gizmo::{GizmoTarget, Tool};

/// Decided once a drag, so that it means the same bones from its first move to its last, whatever is switched on the way.
#[derive(Debug, Default)]
pub(super) enum Following {
    /// No drag goes on.
    #[default]
    Undecided,
    /// Bones move alone: what is sent is what the gizmo made, to the bit.
    Nothing,
    /// How everything stood when the drag began.
    From(Box<posing::PoseDragState>),
}

impl State {
    /// Notes how everything stands, at the begin of a drag of the gizmo. Does nothing while it goes on.
    pub(super) fn begin_following(&mut self) {
        if matches!(self.hold.following, Following::Undecided) {
            let hold = if self.follows() { self.hold() } else { None };
            self.hold.following = hold.map_or(Following::Nothing, |hold| Following::From(Box::new(hold)));
        }
    }

    /// Can any bone follow another one that is moved?
    pub(super) fn follows(&self) -> bool {
        self.ik.on || !self.pins.is_empty()
    }

    /// The poses that the gizmo made: the channel it is for, what follows from a pivot elsewhere, and the bones that follow.
    pub(super) fn dragged(&mut self) -> Vec<BonePose> {
        let gizmo = &self.hands.gizmo().gizmo;
        let made = gizmo.drag().bones.iter().zip(gizmo.before());
        let tool = gizmo.tool;
        let Following::From(hold) = &mut self.hold.following else {
            return made.map(|(drag, before)| pose_of(tool, drag, before)).collect();
        };
        let (mut poses, mut goals) = (Vec::new(), Vec::new());
        for (drag, before) in made {
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
}

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
