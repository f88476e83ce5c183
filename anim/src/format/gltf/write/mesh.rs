//! Meshes of a written file.

use super::bytes::{AccessorShape, Components};
use super::{GltfWriter, named, numbers};
use crate::data::{Influence, Mesh, MorphTarget, Primitive, Vertices};
use glam::{Vec3, Vec4};
use serde_json::{Map, Value, json};

/// The meshes of a written file.
pub(super) struct WrittenMeshes {
    pub(super) values: Vec<Value>,
    /// Number in the file for each mesh of the model; `None` for one without triangles.
    pub(super) numbers: Vec<Option<usize>>,
}

impl GltfWriter<'_> {
    /// Writes all meshes. Primitives without triangles are left out, since glTF forbids them.
    pub(super) fn meshes(&mut self) -> WrittenMeshes {
        let model = self.model;
        let mut written = WrittenMeshes { values: Vec::new(), numbers: Vec::new() };
        for (index, mesh) in model.meshes.iter().enumerate() {
            let primitives: Vec<Value> = mesh
                .primitives
                .iter()
                .filter(|primitive| !primitive.vertices.is_empty() && primitive.indices.len() >= 3)
                .map(|primitive| self.primitive(primitive))
                .collect();
            if primitives.is_empty() {
                written.numbers.push(None);
                if !mesh.primitives.is_empty() {
                    self.lose(format!("/meshes/{index}"), "a mesh without triangles is left out");
                }
                continue;
            }
            written.numbers.push(Some(written.values.len()));
            written.values.push(mesh_value(mesh, primitives));
        }
        written
    }

    fn primitive(&mut self, primitive: &Primitive) -> Value {
        let mut attributes = Map::new();
        let vertices = &primitive.vertices;
        let mut add = |name: &str, values: &[f32], shape: AccessorShape| {
            if !values.is_empty() {
                let accessor = self.binary.accessor(Components::Floats(values), &shape.of_vertices());
                attributes.insert(name.to_owned(), json!(accessor));
            }
        };
        add("POSITION", &flat3(&vertices.positions), AccessorShape::VEC3.with_range());
        add("NORMAL", &flat3(&unit_normals(&vertices.normals)), AccessorShape::VEC3);
        add("TANGENT", &tangents(&vertices.tangents), AccessorShape::VEC4);
        for (set, coordinates) in vertices.texture_coordinates.iter().enumerate() {
            let flat: Vec<f32> = coordinates.iter().flat_map(|point| point.to_array()).collect();
            add(&format!("TEXCOORD_{set}"), &flat, AccessorShape::VEC2);
        }
        let colors: Vec<f32> = vertices.colors.iter().flat_map(|color| color.to_array()).collect();
        add("COLOR_0", &colors, AccessorShape::VEC4);
        self.influences(vertices, &mut attributes);
        let indices =
            self.binary.accessor(Components::Whole(&primitive.indices), &AccessorShape::SCALAR.of_indices());
        let mut written = Map::new();
        written.insert("attributes".to_owned(), Value::Object(attributes));
        written.insert("indices".to_owned(), json!(indices));
        if let Some(material) = primitive.material {
            written.insert("material".to_owned(), json!(material));
        }
        if !primitive.morph_targets.is_empty() {
            let targets = &primitive.morph_targets;
            let targets = targets.iter().map(|target| self.morph_target(target, vertices.len())).collect();
            written.insert("targets".to_owned(), Value::Array(targets));
        }
        Value::Object(written)
    }

    /// Writes joints and weights in sets of four. A joint without weight is 0, as the validator expects.
    fn influences(&mut self, vertices: &Vertices, attributes: &mut Map<String, Value>) {
        let per_vertex = vertices.influences_per_vertex;
        for set in 0..per_vertex.div_ceil(4) {
            let of_set = |index: usize| {
                let influences = vertices.influences_of(index);
                (4 * set..4 * set + 4).map(|slot| influences.get(slot).copied().unwrap_or_default())
            };
            let all: Vec<Influence> = (0..vertices.len()).flat_map(of_set).collect();
            let joint = |influence: &Influence| match influence.weight > 0.0 {
                true => u32::from(influence.joint),
                false => 0,
            };
            let joints: Vec<u32> = all.iter().map(joint).collect();
            let weights: Vec<f32> = all.iter().map(|influence| influence.weight.max(0.0)).collect();
            let shape = AccessorShape::VEC4.of_vertices();
            let joints = self.binary.accessor(Components::Whole(&joints), &shape);
            let weights = self.binary.accessor(Components::Floats(&weights), &shape);
            attributes.insert(format!("JOINTS_{set}"), json!(joints));
            attributes.insert(format!("WEIGHTS_{set}"), json!(weights));
        }
    }

    /// Writes the columns of a target. One without any gets positions of zero.
    fn morph_target(&mut self, target: &MorphTarget, vertices: usize) -> Value {
        let mut written = Map::new();
        let columns = [
            ("POSITION", &target.positions, AccessorShape::VEC3.with_range()),
            ("NORMAL", &target.normals, AccessorShape::VEC3),
            ("TANGENT", &target.tangents, AccessorShape::VEC3),
        ];
        for (name, column, shape) in columns {
            if column.iter().any(|value| *value != Vec3::ZERO) {
                let shape = shape.of_vertices();
                let accessor = self.binary.accessor(Components::Floats(&flat3(column)), &shape);
                written.insert(name.to_owned(), json!(accessor));
            } else if !column.is_empty() || name == "POSITION" {
                written.insert(name.to_owned(), json!(self.binary.zeros(vertices)));
            }
        }
        Value::Object(written)
    }
}

fn mesh_value(mesh: &Mesh, primitives: Vec<Value>) -> Value {
    let mut written = Map::new();
    named(&mut written, &mesh.name);
    written.insert("primitives".to_owned(), Value::Array(primitives));
    if mesh.morph_weights.iter().any(|&weight| weight != 0.0) {
        written.insert("weights".to_owned(), numbers(mesh.morph_weights.iter().copied()));
    }
    let targets = mesh.primitives.iter().map(|primitive| &primitive.morph_targets);
    let targets = targets.max_by_key(|targets| targets.len()).map_or(&[][..], Vec::as_slice);
    if targets.iter().any(|target| !target.name.is_empty()) {
        let names: Vec<&str> = targets.iter().map(|target| target.name.as_str()).collect();
        written.insert("extras".to_owned(), json!({"targetNames": names}));
    }
    Value::Object(written)
}

fn flat3(vectors: &[Vec3]) -> Vec<f32> {
    vectors.iter().flat_map(|vector| vector.to_array()).collect()
}

/// Returns normals of unit length: those of the model bit for bit where they are, +Y for those without a direction.
fn unit_normals(normals: &[Vec3]) -> Vec<Vec3> {
    let unit = |normal: &Vec3| match (normal.length() - 1.0).abs() < 1e-4 {
        true => *normal,
        false => normal.try_normalize().unwrap_or(Vec3::Y),
    };
    normals.iter().map(unit).collect()
}

/// Returns tangents of unit length with a side of 1 or -1.
fn tangents(tangents: &[Vec4]) -> Vec<f32> {
    let unit = |tangent: &Vec4| {
        let along = unit_normals(&[tangent.truncate()]);
        let side = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        along[0].extend(side).to_array()
    };
    tangents.iter().flat_map(unit).collect()
}
