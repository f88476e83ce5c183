//! Nodes, skins and the scene of a written file.

use super::bytes::{AccessorShape, Components};
use super::{GltfWriter, named, numbers};
use crate::data::{Bone, MeshInstance, Transform};
use glam::{Mat4, Quat, Vec3};
use serde_json::{Map, Value, json};

/// The nodes of a written file, and the scene that shows them.
pub(super) struct WrittenScene {
    pub(super) nodes: Vec<Value>,
    pub(super) scene: Value,
    /// Node of each instance; `None` for one without a mesh in the file.
    pub(super) instance_nodes: Vec<Option<usize>>,
}

impl GltfWriter<'_> {
    /// Places bones and instances. `meshes` contains the number of each mesh in the file.
    pub(super) fn scene(&mut self, meshes: &[Option<usize>]) -> WrittenScene {
        let model = self.model;
        let bones = &model.animation.skeleton.bones;
        let mut nodes: Vec<Map<String, Value>> =
            (0..bones.len()).map(|bone| self.bone_node(bone, &bones[bone])).collect();
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); bones.len()];
        let mut roots = Vec::new();
        for (index, bone) in bones.iter().enumerate() {
            match bone.parent {
                Some(parent) => children[parent as usize].push(index),
                None => roots.push(index),
            }
        }
        let is_one_tree = roots.len() < 2 || model.skins.is_empty();
        let mut instance_nodes = Vec::with_capacity(model.instances.len());
        for (index, instance) in model.instances.iter().enumerate() {
            let Some(mesh) = meshes.get(instance.mesh as usize).copied().flatten() else {
                instance_nodes.push(None);
                continue;
            };
            let carrier = instance.bone.map(|bone| bone as usize);
            let own = carrier.filter(|&bone| self.is_in_bone(index, instance, nodes.get(bone)));
            let at = own.unwrap_or_else(|| {
                let mut node = Map::new();
                named(&mut node, &model.meshes[instance.mesh as usize].name);
                // A skinned mesh is placed by its joints alone.
                if instance.skin.is_none() {
                    matrix(&mut node, instance.to_bone);
                }
                nodes.push(node);
                let at = nodes.len() - 1;
                match carrier.filter(|_| instance.skin.is_none()) {
                    Some(bone) => children[bone].push(at),
                    None => roots.push(at),
                }
                at
            });
            self.place(&mut nodes[at], instance, mesh);
            instance_nodes.push(Some(at));
        }
        for (node, children) in nodes.iter_mut().zip(children) {
            if !children.is_empty() {
                node.insert("children".to_owned(), children.into());
            }
        }
        if !is_one_tree {
            // glTF requires a common root of the joints of a skin.
            let (bones_of_root, others): (Vec<usize>, Vec<usize>) =
                roots.iter().partition(|&&root| root < bones.len());
            nodes.push(
                [("name".to_owned(), json!("Skeleton")), ("children".to_owned(), bones_of_root.into())]
                    .into_iter()
                    .collect(),
            );
            roots = others;
            roots.push(nodes.len() - 1);
        }
        let mut scene = Map::new();
        named(&mut scene, &model.name);
        if !roots.is_empty() {
            scene.insert("nodes".to_owned(), roots.into());
        }
        let nodes = nodes.into_iter().map(Value::Object).collect();
        WrittenScene { nodes, scene: Value::Object(scene), instance_nodes }
    }

    /// Returns whether an instance can be in the node of its bone.
    fn is_in_bone(&self, index: usize, instance: &MeshInstance, node: Option<&Map<String, Value>>) -> bool {
        let is_free = node.is_some_and(|node| !node.contains_key("mesh"));
        let morphs = self.model.animation.takes.iter().flat_map(|take| &take.morphs);
        let is_morphed = || morphs.into_iter().any(|track| track.instance as usize == index);
        // A skinned mesh below other nodes works, but the validator warns of it.
        is_free && instance.to_bone == Mat4::IDENTITY && (instance.skin.is_none() || is_morphed())
    }

    fn bone_node(&mut self, index: usize, bone: &Bone) -> Map<String, Value> {
        let mut node = Map::new();
        named(&mut node, &bone.name);
        let takes = &self.model.animation.takes;
        let is_animated = || {
            let mut tracks = takes.iter().flat_map(|take| &take.tracks);
            tracks.any(|track| track.bone as usize == index && !track.is_empty())
        };
        match bone.rest_matrix {
            Some(sheared) if !is_animated() => matrix(&mut node, sheared),
            Some(_) => {
                let text = "the sheared rest matrix of an animated bone becomes translation, rotation, scale";
                self.lose(format!("/animation/skeleton/bones/{index}/rest_matrix"), text);
                transform(&mut node, bone.rest);
            }
            None => transform(&mut node, bone.rest),
        }
        node
    }

    fn place(&self, node: &mut Map<String, Value>, instance: &MeshInstance, mesh: usize) {
        node.insert("mesh".to_owned(), json!(mesh));
        if let Some(skin) = instance.skin {
            node.insert("skin".to_owned(), json!(skin));
        }
        let defaults = &self.model.meshes[instance.mesh as usize].morph_weights;
        if instance.morph_weights != *defaults {
            node.insert("weights".to_owned(), numbers(instance.morph_weights.iter().copied()));
        }
    }

    /// Writes the joints and offsets of all skins.
    pub(super) fn skins(&mut self) -> Vec<Value> {
        let model = self.model;
        let mut skins = Vec::with_capacity(model.skins.len());
        for skin in &model.skins {
            let offsets: Vec<f32> = skin.offsets.iter().flat_map(|offset| offset.to_cols_array()).collect();
            let mut written = Map::new();
            named(&mut written, &skin.name);
            written.insert("joints".to_owned(), skin.bones.clone().into());
            if !offsets.is_empty() {
                let offsets = self.binary.accessor(Components::Floats(&offsets), &AccessorShape::MAT4);
                written.insert("inverseBindMatrices".to_owned(), json!(offsets));
            }
            skins.push(Value::Object(written));
        }
        skins
    }
}

/// Adds what differs from the identity.
fn transform(node: &mut Map<String, Value>, transform: Transform) {
    let Transform { translation, rotation, scale } = transform;
    if translation != Vec3::ZERO {
        node.insert("translation".to_owned(), numbers(translation.to_array()));
    }
    if rotation != Quat::IDENTITY {
        node.insert("rotation".to_owned(), numbers(rotation.to_array()));
    }
    if scale != Vec3::ONE {
        node.insert("scale".to_owned(), numbers(scale.to_array()));
    }
}

/// Adds a matrix that is not the identity.
fn matrix(node: &mut Map<String, Value>, matrix: Mat4) {
    if matrix != Mat4::IDENTITY {
        node.insert("matrix".to_owned(), numbers(matrix.to_cols_array()));
    }
}
