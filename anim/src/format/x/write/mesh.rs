//! The objects of meshes.

use super::super::check as code;
use super::{list, open_frame};
use crate::data::{BoneIndex, Mesh, MeshInstance, ModelData, Primitive, Skin};
use crate::format::AxisMap;
use crate::format::losses::Losses;
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::fmt::Write;

/// Writes the meshes of a model.
pub(super) struct MeshWriter<'a> {
    pub(super) model: &'a ModelData,
    pub(super) to_file: AxisMap,
    /// Names of the frames of the bones.
    pub(super) frames: &'a [String],
    /// Names of the materials.
    pub(super) materials: &'a [String],
}

impl MeshWriter<'_> {
    /// Returns the bone that carries an instance.
    pub(super) fn bone_of(&self, index: usize) -> Option<BoneIndex> {
        let instance = &self.model.instances[index];
        instance.bone.filter(|_| instance.skin.is_none())
    }

    /// Writes an instance, `depth` frames deep.
    pub(super) fn write(&self, index: usize, depth: usize, losses: &mut Losses, text: &mut String) {
        let instance = &self.model.instances[index];
        let Some(mesh) = self.model.meshes.get(instance.mesh as usize) else { return };
        if mesh.primitives.iter().all(|primitive| primitive.vertices.is_empty()) {
            return;
        }
        let skin = instance.skin.and_then(|skin| self.model.skins.get(skin as usize));
        let to_frame = if skin.is_some() { Mat4::IDENTITY } else { instance.to_bone };
        // A frame of its own where nothing else places it.
        let needs_frame = depth == 0 || to_frame != Mat4::IDENTITY;
        if needs_frame {
            open_frame(&self.frame_name(index), self.to_file.matrix(to_frame), depth, text);
        }
        self.mesh(mesh, skin, text);
        if needs_frame {
            let _ = writeln!(text, "{}}}", " ".repeat(depth));
        }
        list_losses(mesh, instance, losses);
    }

    /// Returns a name for the frame of an instance that no bone has.
    fn frame_name(&self, index: usize) -> String {
        let mut name = format!("mesh{index}");
        while self.frames.contains(&name) {
            name.push('_');
        }
        name
    }

    fn mesh(&self, mesh: &Mesh, skin: Option<&Skin>, text: &mut String) {
        let name = if mesh.name.is_empty() { String::new() } else { super::possible(&mesh.name) + " " };
        let parts = &mesh.primitives;
        let vertices: usize = parts.iter().map(|part| part.vertices.len()).sum();
        let _ = writeln!(text, "Mesh {name}{{\n{vertices};");
        let positions = parts.iter().flat_map(|part| &part.vertices.positions);
        rows(text, positions.map(|&position| self.vector(self.to_file.position(position))));
        let faces = faces(parts);
        write_faces(text, &faces);
        let _ = writeln!(text, "MeshNormals {{\n{vertices};");
        let normal =
            |part: &Primitive, vertex: usize| part.vertices.normals.get(vertex).copied().unwrap_or(Vec3::Y);
        let normals =
            parts.iter().flat_map(|part| (0..part.vertices.len()).map(move |vertex| normal(part, vertex)));
        rows(text, normals.map(|normal| self.vector(self.to_file.direction(normal))));
        write_faces(text, &faces);
        *text += "}\n";
        self.coordinates(parts, vertices, text);
        self.material_list(parts, text);
        if let Some(skin) = skin {
            self.weights(parts, skin, text);
        }
        *text += "}\n";
    }

    fn vector(&self, vector: Vec3) -> String {
        let [x, y, z] = vector.to_array().map(super::decimal);
        format!("{x};{y};{z};")
    }

    fn coordinates(&self, parts: &[Primitive], count: usize, text: &mut String) {
        if parts.iter().any(|part| !part.vertices.texture_coordinates[0].is_empty()) {
            let _ = writeln!(text, "MeshTextureCoords {{\n{count};");
            let coordinate = |part: &Primitive, vertex: usize| {
                part.vertices.texture_coordinates[0].get(vertex).copied().unwrap_or(Vec2::ZERO)
            };
            let all = parts
                .iter()
                .flat_map(|part| (0..part.vertices.len()).map(move |vertex| coordinate(part, vertex)));
            rows(text, all.map(|at| format!("{};{};", super::decimal(at.x), super::decimal(at.y))));
            *text += "}\n";
        }
        if parts.iter().any(|part| !part.vertices.colors.is_empty()) {
            let _ = writeln!(text, "MeshVertexColors {{\n{count};");
            let color = |part: &Primitive, vertex: usize| {
                part.vertices.colors.get(vertex).copied().unwrap_or(Vec4::ONE)
            };
            let all =
                parts.iter().flat_map(|part| (0..part.vertices.len()).map(move |vertex| color(part, vertex)));
            rows(
                text,
                all.enumerate().map(|(vertex, color)| {
                    let [r, g, b, a] = color.to_array().map(super::decimal);
                    format!("{vertex};{r};{g};{b};{a};;")
                }),
            );
            *text += "}\n";
        }
    }

    fn material_list(&self, parts: &[Primitive], text: &mut String) {
        let mut used: Vec<u32> = Vec::new();
        let mut of_faces = Vec::new();
        // Faces without a material get the default one, which comes after those of the model.
        let default = self.model.materials.len() as u32;
        for part in parts {
            let material = part.material.unwrap_or(default);
            let slot = used.iter().position(|&known| known == material).unwrap_or_else(|| {
                used.push(material);
                used.len() - 1
            });
            of_faces.extend(std::iter::repeat_n(slot, part.indices.len() / 3));
        }
        let _ = writeln!(text, "MeshMaterialList {{\n{};\n{};", used.len(), of_faces.len());
        rows(text, of_faces.iter().map(ToString::to_string));
        for material in used {
            let _ = writeln!(text, "{{ {} }}", self.materials[material as usize]);
        }
        *text += "}\n";
    }

    fn weights(&self, parts: &[Primitive], skin: &Skin, text: &mut String) {
        let mut joints: Vec<Vec<(usize, f32)>> = vec![Vec::new(); skin.bones.len()];
        let (mut first, mut most) = (0, 0);
        for part in parts {
            for vertex in 0..part.vertices.len() {
                let influences =
                    part.vertices.influences_of(vertex).iter().filter(|influence| influence.weight > 0.0);
                let mut count = 0;
                for influence in influences {
                    joints[usize::from(influence.joint)].push((first + vertex, influence.weight));
                    count += 1;
                }
                most = most.max(count);
            }
            first += part.vertices.len();
        }
        // An empty list of weights makes the text unreadable for some programs.
        joints
            .iter_mut()
            .filter(|weights| weights.is_empty() && first > 0)
            .for_each(|weights| weights.push((0, 0.0)));
        let _ = writeln!(text, "XSkinMeshHeader {{\n{most};\n{};\n{};\n}}", 3 * most, skin.bones.len());
        for (weights, (&bone, &offset)) in joints.iter().zip(skin.bones.iter().zip(&skin.offsets)) {
            let _ = writeln!(text, "SkinWeights {{\n\"{}\";\n{};", self.frames[bone as usize], weights.len());
            rows(text, weights.iter().map(|(vertex, _)| vertex.to_string()));
            rows(text, weights.iter().map(|(_, weight)| super::decimal(*weight)));
            let _ = writeln!(text, "{};;\n}}", list(&self.to_file.matrix(offset).to_cols_array()));
        }
    }
}

/// Returns the corners of all triangles, reversed: mirroring the axes makes them clockwise, as the format has them.
fn faces(parts: &[Primitive]) -> Vec<[u32; 3]> {
    let (mut faces, mut first) = (Vec::new(), 0);
    for part in parts {
        let corners = part.indices.chunks_exact(3);
        faces
            .extend(corners.map(|corners| [corners[0], corners[2], corners[1]].map(|corner| corner + first)));
        first += part.vertices.len() as u32;
    }
    faces
}

/// Writes one row for each item of a list.
fn rows(text: &mut String, rows: impl Iterator<Item = String>) {
    let mut end = "";
    for row in rows {
        text.push_str(end);
        text.push_str(&row);
        end = ",\n";
    }
    text.push_str(";\n");
}

fn write_faces(text: &mut String, faces: &[[u32; 3]]) {
    let _ = writeln!(text, "{};", faces.len());
    rows(text, faces.iter().map(|[a, b, c]| format!("3;{a},{b},{c};")));
}

fn list_losses(mesh: &Mesh, instance: &MeshInstance, losses: &mut Losses) {
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let path = format!("/meshes/{}/primitives/{number}", instance.mesh);
        if !primitive.morph_targets.is_empty() {
            losses.add(path.clone(), code::MORPHS_NOT_STORED, "shape keys are not stored");
        }
        if !primitive.vertices.texture_coordinates[1].is_empty() || !primitive.vertices.tangents.is_empty() {
            let text = "tangents and second texture coordinates are not stored";
            losses.add(path, code::VERTICES_NOT_STORED, text);
        }
    }
}
