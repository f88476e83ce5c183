//! Transforms of nodes, relative to their parents and in the scene.

use super::accessor::invalid;
use super::check as code;
use super::graph::Graph;
use crate::data::Transform;
use crate::format::matrices::split;
pub(super) use crate::format::matrices::{inverse, unit};
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::HUGE;
use glam::{Mat4, Quat, Vec3, Vec4};
use gltf::json;

/// Transform of a node, decomposed without loss.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalTransform {
    pub(super) parts: Transform,
    /// The matrix itself if `parts` cannot represent it.
    pub(super) sheared: Option<Mat4>,
}

impl LocalTransform {
    pub(super) fn matrix(&self) -> Mat4 {
        self.sheared.unwrap_or_else(|| self.parts.to_matrix())
    }
}

/// Largest deviation of a rotation's length from one without a warning (the Khronos validator's tolerance).
pub(super) const ROTATION_TOLERANCE: f32 = 0.00769;

/// Returns the transforms of all nodes relative to their parents.
pub(super) fn locals(
    root: &json::Root,
    context: &ImportContext<'_>,
) -> Result<Vec<LocalTransform>, ImportError> {
    let mut locals = context.vec(&Place::Pointer("/nodes".to_owned()), root.nodes.len())?;
    for (index, node) in root.nodes.iter().enumerate() {
        context.work(1)?;
        locals.push(local(node, index, context)?);
    }
    Ok(locals)
}

fn local(
    node: &json::Node,
    index: usize,
    context: &ImportContext<'_>,
) -> Result<LocalTransform, ImportError> {
    let at = |member: &str| Place::Pointer(format!("/nodes/{index}/{member}"));
    let finite = |numbers: &[f32], member: &str| match numbers.iter().all(|number| number.is_finite()) {
        true => Ok(()),
        false => Err(invalid(at(member), code::VALUE_NOT_IN_RANGE, "a number is not finite".to_owned())),
    };
    let mut local = LocalTransform { parts: Transform::IDENTITY, sheared: None };
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
            let text = "the node has a matrix; its translation, rotation and scale are ignored";
            context.warn(at("matrix"), code::NODE_MATRIX_TRS, text);
        }
        local = decomposed(Mat4::from_cols_array(&matrix), &at("matrix"), context)?;
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

/// Decomposes a matrix into translation, rotation and scale; keeps the matrix if that is not possible.
fn decomposed(
    mut matrix: Mat4,
    place: &Place,
    context: &ImportContext<'_>,
) -> Result<LocalTransform, ImportError> {
    if matrix.row(3).abs_diff_eq(Vec4::W, 1e-5) {
        set_last_row(&mut matrix);
    } else {
        context.warn(
            place.clone(),
            code::NODE_MATRIX_NON_TRS,
            "the last row should be 0 0 0 1 and was replaced by that",
        );
        set_last_row(&mut matrix);
    }
    let Some((parts, sheared)) = split(matrix) else {
        let reason = "the matrix is too large to be decomposed".to_owned();
        return Err(invalid(place.clone(), code::TRANSFORM_OVERFLOW, reason));
    };
    if sheared.is_none() {
        return Ok(LocalTransform { parts, sheared });
    }
    context.warn(
        place.clone(),
        code::NODE_MATRIX_NON_TRS,
        "the matrix is sheared; it is shown, but cannot be edited",
    );
    Ok(LocalTransform { parts, sheared })
}

pub(super) fn set_last_row(matrix: &mut Mat4) {
    (matrix.x_axis.w, matrix.y_axis.w, matrix.z_axis.w, matrix.w_axis.w) = (0.0, 0.0, 0.0, 1.0);
}

/// Returns `rotation` normalized; the identity if its length is zero.
pub(super) fn unit_rotation(rotation: Quat, place: impl Fn() -> Place, context: &ImportContext<'_>) -> Quat {
    match unit(rotation) {
        Some((unit, error)) => {
            if error > ROTATION_TOLERANCE {
                context.warn(
                    place(),
                    code::ROTATION_NON_UNIT,
                    "the rotation is not of unit length; it was normalized",
                );
            }
            unit
        }
        None => {
            context.warn(
                place(),
                code::ROTATION_NON_UNIT,
                "the rotation has no length; the identity is used instead",
            );
            Quat::IDENTITY
        }
    }
}

/// Returns the transforms from node space to scene space at rest, for all nodes; an error if one overflows.
pub(super) fn globals(
    graph: &Graph,
    locals: &[LocalTransform],
    context: &ImportContext<'_>,
) -> Result<Vec<Mat4>, ImportError> {
    let mut globals = context.filled(&Place::Pointer("/nodes".to_owned()), locals.len(), Mat4::IDENTITY)?;
    for &node in &graph.order {
        context.work(1)?;
        let parent = graph.parents[node as usize].map_or(Mat4::IDENTITY, |parent| globals[parent as usize]);
        let global = parent * locals[node as usize].matrix();
        if !global.is_finite() {
            let place = Place::Pointer(format!("/nodes/{node}"));
            let reason = "the product of the transforms of this node and its ancestors overflows".to_owned();
            return Err(invalid(place, code::TRANSFORM_OVERFLOW, reason));
        }
        globals[node as usize] = global;
    }
    Ok(globals)
}

/// Returns the largest of the three absolute values.
pub(super) fn largest(vector: Vec3) -> f32 {
    vector.abs().max_element()
}
