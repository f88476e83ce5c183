//! Blend shapes become morph targets; a channel with in-between shapes becomes several targets.

use super::skin::place_of;
use super::space::FbxSpace;
use dragonfly_anim::data::MorphTarget;
use dragonfly_anim::format::{ImportContext, ImportError};
use glam::Vec3;
use ufbx::{BlendChannel, Mesh};

/// Largest weight of a shape.
const LARGEST: f64 = 1e6;

/// A shape of a mesh.
pub(super) struct MorphShape {
    /// Positions of the deformer, of its channel and of the shape in it.
    at: [usize; 3],
    /// Name of the target.
    name: String,
    /// Weight where nothing animates it.
    pub(super) weight: f32,
}

impl MorphShape {
    /// Returns the channel of the shape, and its position in it.
    pub(super) fn channel<'a>(&self, mesh: &'a Mesh) -> Option<(&'a BlendChannel, usize)> {
        let [deformer, channel, shape] = self.at;
        let channel = mesh.blend_deformers.get(deformer)?.channels.get(channel)?;
        Some((channel, shape))
    }
}

/// Returns the shapes of a mesh in the order of its deformers and channels.
pub(super) fn morph_shapes(mesh: &Mesh, context: &ImportContext<'_>) -> Result<Vec<MorphShape>, ImportError> {
    let mut shapes = Vec::new();
    for (deformer, blend) in mesh.blend_deformers.into_iter().enumerate() {
        for (number, channel) in blend.channels.into_iter().enumerate() {
            let weights = effective_weights(channel, channel.weight);
            for (shape, keyframe) in channel.keyframes.iter().enumerate() {
                context.work(1)?;
                let own = &*keyframe.shape.element.name;
                let name = match &*channel.element.name {
                    "" => own.to_owned(),
                    name if channel.keyframes.len() > 1 => format!("{name} {own}"),
                    name => name.to_owned(),
                };
                context.charge(&place_of(mesh), (size_of::<MorphShape>() + 3 * name.len()) as u64)?;
                shapes.push(MorphShape {
                    at: [deformer, number, shape],
                    name,
                    weight: weights[shape] as f32,
                });
            }
        }
    }
    Ok(shapes)
}

/// Returns the weight of each shape of a channel whose own weight is `weight`: between two shapes that neighbor it, both have
/// a part. The same rule as in the parser, which applies it to whole scenes only.
pub(super) fn effective_weights(channel: &BlendChannel, weight: f64) -> Vec<f64> {
    let targets: Vec<f64> = channel.keyframes.iter().map(|keyframe| keyframe.target_weight).collect();
    let mut weights = vec![0.0; targets.len()];
    if !weight.is_finite() {
        return weights;
    }
    // The shapes on the side of zero on which the weight is, outward.
    let negative = targets.iter().rposition(|&target| target < 0.0).map_or(0, |last| last + 1);
    let outward: Vec<usize> = match weight > 0.0 {
        true => (negative..targets.len()).collect(),
        false => (0..negative).rev().collect(),
    };
    let mut pair = (None, None);
    for shape in outward {
        pair = (pair.1, Some(shape));
        if targets[shape].abs() > weight.abs() {
            break;
        }
    }
    let (before, Some(next)) = pair else { return weights };
    let start = before.map_or(0.0, |before: usize| targets[before]);
    let distance = targets[next] - start;
    if distance != 0.0 {
        let part = (weight - start) / distance;
        let bounded = |weight: f64| if weight.is_finite() { weight.clamp(-LARGEST, LARGEST) } else { 0.0 };
        if let Some(before) = before {
            weights[before] = bounded(1.0 - part);
        }
        weights[next] = bounded(part);
    }
    weights
}

/// Returns the morph targets of a primitive; `sources` are the vertices of the file for each of its vertices.
pub(super) fn morph_targets(
    mesh: &Mesh,
    shapes: &[MorphShape],
    sources: &[u32],
    space: &FbxSpace,
    context: &ImportContext<'_>,
) -> Result<Vec<MorphTarget>, ImportError> {
    let place = place_of(mesh);
    let mut targets = context.vec(&place, shapes.len())?;
    for read in shapes {
        let mut target = MorphTarget { name: read.name.clone(), ..MorphTarget::default() };
        if let Some((channel, shape)) = read.channel(mesh) {
            let shape = &channel.keyframes[shape].shape;
            context.work(shape.offset_vertices.len() + mesh.num_vertices)?;
            // Position of the difference of each vertex, counted from one.
            let mut found = context.filled(&place, mesh.num_vertices, 0_u32)?;
            for (number, &vertex) in shape.offset_vertices.iter().enumerate() {
                if let Some(found) = found.get_mut(vertex as usize) {
                    *found = number as u32 + 1;
                }
            }
            let weight = |at: usize| shape.offset_weights.get(at).copied().unwrap_or(1.0) as f32;
            let column = |values: &[ufbx::Vec3], convert: &dyn Fn(ufbx::Vec3) -> Vec3| {
                let at = |source: u32| found.get(source as usize)?.checked_sub(1).map(|at| at as usize);
                let values = sources.iter().map(|&source| {
                    at(source)
                        .and_then(|at| Some(convert(*values.get(at)?) * weight(at)))
                        .unwrap_or(Vec3::ZERO)
                });
                let mut column: Vec<Vec3> = context.vec(&place, sources.len())?;
                column.extend(values.map(|value| if value.is_finite() { value } else { Vec3::ZERO }));
                // A column of zeros is left out.
                if column.iter().all(|value| *value == Vec3::ZERO) {
                    column = Vec::new();
                }
                Ok::<_, ImportError>(column)
            };
            target.positions = column(&shape.position_offsets, &|offset| space.position(offset))?;
            target.normals = column(&shape.normal_offsets, &|offset| space.direction(offset))?;
        }
        targets.push(target);
    }
    Ok(targets)
}
