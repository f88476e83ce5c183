//! Rest rotations that are not of unit length, and would scale.

use crate::check::measure::UNIT_TOLERANCE;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        let length = bone.rest.rotation.length();
        if length.is_finite() && (length - 1.0).abs() > UNIT_TOLERANCE {
            let text = || format!("the rest rotation has length {length}");
            findings.add(|| (ModelPath::of(PathKind::Bone, number, &bone.name), text()));
        }
    }
}
