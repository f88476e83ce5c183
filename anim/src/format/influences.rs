//! Influences of a vertex in the form that all models have: each joint once, the strongest first, adding up to one.

use crate::data::Influence;

/// Adds up the weights of influences of the same joint, and sorts, the strongest first. Returns whether there were any of the
/// same joint.
pub(super) fn merge(found: &mut Vec<Influence>) -> bool {
    let mut is_twice = false;
    // Sorted instead of searched, because a file may have any number of influences.
    found.sort_by_key(|influence| influence.joint);
    found.dedup_by(|next, kept| {
        let is_same = next.joint == kept.joint;
        if is_same {
            kept.weight = (kept.weight + next.weight).min(f32::MAX);
            is_twice = true;
        }
        is_same
    });
    found.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    is_twice
}

/// Scales positive weights so that they add up to one. Returns whether there are any.
pub(super) fn normalize(found: &mut [Influence]) -> bool {
    let sum: f64 = found.iter().map(|influence| f64::from(influence.weight)).sum();
    if sum != 1.0 {
        for influence in found.iter_mut() {
            influence.weight = (f64::from(influence.weight) / sum) as f32;
        }
    }
    !found.is_empty()
}
