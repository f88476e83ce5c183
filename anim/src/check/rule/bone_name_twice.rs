//! Duplicate bone names: takes bound by name move only the first such bone.

use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;
use std::collections::HashMap;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    let mut first = HashMap::new();
    let bones = &model.animation.skeleton.bones;
    for (number, bone) in bones.iter().enumerate().filter(|(_, bone)| !bone.name.is_empty()) {
        let earlier = *first.entry(bone.name.as_str()).or_insert(number);
        if earlier != number {
            let text = format!("bone {earlier} has the same name");
            findings.add(|| (ModelPath::of(PathKind::Bone, number, &bone.name), text));
        }
    }
}
