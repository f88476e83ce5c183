//! From one change of the whole selection to the new pose of each bone.
//!
//! Every result is computed from the pose before the drag and one delta, never from the result before, so nothing adds up.
//!
//! Under a parent that is stretched unevenly, the pose that would look exactly as if turned or stretched in the world has
//! shear in it, which translation, rotation and scale cannot express. What is done: the joint goes exactly where it should;
//! the bone turns by exactly the angle, about the axis as it stands in the parent's right-angled axes; each of the bone's
//! own axes grows by the mean of the factors, weighted by how far it points along each. Where nothing is stretched
//! unevenly, or the axes are the bone's own, that is exact. Under a parent that is flat in some direction no place in the
//! world can be reached, and the joint stays.

use dragonfly_anim::data::Transform;
use dragonfly_picture::gizmo::{GizmoAxes, GizmoDelta, GizmoTarget, unit};
use glam::{DMat3, DQuat, DVec3};

/// The new pose of a bone relative to its parent. `pivot` is the place in the scene that it turns and grows about; `None` for
/// its own joint. A delta that changes nothing, and one whose result would not be finite, give the pose as it was, bit for
/// bit.
pub(super) fn apply(
    target: &GizmoTarget,
    frame: &GizmoAxes,
    pivot: Option<DVec3>,
    delta: &GizmoDelta,
) -> Transform {
    let start = target.to_parent;
    if delta.is_identity() {
        return start;
    }
    let axes = frame.axes;
    let mut pose = start;
    match *delta {
        GizmoDelta::Move(by) => pose.translation = moved(target, axes * by),
        GizmoDelta::Rotate { axis, angle } => {
            let turn = DQuat::from_axis_angle((axes * axis).normalize_or(DVec3::Y), frame.sign * angle);
            let parent = target.parent_frame().rotation();
            let own = unit(start.rotation.as_dquat());
            pose.rotation = unit(parent.conjugate() * turn * parent * own).as_quat().normalize();
            if let Some(pivot) = pivot {
                let from = target.origin() - pivot;
                pose.translation = moved(target, turn * from - from);
            }
        }
        GizmoDelta::Scale(by) => {
            let own = target.parent_frame().axes * DMat3::from_quat(unit(start.rotation.as_dquat()));
            let factor = |axis: usize| {
                let along = axes.transpose() * own.col(axis);
                (along * along).dot(by)
            };
            let factors = DVec3::new(factor(0), factor(1), factor(2));
            pose.scale = (start.scale.as_dvec3() * factors).as_vec3();
            if let Some(pivot) = pivot {
                let from = target.origin() - pivot;
                let stretched = axes * (by * (axes.transpose() * from));
                pose.translation = moved(target, stretched - from);
            }
        }
    }
    if pose.is_finite() { pose } else { start }
}

/// The translation that brings the joint `by` scene units further.
fn moved(target: &GizmoTarget, by: DVec3) -> glam::Vec3 {
    let start = target.to_parent.translation;
    let linear = DMat3::from_mat4(target.parent());
    let volume = linear.x_axis.length() * linear.y_axis.length() * linear.z_axis.length();
    let has_inverse = linear.determinant().abs() > volume * 1e-9 && volume > 0.0;
    if !has_inverse || by == DVec3::ZERO {
        return start;
    }
    (start.as_dvec3() + linear.inverse() * by).as_vec3()
}
