//! The shape keys (morph targets) of a model: where their weights are in one list, and the bones that they belong to.

use crate::data::{BoneIndex, MeshInstance, ModelData, Primitive, Skin, Take};
use crate::sample::sample_morph_weights;
use std::collections::HashMap;
use std::ops::Range;

/// The bones of the shape keys of a mesh with a skin.
type BonesOfMesh = Vec<Option<BoneIndex>>;

/// The shape keys of a model. The weights of all mesh instances are in one list, in the order of the instances; their number is, for each of them, the
/// largest number of targets of a primitive of its mesh.
#[derive(Clone, Debug, Default)]
pub struct StageShapes {
    /// For each instance with shape keys: its position, and the place of its weights.
    meshes: Vec<(u32, Range<usize>)>,
    /// The weights where nothing animates them.
    rest: Vec<f32>,
    bones: Vec<Option<BoneIndex>>,
}

impl StageShapes {
    /// Collects the shape keys of `model`. Takes time in proportion to the vertices that they move.
    pub(super) fn new(model: &ModelData) -> Self {
        let mut shapes = Self::default();
        let mut of_skins: HashMap<(u32, u32), BonesOfMesh> = HashMap::new();
        for (number, instance) in (0..).zip(&model.instances) {
            let primitives =
                model.meshes.get(instance.mesh as usize).map_or(&[][..], |mesh| &mesh.primitives);
            let count = primitives.iter().map(|primitive| primitive.morph_targets.len()).max().unwrap_or(0);
            if count == 0 {
                continue;
            }
            let start = shapes.rest.len();
            shapes.meshes.push((number, start..start + count));
            let given = |target: usize| instance.morph_weights.get(target).copied().unwrap_or(0.0);
            shapes.rest.extend(
                (0..count).map(|target| Some(given(target)).filter(|it| it.is_finite()).unwrap_or(0.0)),
            );
            match instance.skin.and_then(|skin| Some((skin, model.skins.get(skin as usize)?))) {
                Some((index, skin)) => {
                    let bones = of_skins.entry((instance.mesh, index)).or_insert_with(|| {
                        (0..count).map(|target| bone_of(primitives, skin, target)).collect()
                    });
                    shapes.bones.extend_from_slice(bones);
                }
                None => shapes.bones.extend(std::iter::repeat_n(carrier(instance), count)),
            }
        }
        shapes
    }

    /// Returns the number of weights of all mesh instances.
    pub fn len(&self) -> usize {
        self.rest.len()
    }

    /// Returns whether the model has no shape keys.
    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// Returns the weights where nothing animates them: those of the instances, 0 where they have none.
    pub fn rest(&self) -> &[f32] {
        &self.rest
    }

    /// Returns the place of the weights of the mesh instance number `instance` in the list of all; an empty range where it has none.
    pub fn range_of(&self, instance: u32) -> Range<usize> {
        let found = self.meshes.binary_search_by_key(&instance, |(number, _)| *number);
        found.ok().and_then(|at| self.meshes.get(at)).map_or(0..0, |(_, range)| range.clone())
    }

    /// Returns the bone that each shape key belongs to: the one that carries its mesh, or of a skinned mesh the joint that moves most of what the shape
    /// key moves; `None` where no bone does.
    pub fn bones(&self) -> &[Option<BoneIndex>] {
        &self.bones
    }

    /// Writes the weights at `time` of a take as its keys count it. Those that it does not animate are at rest.
    pub(in crate::stage) fn sample(&self, take: Option<&Take>, time: f32, out: &mut [f32]) {
        for (instance, range) in &self.meshes {
            if let (Some(rest), Some(out)) = (self.rest.get(range.clone()), out.get_mut(range.clone())) {
                sample_morph_weights(take, *instance, rest, time, out);
            }
        }
    }
}

fn carrier(instance: &MeshInstance) -> Option<BoneIndex> {
    // A skinned mesh whose skin is missing ignores its bone.
    instance.bone.filter(|_| instance.skin.is_none())
}

/// Returns the joint that moves most of what a target moves: with the largest sum of the lengths of the differences of its vertices, times its weights
/// there; the first of equals.
fn bone_of(primitives: &[Primitive], skin: &Skin, target: usize) -> Option<BoneIndex> {
    let mut sums = vec![0.0_f64; skin.bones.len()];
    for primitive in primitives {
        let Some(target) = primitive.morph_targets.get(target) else { continue };
        for (vertex, difference) in target.positions.iter().enumerate() {
            let length = f64::from(difference.length());
            // False for NaN.
            if length > 0.0 {
                for influence in primitive.vertices.influences_of(vertex) {
                    if let Some(sum) = sums.get_mut(influence.joint as usize) {
                        *sum += length * f64::from(influence.weight);
                    }
                }
            }
        }
    }
    let mut most = (0.0, None);
    for (&sum, &bone) in sums.iter().zip(&skin.bones) {
        if sum > most.0 {
            most = (sum, Some(bone));
        }
    }
    most.1
}
