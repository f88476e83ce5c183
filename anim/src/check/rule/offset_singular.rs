//! Singular offsets: they flatten what they move, so bone space cannot be mapped to bind space again.

use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;
use glam::{Mat3, Mat4};

/// Volume of a unit cube after the offset, relative to the product of its sides.
const SMALLEST: f32 = 1e-6;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, skin) in model.skins.iter().enumerate() {
        for (joint, offset) in skin.offsets.iter().enumerate().filter(|(_, offset)| is_singular(offset)) {
            let name =
                skin.bones.get(joint).and_then(|&bone| model.animation.skeleton.bones.get(bone as usize));
            let name = name.map_or("", |bone| bone.name.as_str());
            let path =
                || ModelPath::of(PathKind::Skin, number, &skin.name).then(PathKind::Joint, joint, name);
            findings.add(|| (path(), format!("determinant {}", Mat3::from_mat4(*offset).determinant())));
        }
    }
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        if is_singular(&bone.offset) {
            let determinant = Mat3::from_mat4(bone.offset).determinant();
            let path = || ModelPath::of(PathKind::Bone, number, &bone.name);
            findings.add(|| (path(), format!("determinant {determinant}")));
        }
    }
}

/// Normalizes each side first, so that small models do not count as flat.
fn is_singular(offset: &Mat4) -> bool {
    let sides = Mat3::from_mat4(*offset);
    let unit = |side: glam::Vec3| side.normalize_or_zero();
    let volume = Mat3::from_cols(unit(sides.x_axis), unit(sides.y_axis), unit(sides.z_axis)).determinant();
    offset.is_finite() && volume.abs() < SMALLEST
}
