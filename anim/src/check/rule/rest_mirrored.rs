//! Bones whose rest pose is mirrored: an odd number of scale factors is negative.

use crate::check::measure::is_mirrored;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        if is_mirrored(bone.rest.scale) {
            let text = || format!("the rest scale is {}", bone.rest.scale);
            findings.add(|| (ModelPath::of(PathKind::Bone, number, &bone.name), text()));
        }
    }
}
