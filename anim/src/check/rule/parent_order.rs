//! Parents that do not come before their children; the order lets one forward pass visit parents first, and excludes
//! cycles.

use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        if let Some(parent) = bone.parent.filter(|&parent| parent as usize >= number) {
            let text = || format!("its parent {parent} does not come before it");
            findings.add(|| (ModelPath::of(PathKind::Bone, number, &bone.name), text()));
        }
    }
}
