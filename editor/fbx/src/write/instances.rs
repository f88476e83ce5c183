//! Placed meshes: their nodes, geometries, skins and shapes.

use super::bones::{LocalPose, add_node};
use super::losses::FbxLosses;
use super::materials::add_default_material;
use super::mesh::GeometrySource;
use super::names::UsedNames;
use super::node::{FbxNode, setting};
use super::scene::{ObjectId, SCENE, SceneWriter};
use super::skin::{BoundSkin, SkinSource, add_bind_pose};
use super::space::FileSpace;
use dragonfly_anim::data::{Mesh, MeshInstance, ModelData, MorphTrack, Primitive};
use glam::DMat4;

/// Objects that meshes refer to.
pub(super) struct InstanceSource<'a> {
    pub(super) model: &'a ModelData,
    pub(super) space: &'a FileSpace,
    /// Node of each bone, and its matrix in the scene at rest.
    pub(super) bones: &'a [ObjectId],
    pub(super) rest: &'a [DMat4],
    pub(super) materials: &'a [ObjectId],
    /// Where each skin is bound.
    pub(super) bound: &'a [BoundSkin],
}

/// A geometry that was written, and the instance for which it was.
struct WrittenGeometry {
    instance: usize,
    moved: DMat4,
    geometry: ObjectId,
    /// Channels of its shapes.
    shapes: Vec<ObjectId>,
}

/// Node of a mesh, and the matrix by which its vertices are moved because no node can have it.
struct PlacedMesh {
    pose: LocalPose,
    moved: DMat4,
    parent: ObjectId,
}

impl InstanceSource<'_> {
    /// Adds all instances. Returns the channels of the shapes of each.
    pub(super) fn add(&self, scene: &mut SceneWriter, losses: &mut FbxLosses) -> Vec<Vec<ObjectId>> {
        let mut written: Vec<WrittenGeometry> = Vec::new();
        let mut shapes = Vec::with_capacity(self.model.instances.len());
        let mut bound_nodes = Vec::new();
        let mut default_material = None;
        for (index, instance) in self.model.instances.iter().enumerate() {
            let Some(mesh) = self.model.meshes.get(instance.mesh as usize) else {
                shapes.push(Vec::new());
                continue;
            };
            list_losses(mesh, index, losses);
            let placed = self.place(instance);
            let known = written
                .iter()
                .position(|known| known.moved == placed.moved && self.is_same(known.instance, index));
            let materials = self.materials_of(mesh, scene, &mut default_material);
            let known = known.unwrap_or_else(|| {
                let geometry = self.add_geometry(scene, index, mesh, placed.moved, &materials, losses);
                written.push(geometry);
                written.len() - 1
            });
            let name = if mesh.name.is_empty() { "Mesh" } else { &mesh.name };
            let node = add_node(scene, self.space, name, "Mesh", &placed.pose);
            scene.connect(node, placed.parent);
            scene.connect(written[known].geometry, node);
            for &(_, material) in &materials {
                scene.connect(material, node);
            }
            if let Some((skin, bound)) = self.skin(instance) {
                bound_nodes.push((node, skin, bound));
            }
            shapes.push(written[known].shapes.clone());
        }
        add_bind_pose(scene, self.space, self.model, (self.bones, self.rest), &bound_nodes);
        shapes
    }

    fn skin(&self, instance: &MeshInstance) -> Option<(&dragonfly_anim::data::Skin, &BoundSkin)> {
        let skin = instance.skin? as usize;
        Some((self.model.skins.get(skin)?, self.bound.get(skin)?))
    }

    fn place(&self, instance: &MeshInstance) -> PlacedMesh {
        if let Some((_, bound)) = self.skin(instance) {
            return PlacedMesh { pose: bound.node, moved: DMat4::IDENTITY, parent: SCENE };
        }
        let parent = instance.bone.and_then(|bone| self.bones.get(bone as usize).copied()).unwrap_or(SCENE);
        let matrix = instance.to_bone.as_dmat4();
        match LocalPose::of_matrix(matrix) {
            Some(pose) => PlacedMesh { pose, moved: DMat4::IDENTITY, parent },
            None => {
                let pose = LocalPose::of(&dragonfly_anim::data::Transform::IDENTITY);
                PlacedMesh { pose, moved: matrix, parent }
            }
        }
    }

    /// Returns whether two instances can share a geometry: skins and weights of shapes belong to it.
    fn is_same(&self, one: usize, other: usize) -> bool {
        let (a, b) = (&self.model.instances[one], &self.model.instances[other]);
        let weights = |take: &dragonfly_anim::data::Take, instance: usize| -> Option<MorphTrack> {
            let found = take.morphs.iter().find(|morph| morph.instance as usize == instance)?;
            Some(MorphTrack { instance: 0, ..found.clone() })
        };
        let mut takes = self.model.animation.takes.iter();
        a.mesh == b.mesh
            && a.skin == b.skin
            && a.morph_weights == b.morph_weights
            && takes.all(|take| take.morphs.is_empty() || weights(take, one) == weights(take, other))
    }

    /// Returns the materials of a mesh in the order of their first use, with their number in the model.
    fn materials_of(
        &self,
        mesh: &Mesh,
        scene: &mut SceneWriter,
        default: &mut Option<ObjectId>,
    ) -> Vec<(Option<u32>, ObjectId)> {
        let known =
            |primitive: &Primitive| primitive.material.filter(|&at| (at as usize) < self.materials.len());
        let mut materials: Vec<(Option<u32>, ObjectId)> = Vec::new();
        if mesh.primitives.iter().all(|primitive| known(primitive).is_none()) {
            return materials;
        }
        for primitive in &mesh.primitives {
            let material = known(primitive);
            if materials.iter().all(|(number, _)| *number != material) {
                let object = match material {
                    Some(number) => self.materials[number as usize],
                    None => *default.get_or_insert_with(|| add_default_material(scene)),
                };
                materials.push((material, object));
            }
        }
        materials
    }

    fn add_geometry(
        &self,
        scene: &mut SceneWriter,
        index: usize,
        mesh: &Mesh,
        moved: DMat4,
        materials: &[(Option<u32>, ObjectId)],
        losses: &mut FbxLosses,
    ) -> WrittenGeometry {
        let instance = &self.model.instances[index];
        let source = GeometrySource { mesh, moved, space: self.space };
        let geometry = source.add(scene, |primitive| {
            let known = primitive.material.filter(|&at| (at as usize) < self.materials.len());
            materials.iter().position(|(number, _)| *number == known).map(|at| at as i32)
        });
        if let Some((skin, bound)) = self.skin(instance) {
            let skin = SkinSource { skin, mesh, bound, space: self.space, bones: self.bones };
            skin.add(scene, geometry, &format!("/instances/{index}"), losses);
        }
        let shapes = add_shapes(scene, &source, instance, geometry, losses);
        WrittenGeometry { instance: index, moved, geometry, shapes }
    }
}

/// Adds the morph targets of a geometry. Returns their channels.
fn add_shapes(
    scene: &mut SceneWriter,
    source: &GeometrySource<'_>,
    instance: &MeshInstance,
    geometry: ObjectId,
    losses: &mut FbxLosses,
) -> Vec<ObjectId> {
    let mesh = source.mesh;
    let count = mesh.primitives.iter().map(|primitive| primitive.morph_targets.len()).max().unwrap_or(0);
    if count == 0 {
        return Vec::new();
    }
    let deformer =
        scene.object("Deformer", &mesh.name, ("Deformer", "BlendShape"), [FbxNode::new("Version").with(100)]);
    scene.connect(deformer, geometry);
    let mut names = UsedNames::default();
    let mut channels = Vec::with_capacity(count);
    for target in 0..count {
        let own = mesh.primitives.iter().filter_map(|primitive| primitive.morph_targets.get(target));
        let own = own.map(|target| target.name.as_str()).find(|name| !name.is_empty()).unwrap_or("");
        let stem = if own.is_empty() { format!("shape {target}") } else { own.to_owned() };
        let name = names.unique(&stem, "");
        if name != own {
            let place = format!("/meshes/{}/morph_targets/{target}/name", instance.mesh);
            losses.add(place, format!("the morph target \"{own}\" is called \"{name}\""));
        }
        let weight = instance.morph_weights.get(target).or(mesh.morph_weights.get(target));
        let percent = 100.0 * f64::from(weight.copied().unwrap_or(0.0));
        if percent < 0.0 {
            let place = format!("/meshes/{}/morph_weights", instance.mesh);
            losses.add(place, "weights below zero are stored, but most programs show none");
        }
        let children = [
            FbxNode::new("Version").with(100),
            FbxNode::new("DeformPercent").with(percent),
            FbxNode::new("FullWeights").with(vec![100.0]),
            FbxNode::new("Properties70")
                .containing([setting("DeformPercent", "Number", "", "A").with(percent)]),
        ];
        let channel = scene.object("Deformer", &name, ("SubDeformer", "BlendShapeChannel"), children);
        scene.connect(channel, deformer);
        let shape = source.add_shape(scene, target, &name);
        scene.connect(shape, channel);
        channels.push(channel);
    }
    channels
}

/// Lists what the geometry of an instance does not contain.
fn list_losses(mesh: &Mesh, index: usize, losses: &mut FbxLosses) {
    let place = format!("/instances/{index}");
    let mut primitives = mesh.primitives.iter();
    if primitives.any(|primitive| !primitive.vertices.tangents.is_empty()) {
        losses.add(place.clone(), "tangents of vertices are not stored; programs compute them");
    }
    let targets = mesh.primitives.iter().flat_map(|primitive| &primitive.morph_targets);
    if targets.into_iter().any(|target| !target.tangents.is_empty()) {
        losses.add(place, "tangents of morph targets are not stored; programs compute them");
    }
}
