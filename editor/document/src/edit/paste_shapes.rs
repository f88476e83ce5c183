//! Pastes copied keys of shape keys.

use super::{CopiedShapes, PasteKeys, TakeRef};
use crate::adapter::plan::morph_given::{GivenWeight, WeightRules, give_weights};
use crate::adapter::plan::{Transaction, finite, key_time};
use crate::adapter::{EditError, TakeId};
use std::collections::BTreeMap;

/// Pastes the keys of shape keys of an edit. Returns whether the model has any of the shape keys, and the number of keys.
pub(super) fn paste_shapes(
    work: &mut Transaction,
    take: TakeId,
    edit: &PasteKeys,
) -> Result<(bool, usize), EditError> {
    if edit.shapes.is_empty() {
        return Ok((false, 0));
    }
    if matches!(edit.take, TakeRef::Layer { .. }) {
        return Err(EditError::OnLayer("Paste shape keys"));
    }
    let (mut found, mut keys) = (false, 0);
    let mut meshes: BTreeMap<u32, (WeightRules, Vec<GivenWeight>)> = BTreeMap::new();
    for copied in &edit.shapes {
        let targets = targets(work, copied);
        found |= targets.iter().any(Option::is_some);
        for key in &copied.keys {
            let time = finite("a time", key.after as f32).and(Ok(f64::from(edit.time) + key.after))?;
            let time = key_time(time as f32, work.slot(take))?;
            let mut any = false;
            for (column, target) in targets.iter().enumerate() {
                let (&Some((instance, target)), Some(&weight)) = (target, key.weights.get(column)) else {
                    continue;
                };
                let tangent = |given: &Option<Vec<f32>>| {
                    let number = given.as_ref().and_then(|given| given.get(column)).copied();
                    number.map(|number| finite("a tangent", number)).transpose()
                };
                let given = GivenWeight {
                    time,
                    target,
                    weight: Some(finite("a weight", weight)?),
                    arrive: tangent(&key.arrive)?,
                    leave: tangent(&key.leave)?,
                };
                let rules = WeightRules { interpolation: copied.interpolation.into(), smooth: true };
                meshes.entry(instance).or_insert_with(|| (rules, Vec::new())).1.push(given);
                any = true;
            }
            keys += usize::from(any);
        }
    }
    if !meshes.is_empty() {
        give_weights(work, take, meshes)?;
    }
    Ok((found, keys))
}

/// Returns the mesh and the index of each copied shape key; `None` where the model does not have it.
fn targets(work: &Transaction, copied: &CopiedShapes) -> Vec<Option<(u32, usize)>> {
    let shapes = work.adapter().shapes();
    let find = |shape| {
        let found = shapes.find(Some(&copied.mesh), shape).or_else(|| match shape {
            super::ShapeRef::Name(_) => shapes.find(None, shape),
            super::ShapeRef::Index(_) => None,
        });
        found.map(|(mesh, shape)| (mesh.instance(), shape))
    };
    copied.shapes.iter().map(find).collect()
}
