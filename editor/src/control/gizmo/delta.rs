//! Computes the new pose of each bone from one change of the whole selection.
//!
//! Every result is computed from the pose before the drag and one delta, never from the previous result, so errors do not
//! accumulate.
//!
//! Under a parent with non-uniform scale, the pose that would look exactly as if rotated or scaled in the world has shear in
//! it, which translation, rotation and scale cannot express. The result is the nearest one without shear: the joint moves
//! exactly to its target; the bone rotates by exactly the angle, about the axis as it is in the orthogonalized axes of the
//! parent; each local axis of the bone scales by the mean of the factors, weighted by how far it points along each. Without
//! non-uniform scale, or in local axes, that is exact. Under a parent with zero scale along some direction no position in the
//! world can be reached, and the joint stays.

use dragonfly_anim::data::Transform;
use dragonfly_anim::trig::rotation_about;
use dragonfly_picture::gizmo::{GizmoAxes, GizmoDelta, GizmoTarget, unit};
use glam::{DMat3, DVec3};

/// Returns the new pose of a bone relative to its parent. `pivot` is the point in the scene that it rotates and scales
/// about; `None` for its own joint. A delta that changes nothing, and one whose result would not be finite, give the
/// old pose bit for bit.
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
            let turn = rotation_about((axes * axis).normalize_or(DVec3::Y), frame.sign * angle);
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

/// Returns the translation that moves the joint by `by`, scene units.
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
