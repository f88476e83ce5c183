//! Weights of vertices: four numbers, of which the programs of the books use three.

use super::check as code;
use super::geometry::M3dVertices;
use crate::data::Influence;
use crate::format::influences::{merge, normalize};
use crate::format::{ImportContext, ImportError, Place};

/// Deviation of the sum of weights from one that is due to rounding.
const ROUNDING: f32 = 1e-5;

/// Returns four influences for each vertex. Where the weights do not add up to one, the fourth bone gets the rest, as in the
/// programs of the books.
pub(super) fn influences(
    vertices: &M3dVertices,
    context: &ImportContext<'_>,
) -> Result<Vec<Influence>, ImportError> {
    let mut list = context.filled(&Place::File, vertices.weights.len() * 4, Influence::default())?;
    context.work(list.len())?;
    let mut odd = 0;
    let mut found = Vec::with_capacity(4);
    for ((weights, bones), slots) in
        vertices.weights.iter().zip(&vertices.bones).zip(list.chunks_exact_mut(4))
    {
        let mut weights = *weights;
        let is_odd = !((weights.iter().sum::<f32>() - 1.0).abs() <= ROUNDING);
        odd += usize::from(is_odd);
        if is_odd {
            weights[3] = 1.0 - weights[0] - weights[1] - weights[2];
        }
        let influences = weights.into_iter().zip(bones).map(|(weight, &joint)| Influence { joint, weight });
        found.clear();
        found.extend(influences.filter(|influence| influence.weight > 0.0 && influence.weight.is_finite()));
        merge(&mut found);
        if !normalize(&mut found) {
            found.push(Influence { joint: bones[0], weight: 1.0 });
        }
        for (slot, &influence) in slots.iter_mut().zip(&found) {
            *slot = influence;
        }
    }
    if odd > 0 {
        let text =
            format!("{odd} vertices have weights that do not add up to one; their fourth bone gets the rest");
        context.warn(Place::File, code::WEIGHTS_INVALID, text);
    }
    Ok(list)
}
