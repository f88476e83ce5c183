//! Places without a scale: of things, bones and points of a scene, and the attachment that decides a place.

use super::holds::{HoldCue, RigidPlace};
use super::spot::StageSpot;
use super::thing::PlannedThing;
use crate::data::Transform;
use crate::fast::matrix::{mat4, transform_point};
use crate::stage::scene::ThingState;
use crate::stage::time::StageTime;
use glam::{DVec3, Vec3};

/// Returns position and rotation of a transform.
pub(super) fn rigid(transform: &Transform) -> RigidPlace {
    RigidPlace {
        position: transform.translation.as_dvec3(),
        rotation: transform.rotation.as_dquat().normalize(),
    }
}

/// Returns the position of a spot in the scene.
pub(super) fn position_of(spot: StageSpot, things: &[ThingState]) -> DVec3 {
    match spot {
        StageSpot::Point(point) => point,
        StageSpot::Thing(thing) => things[thing].transform.translation.as_dvec3(),
        StageSpot::Bone(thing, bone) => {
            let state = &things[thing];
            let bone = state
                .pose
                .as_ref()
                .map_or(Vec3::ZERO, |pose| transform_point(pose.to_root.get(bone as usize), Vec3::ZERO));
            let Transform { translation, rotation, scale } = state.transform;
            (translation + rotation * (scale * bone)).as_dvec3()
        }
    }
}

/// Returns position and rotation of a spot, without any scale.
pub(super) fn rigid_of(spot: StageSpot, things: &[ThingState]) -> RigidPlace {
    let position = position_of(spot, things);
    let rotation = match spot {
        StageSpot::Point(_) => glam::DQuat::IDENTITY,
        StageSpot::Thing(thing) => things[thing].transform.rotation.as_dquat(),
        StageSpot::Bone(thing, bone) => {
            let state = &things[thing];
            let own = state.pose.as_ref().map_or(glam::Quat::IDENTITY, |pose| {
                Transform::from_matrix(mat4(pose.to_root.get(bone as usize))).rotation
            });
            (state.transform.rotation * own).as_dquat()
        }
    };
    RigidPlace { position, rotation: rotation.normalize() }
}

/// Returns the one of the first `count` attachments of a thing that decides where it is; `None` where its motions do.
pub(super) fn deciding_hold(planned: &PlannedThing, time: StageTime, count: usize) -> Option<usize> {
    let begun = planned.holds[..count].partition_point(|hold| hold.begin <= time);
    let hold = planned.holds[..begun].iter().rposition(HoldCue::is_known);
    let moved = planned.places.last_begin(time);
    hold.filter(|&at| moved.is_none_or(|moved| (planned.holds[at].begin, planned.holds[at].action) > moved))
}
