//! The shape keys of a model: its meshes with morph targets, the names of these, and their weights where nothing animates them.

use crate::edit::target::{MeshRef, ShapeRef};
use dragonfly_anim::data::ModelData;
use std::sync::Arc;

/// A mesh with shape keys. Several meshes of a model may be instances of the same geometry, each with weights of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeMesh {
    instance: u32,
    name: String,
    shapes: Vec<String>,
    rest: Vec<f32>,
}

impl ShapeMesh {
    /// Returns the index in the list of mesh instances of the model, which also names it in takes.
    pub fn instance(&self) -> u32 {
        self.instance
    }

    /// Returns its name: that of the geometry, else that of the bone that carries it, else `Mesh 1`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the name of each shape key: that of the file, else `Shape 1`, counted from 1.
    pub fn shapes(&self) -> &[String] {
        &self.shapes
    }

    /// Returns the weight of each shape key where nothing animates it.
    pub fn rest(&self) -> &[f32] {
        &self.rest
    }

    /// Returns the index of a shape key; a name that several share means the first of them.
    pub fn find(&self, shape: &ShapeRef) -> Option<usize> {
        match shape {
            ShapeRef::Index(index) => Some(*index as usize).filter(|&index| index < self.rest.len()),
            ShapeRef::Name(name) => self.shapes.iter().position(|shape| shape == name),
        }
    }
}

/// The meshes of a model that have shape keys, in the order of its mesh instances. A copy is cheap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelShapes {
    meshes: Arc<[ShapeMesh]>,
}

impl ModelShapes {
    /// Returns the shape keys of a model.
    pub fn of(model: &ModelData) -> Self {
        let mut meshes = Vec::new();
        for (index, instance) in model.instances.iter().enumerate() {
            if instance.morph_weights.is_empty() {
                continue;
            }
            let mesh = model.meshes.get(instance.mesh as usize);
            let targets = mesh.and_then(|mesh| mesh.primitives.first());
            let targets = targets.map_or(&[][..], |primitive| &primitive.morph_targets);
            let shape = |at: usize| match targets.get(at).map(|target| target.name.as_str()) {
                None | Some("") => format!("Shape {}", at + 1),
                Some(name) => name.to_owned(),
            };
            let bones = &model.animation.skeleton.bones;
            let bone = instance.bone.and_then(|bone| bones.get(bone as usize));
            let names = [mesh.map(|mesh| &mesh.name), bone.map(|bone| &bone.name)];
            let name = names.into_iter().flatten().find(|name| !name.is_empty());
            let rest = &instance.morph_weights;
            meshes.push(ShapeMesh {
                instance: index as u32,
                name: name.cloned().unwrap_or_else(|| format!("Mesh {}", meshes.len() + 1)),
                shapes: (0..rest.len()).map(shape).collect(),
                rest: rest.iter().map(|&weight| if weight.is_finite() { weight } else { 0.0 }).collect(),
            });
        }
        Self { meshes: meshes.into() }
    }

    /// Returns the meshes.
    pub fn meshes(&self) -> &[ShapeMesh] {
        &self.meshes
    }

    /// Returns the mesh at an index of the list of mesh instances of the model.
    pub fn mesh(&self, instance: u32) -> Option<&ShapeMesh> {
        let at = self.meshes.binary_search_by_key(&instance, ShapeMesh::instance).ok()?;
        self.meshes.get(at)
    }

    /// Returns the mesh and the index of a shape key. Without a mesh, or with a name that several meshes share, the first mesh that has
    /// the shape key is meant.
    pub fn find(&self, mesh: Option<&MeshRef>, shape: &ShapeRef) -> Option<(&ShapeMesh, usize)> {
        let is_named = |one: &&ShapeMesh| match mesh {
            None => true,
            Some(MeshRef::Index(index)) => one.instance == *index,
            Some(MeshRef::Name(name)) => one.name == *name,
        };
        self.meshes.iter().filter(is_named).find_map(|mesh| Some((mesh, mesh.find(shape)?)))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use dragonfly_anim::data::{Mesh, MeshInstance, MorphTarget, Primitive};
    use glam::Mat4;

    /// A face with two named shape keys, a mesh without any, and a body with one that has no name.
    pub(crate) fn two_meshes() -> ModelShapes {
        ModelShapes::of(&model())
    }

    fn model() -> ModelData {
        let mesh = |name: &str, targets: &[&str]| {
            let target = |name: &&str| MorphTarget { name: (*name).to_owned(), ..MorphTarget::default() };
            let morph_targets = targets.iter().map(target).collect();
            let primitives = vec![Primitive { morph_targets, ..Primitive::default() }];
            Mesh { name: name.to_owned(), primitives, morph_weights: vec![0.0; targets.len()] }
        };
        let instance = |mesh: u32, weights: &[f32]| MeshInstance {
            mesh,
            node: None,
            skin: None,
            bone: None,
            to_bone: Mat4::IDENTITY,
            morph_weights: weights.to_vec(),
        };
        ModelData {
            meshes: vec![mesh("Face", &["smile", "blink_L"]), mesh("Hair", &[]), mesh("", &[""])],
            instances: vec![instance(0, &[0.0, 0.25]), instance(1, &[]), instance(2, &[f32::NAN])],
            ..ModelData::default()
        }
    }

    #[test]
    fn shape_keys_are_found_by_mesh_and_name_or_index() {
        let shapes = two_meshes();
        let find = |mesh: Option<MeshRef>, shape: ShapeRef| {
            shapes.find(mesh.as_ref(), &shape).map(|(mesh, shape)| (mesh.instance(), shape))
        };
        let name = |name: &str| ShapeRef::Name(name.to_owned());
        assert_eq!(find(None, name("blink_L")), Some((0, 1)));
        assert_eq!(find(None, name("Shape 1")), Some((2, 0)), "it has no name in the file");
        assert_eq!(find(Some(MeshRef::Index(2)), ShapeRef::Index(0)), Some((2, 0)));
        assert_eq!(find(Some(MeshRef::Name("Face".to_owned())), name("smile")), Some((0, 0)));
        for (mesh, shape) in [
            (None, name("frown")),
            (Some(MeshRef::Index(1)), ShapeRef::Index(0)),
            (Some(MeshRef::Index(2)), name("smile")),
            (Some(MeshRef::Index(0)), ShapeRef::Index(2)),
        ] {
            assert_eq!(find(mesh.clone(), shape.clone()), None, "{mesh:?} {shape:?}");
        }
        assert_eq!(shapes.mesh(0).map(ShapeMesh::rest), Some(&[0.0, 0.25][..]));
        assert_eq!(shapes.mesh(2).map(|mesh| (mesh.name(), mesh.rest())), Some(("Mesh 2", &[0.0][..])));
        assert_eq!(shapes.mesh(1), None);
    }
}
