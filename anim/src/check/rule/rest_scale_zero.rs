//! Bones whose rest pose is flat.

use super::is_flat;
use crate::check::{Findings, Kind, Place};
use crate::data::ModelData;

pub(crate) fn look(model: &ModelData, findings: &mut Findings) {
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        if is_flat(bone.rest.scale) {
            let text = || format!("the rest scale is {}", bone.rest.scale);
            findings.add(|| (Place::of(Kind::Bone, number, &bone.name), text()));
        }
    }
}
