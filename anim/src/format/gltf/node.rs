//! Where each node stands: relative to its parent, and in the scene.

use super::accessor::invalid;
use super::check as code;
use super::graph::Graph;
use crate::data::Transform;
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::HUGE;
use glam::{DMat4, Mat4, Quat, Vec3, Vec4};
use gltf::json;

/// A node's transform, taken apart and exact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub(super) parts: Transform,
    /// The matrix itself where `parts` cannot express it.
    pub(super) sheared: Option<Mat4>,
}

impl Local {
    pub(super) fn matrix(&self) -> Mat4 {
        self.sheared.unwrap_or_else(|| self.parts.to_matrix())
    }
}

/// How far a rotation's length may be from one before it is worth a warning (the Khronos validator's tolerance).
pub(super) const ROTATION_TOLERANCE: f32 = 0.00769;

/// Transforms of all nodes relative to their parents.
pub(super) fn locals(root: &json::Root, context: &ImportContext<'_>) -> Result<Vec<Local>, ImportError> {
    let mut locals = context.vec(&Place::Pointer("/nodes".to_owned()), root.nodes.len())?;
    for (index, node) in root.nodes.iter().enumerate() {
        context.work(1)?;
        locals.push(local(node, index, context)?);
    }
    Ok(locals)
}

fn local(node: &json::Node, index: usize, context: &ImportContext<'_>) -> Result<Local, ImportError> {
    let at = |member: &str| Place::Pointer(format!("/nodes/{index}/{member}"));
    let finite = |numbers: &[f32], member: &str| match numbers.iter().all(|number| number.is_finite()) {
        true => Ok(()),
        false => Err(invalid(at(member), code::VALUE_NOT_IN_RANGE, "a number is not finite".to_owned())),
    };
    let mut local = Local { parts: Transform::IDENTITY, sheared: None };
    if let Some(translation) = node.translation {
        finite(&translation, "translation")?;
        local.parts.translation = translation.into();
    }
    if let Some(rotation) = node.rotation {
        finite(&rotation.0, "rotation")?;
        local.parts.rotation = unit_rotation(Quat::from_array(rotation.0), || at("rotation"), context);
    }
    if let Some(scale) = node.scale {
        finite(&scale, "scale")?;
        local.parts.scale = scale.into();
    }
    if let Some(matrix) = node.matrix {
        finite(&matrix, "matrix")?;
        if node.translation.is_some() || node.rotation.is_some() || node.scale.is_some() {
            let text = "the matrix counts, the node's translation, rotation and scale do not";
            context.warn(at("matrix"), code::NODE_MATRIX_TRS, text);
        }
        local = taken_apart(Mat4::from_cols_array(&matrix), &at("matrix"), context)?;
    }
    if local.parts.translation.abs().max_element() > HUGE {
        context.warn(
            at("translation"),
            code::HUGE_TRANSLATION,
            "the node is too far away for single precision",
        );
    }
    Ok(local)
}

/// A matrix as translation, rotation and scale; as it is where it cannot be.
fn taken_apart(mut matrix: Mat4, place: &Place, context: &ImportContext<'_>) -> Result<Local, ImportError> {
    if matrix.row(3).abs_diff_eq(Vec4::W, 1e-5) {
        set_last_row(&mut matrix);
    } else {
        context.warn(
            place.clone(),
            code::NODE_MATRIX_NON_TRS,
            "the last row should be 0 0 0 1 and is taken to be so",
        );
        set_last_row(&mut matrix);
    }
    let parts = Transform::from_matrix(matrix);
    if !parts.is_finite() {
        let reason = "the matrix is too large to be taken apart".to_owned();
        return Err(invalid(place.clone(), code::TRANSFORM_OVERFLOW, reason));
    }
    // Only the axes: a large translation must not hide a small shear.
    let largest = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.abs().max_element());
    let tolerance = 1e-4 * largest.into_iter().fold(f32::MIN_POSITIVE, f32::max);
    if parts.to_matrix().abs_diff_eq(matrix, tolerance) {
        return Ok(Local { parts, sheared: None });
    }
    context.warn(
        place.clone(),
        code::NODE_MATRIX_NON_TRS,
        "the matrix is sheared; it is shown, but cannot be edited",
    );
    Ok(Local { parts, sheared: Some(matrix) })
}

pub(super) fn set_last_row(matrix: &mut Mat4) {
    (matrix.x_axis.w, matrix.y_axis.w, matrix.z_axis.w, matrix.w_axis.w) = (0.0, 0.0, 0.0, 1.0);
}

/// `rotation` with length one; the identity when it has none.
pub(super) fn unit_rotation(rotation: Quat, place: impl Fn() -> Place, context: &ImportContext<'_>) -> Quat {
    match unit(rotation) {
        Some((unit, error)) => {
            if error > ROTATION_TOLERANCE {
                context.warn(
                    place(),
                    code::ROTATION_NON_UNIT,
                    "the rotation is not of unit length and was made so",
                );
            }
            unit
        }
        None => {
            context.warn(
                place(),
                code::ROTATION_NON_UNIT,
                "the rotation has no length; none is taken instead",
            );
            Quat::IDENTITY
        }
    }
}

/// A finite quaternion with length one, and how far its length was from that; `None` for zero.
pub(super) fn unit(rotation: Quat) -> Option<(Quat, f32)> {
    // Double precision: the square of 1e-30 or 1e30 does not fit single.
    let wide = rotation.as_dquat();
    let length = wide.length();
    if length == 0.0 || !length.is_finite() {
        return None;
    }
    // Already unit to the last bit that counts: kept as it is.
    if (length - 1.0).abs() <= f64::from(f32::EPSILON) {
        return Some((rotation, 0.0));
    }
    Some(((wide * (1.0 / length)).as_quat(), (length - 1.0).abs() as f32))
}

/// Node space → scene space at rest, for all nodes; refused where it overflows.
pub(super) fn globals(
    graph: &Graph,
    locals: &[Local],
    context: &ImportContext<'_>,
) -> Result<Vec<Mat4>, ImportError> {
    let mut globals = context.filled(&Place::Pointer("/nodes".to_owned()), locals.len(), Mat4::IDENTITY)?;
    for &node in &graph.order {
        context.work(1)?;
        let parent = graph.parents[node as usize].map_or(Mat4::IDENTITY, |parent| globals[parent as usize]);
        let global = parent * locals[node as usize].matrix();
        if !global.is_finite() {
            let place = Place::Pointer(format!("/nodes/{node}"));
            let reason = "the transforms down to this node multiply to more than fits".to_owned();
            return Err(invalid(place, code::TRANSFORM_OVERFLOW, reason));
        }
        globals[node as usize] = global;
    }
    Ok(globals)
}

/// The inverse, computed in double precision; `None` where there is none that fits single precision.
pub(super) fn inverse(matrix: Mat4) -> Option<Mat4> {
    let wide: DMat4 = matrix.as_dmat4();
    let determinant = wide.determinant();
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    Some(wide.inverse().as_mat4()).filter(Mat4::is_finite)
}

/// The largest of three absolute values.
pub(super) fn largest(vector: Vec3) -> f32 {
    vector.abs().max_element()
}
