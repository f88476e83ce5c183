//! The list of vertices and triangles of a file.

use super::super::check as code;
use super::bind::{FileSkeleton, MeshBinding};
use super::numbers::row;
use crate::data::{Influence, ModelData, Primitive};
use crate::format::AxisMap;
use crate::format::losses::Losses;
use crate::format::normals::direction;
use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Influences of a vertex in the file.
const INFLUENCES: usize = 4;

/// A vertex in the space of the file.
struct FileVertex {
    position: Vec3,
    tangent: Vec4,
    normal: Vec3,
    texture_coordinates: Vec2,
    /// Weights and bones.
    influences: [(f32, u32); INFLUENCES],
}

/// Vertices and triangles of one material.
#[derive(Default)]
pub(super) struct FilePart {
    pub(super) material: Option<u32>,
    vertices: Vec<FileVertex>,
    /// Numbers of vertices of this part.
    triangles: Vec<[u32; 3]>,
}

/// All vertices and triangles.
pub(super) struct FileVertices {
    pub(super) parts: Vec<FilePart>,
    has_bones: bool,
}

impl FileVertices {
    pub(super) fn of(
        model: &ModelData,
        bones: &FileSkeleton,
        to_file: &AxisMap,
        losses: &mut Losses,
    ) -> Self {
        let mut parts: BTreeMap<(bool, Option<u32>), FilePart> = BTreeMap::new();
        for (index, instance) in model.instances.iter().enumerate() {
            let Some(mesh) = model.meshes.get(instance.mesh as usize) else { continue };
            let binding = bones.binding(model, index, losses);
            for (number, primitive) in mesh.primitives.iter().enumerate() {
                list_losses(primitive, &format!("/meshes/{}/primitives/{number}", instance.mesh), losses);
                let material = primitive.material;
                let part = parts.entry((material.is_none(), material)).or_default();
                part.material = material;
                part.add(primitive, &binding, to_file);
            }
        }
        Self { parts: parts.into_values().collect(), has_bones: !bones.skeleton.is_empty() }
    }

    /// Returns the number of vertices.
    pub(super) fn len(&self) -> usize {
        self.parts.iter().map(|part| part.vertices.len()).sum()
    }

    /// Returns the number of triangles.
    pub(super) fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }

    /// Writes the table of subsets, the vertices and the triangles.
    pub(super) fn write(&self, text: &mut String) {
        *text += "***************SubsetTable*******************\n";
        let (mut vertex, mut face) = (0, 0);
        for (index, part) in self.parts.iter().enumerate() {
            let (vertices, faces) = (part.vertices.len(), part.triangles.len());
            let _ = writeln!(
                text,
                "SubsetID: {index} VertexStart: {vertex} VertexCount: {vertices} FaceStart: {face} FaceCount: {faces}"
            );
            (vertex, face) = (vertex + vertices, face + faces);
        }
        *text += "\n***************Vertices**********************\n";
        for vertex in self.parts.iter().flat_map(|part| &part.vertices) {
            self.write_vertex(vertex, text);
        }
        *text += "***************Triangles*********************\n";
        let mut first = 0;
        for part in &self.parts {
            for triangle in &part.triangles {
                let [a, b, c] = triangle.map(|vertex| vertex + first);
                let _ = writeln!(text, "{a} {b} {c}");
            }
            first += part.vertices.len() as u32;
        }
        *text += "\n";
    }

    fn write_vertex(&self, vertex: &FileVertex, text: &mut String) {
        let _ = writeln!(text, "Position: {}", row(&vertex.position.to_array()));
        let _ = writeln!(text, "Tangent: {}", row(&vertex.tangent.to_array()));
        let _ = writeln!(text, "Normal: {}", row(&vertex.normal.to_array()));
        let _ = writeln!(text, "Tex-Coords: {}", row(&vertex.texture_coordinates.to_array()));
        if self.has_bones {
            let weights = vertex.influences.map(|(weight, _)| weight);
            let [a, b, c, d] = vertex.influences.map(|(_, bone)| bone);
            let _ = writeln!(text, "BlendWeights: {}\nBlendIndices: {a} {b} {c} {d}", row(&weights));
        }
        *text += "\n";
    }
}

impl FilePart {
    fn add(&mut self, primitive: &Primitive, binding: &MeshBinding, to_file: &AxisMap) {
        let first = self.vertices.len() as u32;
        let vertices = &primitive.vertices;
        for index in 0..vertices.len() {
            let influences = strongest(vertices.influences_of(index));
            let matrix = blended(&influences, binding);
            let normal_matrix = normal_matrix(matrix);
            let normal = vertices.normals.get(index).copied().unwrap_or(Vec3::Y);
            let normal = direction(normal_matrix * normal).unwrap_or(Vec3::Y);
            let tangent = vertices.tangents.get(index).map_or_else(
                || normal.any_orthonormal_vector().extend(1.0),
                |tangent| {
                    let along = matrix.transform_vector3(tangent.truncate());
                    direction(along).unwrap_or(Vec3::X).extend(tangent.w)
                },
            );
            let position = matrix.transform_point3(vertices.positions[index]);
            let bone = |joint: usize| binding.bones.get(joint).copied().unwrap_or(0);
            self.vertices.push(FileVertex {
                position: to_file.position(position),
                tangent: to_file.tangent(tangent),
                normal: to_file.direction(normal),
                texture_coordinates: vertices.texture_coordinates[0].get(index).copied().unwrap_or_default(),
                influences: influences.map(|influence| match influence {
                    Some(influence) => (influence.weight, bone(usize::from(influence.joint))),
                    None => (0.0, 0),
                }),
            });
        }
        // Mirroring the axes makes the triangles clockwise, as the format has them, unless the mesh is mirrored in the scene.
        let is_mirrored = binding.matrices[0].determinant() < 0.0;
        self.triangles.extend(primitive.indices.chunks_exact(3).map(|corners| {
            let [a, b, c] = [corners[0], corners[1], corners[2]].map(|corner| corner + first);
            if is_mirrored { [a, b, c] } else { [a, c, b] }
        }));
    }
}

/// Returns the strongest influences, adding up to one; a vertex without any follows the first joint.
fn strongest(all: &[Influence]) -> [Option<Influence>; INFLUENCES] {
    let mut strongest = [None; INFLUENCES];
    let kept = &all[..all.len().min(INFLUENCES)];
    let sum: f32 = kept.iter().map(|influence| influence.weight).sum();
    for (slot, influence) in strongest.iter_mut().zip(kept).filter(|(_, influence)| influence.weight > 0.0) {
        let weight = if all.len() > INFLUENCES { influence.weight / sum } else { influence.weight };
        *slot = Some(Influence { weight, ..*influence });
    }
    strongest[0].get_or_insert(Influence { joint: 0, weight: 1.0 });
    strongest
}

/// Returns the transform of a vertex into the space of the file.
fn blended(influences: &[Option<Influence>; INFLUENCES], binding: &MeshBinding) -> Mat4 {
    let matrix = |influence: Influence| binding.matrices.get(usize::from(influence.joint)).copied();
    if let [first] = binding.matrices[..] {
        return first;
    }
    let mut sum = Mat4::ZERO;
    for &influence in influences.iter().flatten() {
        sum += matrix(influence).unwrap_or(binding.matrices[0]) * influence.weight;
    }
    sum
}

/// Returns the matrix for normals: the cofactors.
fn normal_matrix(matrix: Mat4) -> Mat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate());
    let sign = if x.cross(y).dot(z) < 0.0 { -1.0 } else { 1.0 };
    Mat3::from_cols(y.cross(z) * sign, z.cross(x) * sign, x.cross(y) * sign)
}

fn list_losses(primitive: &Primitive, path: &str, losses: &mut Losses) {
    let vertices = &primitive.vertices;
    if vertices.influences_per_vertex > INFLUENCES {
        let text = "vertices keep their four strongest influences";
        losses.add(path.to_owned(), code::INFLUENCES_NOT_STORED, text);
    }
    if !primitive.morph_targets.is_empty() {
        losses.add(path.to_owned(), code::MORPHS_NOT_STORED, "shape keys are not stored");
    }
    if !vertices.colors.is_empty() || !vertices.texture_coordinates[1].is_empty() {
        let text = "colors of vertices and second texture coordinates are not stored";
        losses.add(path.to_owned(), code::VERTICES_NOT_STORED, text);
    }
}
