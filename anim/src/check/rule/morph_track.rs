//! Morph tracks that do not fit the instance whose weights they set.

use crate::check::{Findings, PathKind, TakeContext};
use crate::data::Interpolation;

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, morph) in of.take.morphs.iter().enumerate() {
        let path = || of.path().then(PathKind::MorphTrack, number, "");
        let per_key = if morph.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let (keys, weights) = (morph.times.len(), morph.weights.len());
        let needed = keys.checked_mul(morph.targets as usize).and_then(|needed| needed.checked_mul(per_key));
        if needed != Some(weights) {
            findings
                .add(|| (path(), format!("{weights} weights for {keys} keys of {} targets", morph.targets)));
        }
        let Some(model) = of.model else { continue };
        match model.instances.get(morph.instance as usize) {
            None => findings.add(|| (path(), format!("instance {} does not exist", morph.instance))),
            Some(instance) if instance.morph_weights.len() != morph.targets as usize => {
                let has = instance.morph_weights.len();
                findings.add(|| {
                    (path(), format!("{} targets; instance {} has {has}", morph.targets, morph.instance))
                });
            }
            Some(_) => {}
        }
    }
}
