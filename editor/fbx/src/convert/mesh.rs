//! Meshes: polygons become triangles, corners become vertices, each material becomes a primitive.

use super::morph::{MorphShape, morph_shapes, morph_targets};
use super::skin::{FixedWeights, MeshJoints, influences, place_of};
use super::space::FbxSpace;
use crate::code::{FBX_NOT_SHOWN, FBX_WEIGHTS};
use dragonfly_anim::data::{MAX_INFLUENCES, Mesh, Primitive, Vertices};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::VERTICES;
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// A mesh, and the shapes of its morph targets.
pub(super) struct FbxMesh {
    pub(super) mesh: Mesh,
    pub(super) shapes: Vec<MorphShape>,
}

/// Numbers of a corner as bits: vertex, normal, two texture coordinates, color. CornerMerger with the same numbers are one vertex.
type CornerBits = [u32; 12];

/// Largest normal length that is taken for none.
const NO_LENGTH: f32 = 1e-12;

/// Returns all meshes of the file in its order.
pub(super) fn meshes(
    scene: &ufbx::Scene,
    space: &FbxSpace,
    joints: &[Option<MeshJoints>],
    context: &ImportContext<'_>,
) -> Result<Vec<FbxMesh>, ImportError> {
    let count = scene.meshes.len();
    let mut meshes = context.vec(&Place::Pointer("/meshes".to_owned()), count)?;
    let mut total = 0;
    for (index, (mesh, joints)) in scene.meshes.into_iter().zip(joints).enumerate() {
        meshes.push(read_mesh(scene, mesh, space, joints.as_ref(), &mut total, context)?);
        context.progress(0.5 + 0.2 * (index + 1) as f32 / count as f32)?;
    }
    Ok(meshes)
}

fn read_mesh(
    scene: &ufbx::Scene,
    mesh: &ufbx::Mesh,
    space: &FbxSpace,
    joints: Option<&MeshJoints>,
    total: &mut usize,
    context: &ImportContext<'_>,
) -> Result<FbxMesh, ImportError> {
    let place = place_of(mesh);
    if mesh.num_line_faces + mesh.num_point_faces > 0 {
        context.warn(place.clone(), FBX_NOT_SHOWN, "points and lines are not shown");
    }
    let shapes = morph_shapes(mesh, context)?;
    let mut primitives = context.vec(&place, mesh.material_parts.len())?;
    let mut fixed = FixedWeights::default();
    for part in mesh.material_parts.iter().filter(|part| part.num_triangles > 0) {
        let mut corners = CornerMerger {
            mesh,
            space,
            context,
            place: &place,
            vertices: Vertices::default(),
            sources: Vec::new(),
            known: HashMap::new(),
        };
        let indices = corners.triangles(part)?;
        let CornerMerger { mut vertices, sources, .. } = corners;
        *total = total.saturating_add(vertices.len());
        if *total > VERTICES {
            let (size, limit) = (*total as u64, VERTICES as u64);
            return Err(ImportError::TooLarge { place, what: "vertices", size, limit });
        }
        if let Some(joints) = joints {
            weigh(mesh, joints, &sources, &mut vertices, &mut fixed, context)?;
        }
        let morph_targets = morph_targets(mesh, &shapes, &sources, space, context)?;
        let material = mesh.materials.get(part.index as usize).map(|material| material.element.typed_id);
        let material = material.filter(|&material| (material as usize) < scene.materials.len());
        primitives.push(Primitive { vertices, indices, material, morph_targets });
    }
    if fixed.dropped > 0 {
        let text = format!(
            "{} vertices have more than {MAX_INFLUENCES} influences; the strongest are kept",
            fixed.dropped
        );
        context.warn(place, FBX_WEIGHTS, text);
    }
    let name = match &*mesh.element.name {
        "" => mesh.element.instances.into_iter().next().map_or("", |node| &*node.element.name),
        name => name,
    };
    let morph_weights = shapes.iter().map(|shape| shape.weight).collect();
    Ok(FbxMesh { mesh: Mesh { name: name.to_owned(), primitives, morph_weights }, shapes })
}

/// Gives the vertices of a primitive their influences; `sources` are their vertices in the file.
fn weigh(
    mesh: &ufbx::Mesh,
    joints: &MeshJoints,
    sources: &[u32],
    vertices: &mut Vertices,
    fixed: &mut FixedWeights,
    context: &ImportContext<'_>,
) -> Result<(), ImportError> {
    let mut list = context.vec(&place_of(mesh), sources.len().saturating_mul(MAX_INFLUENCES))?;
    let mut most = 0;
    for &source in sources {
        context.work(MAX_INFLUENCES)?;
        most = most.max(influences(mesh, joints, source as usize, &mut list, fixed));
    }
    let per_vertex = if most <= 4 { 4 } else { MAX_INFLUENCES };
    if per_vertex < MAX_INFLUENCES {
        for vertex in 1..sources.len() {
            let from = vertex * MAX_INFLUENCES;
            list.copy_within(from..from + per_vertex, vertex * per_vertex);
        }
        list.truncate(sources.len() * per_vertex);
    }
    (vertices.influences, vertices.influences_per_vertex) = (list, per_vertex);
    Ok(())
}

/// Collects the vertices of a primitive.
struct CornerMerger<'a> {
    mesh: &'a ufbx::Mesh,
    space: &'a FbxSpace,
    context: &'a ImportContext<'a>,
    place: &'a Place,
    vertices: Vertices,
    /// Vertex of the file for each vertex.
    sources: Vec<u32>,
    known: HashMap<CornerBits, u32>,
}

impl CornerMerger<'_> {
    /// Returns the triangles of the faces of a part as indices.
    fn triangles(&mut self, part: &ufbx::MeshPart) -> Result<Vec<u32>, ImportError> {
        let mesh = self.mesh;
        let mut indices = self.context.vec(self.place, part.num_triangles.saturating_mul(3))?;
        let mut corners = self.context.filled(self.place, mesh.max_face_triangles.saturating_mul(3), 0)?;
        for &face in &part.face_indices {
            let Some(&face) = mesh.faces.get(face as usize) else { continue };
            if face.num_indices < 3 {
                continue;
            }
            self.context.work(face.num_indices as usize)?;
            let triangles = ufbx::triangulate_face(&mut corners, mesh, face) as usize;
            for triangle in corners[..triangles * 3].chunks_exact(3) {
                let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
                let ordered = if self.space.mirrors() { [a, c, b] } else { [a, b, c] };
                let flat = self.flat_normal(ordered);
                for corner in ordered {
                    indices.push(self.vertex(corner as usize, flat)?);
                }
            }
        }
        Ok(indices)
    }

    fn position(&self, corner: usize) -> Vec3 {
        let vertex = self.mesh.vertex_indices.get(corner).copied().unwrap_or(0);
        self.mesh.vertices.get(vertex as usize).map_or(Vec3::ZERO, |&position| self.space.position(position))
    }

    /// Returns the normal of a triangle, for corners without one.
    fn flat_normal(&self, corners: [u32; 3]) -> Vec3 {
        let [a, b, c] = corners.map(|corner| self.position(corner as usize));
        let normal = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or(glam::DVec3::Y);
        normal.as_vec3()
    }

    /// Returns the number of the vertex of a corner, a new one if no corner before has the same numbers.
    fn vertex(&mut self, corner: usize, flat: Vec3) -> Result<u32, ImportError> {
        let mesh = self.mesh;
        let source = mesh.vertex_indices.get(corner).copied().unwrap_or(0);
        let normal = value(&mesh.vertex_normal.values, &mesh.vertex_normal.indices, corner)
            .map(|&normal| self.space.direction(normal))
            .filter(|normal| normal.length_squared() > NO_LENGTH)
            .map_or(flat, |normal| normal.as_dvec3().normalize().as_vec3());
        let coordinates = [0, 1].map(|set| self.coordinates(set, corner));
        let color = value(&mesh.vertex_color.values, &mesh.vertex_color.indices, corner).map(|color| {
            let number = |value: f64| if value.is_finite() { value.clamp(0.0, 1.0) as f32 } else { 1.0 };
            Vec4::new(number(color.x), number(color.y), number(color.z), number(color.w))
        });
        let bits = bits(source, normal, coordinates, color);
        if let Some(&known) = self.known.get(&bits) {
            return Ok(known);
        }
        let number = self.sources.len() as u32;
        // The columns, and twice the entry of the map.
        self.context.charge(self.place, (size_of::<CornerBits>() * 3 + 2 * size_of::<Vec4>() * 3) as u64)?;
        self.known.insert(bits, number);
        self.sources.push(source);
        let position = self.position(corner);
        let vertices = &mut self.vertices;
        vertices.positions.push(position);
        vertices.normals.push(normal);
        for (column, coordinates) in vertices.texture_coordinates.iter_mut().zip(coordinates) {
            column.extend(coordinates);
        }
        vertices.colors.extend(color);
        Ok(number)
    }

    /// Returns the texture coordinates of a corner; v points down in models, up in FBX.
    fn coordinates(&self, set: usize, corner: usize) -> Option<Vec2> {
        let set = self.mesh.uv_sets.get(set)?;
        let number = |value: f64| if value.is_finite() { value as f32 } else { 0.0 };
        let found = value(&set.vertex_uv.values, &set.vertex_uv.indices, corner);
        // Every vertex has a value if one has.
        Some(found.map_or(Vec2::ZERO, |uv| Vec2::new(number(uv.x), 1.0 - number(uv.y))))
    }
}

/// Returns the value of an attribute at a corner; `None` if the mesh does not have the attribute.
fn value<'a, T>(values: &'a [T], indices: &[u32], corner: usize) -> Option<&'a T> {
    values.get(*indices.get(corner)? as usize)
}

fn bits(source: u32, normal: Vec3, coordinates: [Option<Vec2>; 2], color: Option<Vec4>) -> CornerBits {
    let [first, second] = coordinates.map(|coordinates| coordinates.unwrap_or_default());
    let color = color.unwrap_or_default();
    let numbers = [
        normal.x, normal.y, normal.z, first.x, first.y, second.x, second.y, color.x, color.y, color.z,
        color.w,
    ];
    let mut bits = [source; 12];
    for (bits, number) in bits[1..].iter_mut().zip(numbers) {
        *bits = number.to_bits();
    }
    bits
}
