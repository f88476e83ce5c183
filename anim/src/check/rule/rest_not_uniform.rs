//! Non-uniform rest scales, which shear children that turn.

use crate::check::measure::is_flat;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

/// Allowed difference of the factors, as a fraction of the largest.
const TOLERANCE: f32 = 1e-3;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        let scale = bone.rest.scale.abs();
        let (least, most) = (scale.min_element(), scale.max_element());
        // Flat scales have a rule of their own.
        if scale.is_finite() && !is_flat(scale) && most - least > TOLERANCE * most {
            let text = || format!("the rest scale is {}", bone.rest.scale);
            findings.add(|| (ModelPath::of(PathKind::Bone, number, &bone.name), text()));
        }
    }
}
