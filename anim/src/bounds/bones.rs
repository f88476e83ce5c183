//! Bounds of a pose from one box per bone, at a cost proportional to the number of bones.

use super::axis_box::AxisBox;
use super::reach::Reaches;
use super::reach_builder::{ReachBuilder, moving_targets};
use super::{Bounds, Sphere, bounds_of_bones};
use crate::data::{MeshInstance, ModelData, Primitive, Skin};
use crate::evaluator::Evaluator;
use std::collections::HashSet;

/// A box for each joint of each mesh, around the vertices that it moves, before they are moved (thesis §2.1.7.1: a
/// simple bounding volume for placing the model and for hit detection).
///
/// Built once per model; then the box and the sphere of any pose follow from the boxes, moved by the final poses,
/// without reading a vertex: O(bones of all skinned instances), nothing allocated. Both always contain every vertex,
/// whatever its weights and morph targets are; the proof is in the source, `bounds/reach.rs`. They are larger than the
/// exact ones of [`Evaluator::bounds`], because a box also contains the space between its vertices: on the animated
/// characters of the tests, over all takes, the box has on average 1.01 to 1.11 times the exact diagonal and the sphere
/// 1.01 to 1.23 times the exact radius; on one whose bones reach far with small weights 1.32 and 1.47; on cubes that
/// morph targets pull apart 1.4.
///
/// ```
/// use dragonfly_anim::{bounds::BoneBoxes, data::ModelData, evaluator::Evaluator};
/// # let model = std::sync::Arc::new(ModelData::default());
/// let boxes = BoneBoxes::of(&model);
/// let mut evaluator = Evaluator::new(model);
/// evaluator.pose(Some(0), 0.5);
/// let bounds = boxes.bounds(&evaluator);
/// ```
#[derive(Clone, Debug)]
pub struct BoneBoxes {
    reaches: Reaches,
    /// Position of each mesh's first primitive among all primitives.
    first: Vec<u32>,
    /// For each instance, whether an earlier one has its vertices in the same places in every pose.
    repeated: Vec<bool>,
}

impl BoneBoxes {
    /// Builds the boxes of `model`. O(vertices × influences + differences of morph targets).
    pub fn of(model: &ModelData) -> Self {
        let mut builder = ReachBuilder::new();
        let mut first = Vec::with_capacity(model.meshes.len());
        let mut count = 0;
        let uses = uses(model);
        for (mesh, (rigid, skin)) in model.meshes.iter().zip(uses) {
            first.push(count);
            count += mesh.primitives.len() as u32;
            for primitive in &mesh.primitives {
                let targets = moving_targets(primitive);
                // One part for each way the primitive is moved; a part that no instance needs has no vertices.
                let vertices = |used: bool| 0..if used { primitive.vertices.len() } else { 0 };
                let without_influences = primitive.vertices.influences_per_vertex == 0;
                builder.add(primitive, false, None, &targets, vertices(rigid || without_influences));
                builder.add(primitive, true, skin.flatten(), &targets, vertices(skin.is_some()));
            }
        }
        Self { reaches: builder.finish(), first, repeated: repeated(model) }
    }

    /// Returns the box and sphere around every vertex in the pose of `evaluator`, which has to be of the same model;
    /// around the origins of the bones when there is no vertex, as in [`Evaluator::bounds`].
    ///
    /// Another model's pose gives finite but useless bounds. Allocates nothing where there is a vertex.
    pub fn bounds(&self, evaluator: &Evaluator) -> Bounds {
        let whole = self.fold(evaluator, AxisBox::EMPTY, |whole, _, _, bounds| whole.union(bounds));
        if whole.is_empty() {
            return bounds_of_bones(evaluator.to_root());
        }
        let center = whole.center();
        let radius = self.fold(evaluator, 0.0_f64, |radius, part, (instance, primitive), bounds| {
            let Some(movement) = evaluator.movement(instance, primitive) else { return radius };
            let weights = evaluator.morph_weights(instance);
            radius.max(self.reaches.radius(part, movement, weights, center, bounds))
        });
        // Rounded up twice: once for the cast, once for the square root.
        let radius = (radius as f32).next_up().next_up().min(f32::MAX);
        Bounds { min: whole.min, max: whole.max, sphere: Sphere { center, radius } }
    }

    /// Returns a box around primitive number `primitive` of instance number `instance` in the pose of `evaluator`;
    /// empty where it has no vertex or does not exist. Allocates nothing.
    pub fn of_primitive(&self, evaluator: &Evaluator, instance: usize, primitive: usize) -> AxisBox {
        let part = self.part(evaluator, instance, primitive);
        let movement = evaluator.movement(instance, primitive);
        let (Some(part), Some(movement)) = (part, movement) else { return AxisBox::EMPTY };
        self.reaches.fit(part, movement, evaluator.morph_weights(instance))
    }

    /// Folds over all primitives of all instances; `step` gets the part, its instance and primitive, and its box in the
    /// pose.
    fn fold<T>(
        &self,
        evaluator: &Evaluator,
        start: T,
        mut step: impl FnMut(T, usize, (usize, usize), AxisBox) -> T,
    ) -> T {
        let mut state = start;
        for instance in 0..evaluator.model().instances.len() {
            if self.repeated.get(instance).copied().unwrap_or_default() {
                continue;
            }
            for primitive in 0..evaluator.primitives(instance).len() {
                let Some(part) = self.part(evaluator, instance, primitive) else { continue };
                let bounds = self.of_primitive(evaluator, instance, primitive);
                state = step(state, part, (instance, primitive), bounds);
            }
        }
        state
    }

    /// Returns the number of the primitive's part in [`Self::reaches`]: one part is for instances that a skin moves,
    /// the other for instances that one matrix moves.
    fn part(&self, evaluator: &Evaluator, instance: usize, primitive: usize) -> Option<usize> {
        let influences = evaluator.primitives(instance).get(primitive)?.vertices.influences_per_vertex;
        let instance = &evaluator.model().instances[instance];
        let first = *self.first.get(instance.mesh as usize)? as usize;
        let skinned = instance.skin.is_some() && influences > 0;
        let part = 2 * (first + primitive) + usize::from(skinned);
        (part < self.reaches.len()).then_some(part)
    }
}

/// Returns for each mesh whether it is shown without a skin, and, where it is shown with one, the first such skin.
fn uses(model: &ModelData) -> Vec<(bool, Option<Option<&Skin>>)> {
    let mut uses = vec![(false, None); model.meshes.len()];
    for MeshInstance { mesh, skin, .. } in &model.instances {
        let Some((rigid, skinned)) = uses.get_mut(*mesh as usize) else { continue };
        match skin {
            None => *rigid = true,
            Some(skin) => *skinned = skinned.or(Some(model.skins.get(*skin as usize))),
        }
    }
    uses
}

/// Returns for each instance whether an earlier one shows the same mesh by the same skin, without morph targets: a
/// skinned mesh is where its skin is, however often the file places it.
fn repeated(model: &ModelData) -> Vec<bool> {
    let is_skinned: Vec<bool> =
        model.meshes.iter().map(|mesh| mesh.primitives.iter().all(only_skin_moves)).collect();
    let mut known = HashSet::new();
    let repeats = |instance: &MeshInstance| {
        let of_skin = is_skinned.get(instance.mesh as usize).copied().unwrap_or_default();
        of_skin && instance.skin.is_some_and(|skin| !known.insert((instance.mesh, skin)))
    };
    model.instances.iter().map(repeats).collect()
}

/// Returns whether nothing but a skin moves the vertices of an instance of `primitive` that has a skin.
fn only_skin_moves(primitive: &Primitive) -> bool {
    primitive.vertices.influences_per_vertex > 0 && primitive.morph_targets.is_empty()
}
