//! Geometry with skinning information: vertices as columns, triangles as indices.

use super::BoneIndex;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Largest number of influences of a vertex; where a file has more, the strongest are kept.
pub const MAX_INFLUENCES: usize = 8;

/// Influence of one bone on a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// Position in the skin's list of bones.
    pub joint: u16,
    /// 0..1; the weights of a vertex sum to 1.
    pub weight: f32,
}

/// One vertex, assembled from the columns (thesis §2.1.2.1, §3.1.2).
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Mesh space.
    pub position: Vec3,
    /// Mesh space, unit length.
    pub normal: Vec3,
    /// Two sets; (0,0) is the top left of an image.
    pub texture_coordinates: [Vec2; 2],
    /// Empty for a mesh without skin.
    pub influences: Vec<Influence>,
    /// Position in [`super::ModelData::materials`].
    pub material: Option<u32>,
}

/// Vertices as columns. `positions` determines the number of vertices; every other column is empty or as long.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vertices {
    /// Mesh space.
    pub positions: Vec<Vec3>,
    /// Mesh space, unit length. Never empty after import: computed from the triangles where the file has none.
    pub normals: Vec<Vec3>,
    /// xyz along +u in mesh space, w = ±1 the side of the bitangent.
    pub tangents: Vec<Vec4>,
    /// Two texture coordinate sets; either may be empty.
    pub texture_coordinates: [Vec<Vec2>; 2],
    /// Linear RGBA.
    pub colors: Vec<Vec4>,
    /// `influences_per_vertex` values per vertex, strongest first, padded with weight 0.
    pub influences: Vec<Influence>,
    /// 0 (no skin), 4 or 8.
    pub influences_per_vertex: usize,
}

impl Vertices {
    /// Returns the number of vertices.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns whether there is no vertex.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns the influences of vertex `index`, strongest first; empty without skin.
    pub fn influences_of(&self, index: usize) -> &[Influence] {
        let count = self.influences_per_vertex;
        self.influences.get(index * count..(index + 1) * count).unwrap_or(&[])
    }
}

/// Differences that a morph target (blend shape) adds to the vertices, times its weight.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias("blend shape", "shape key"))]
pub struct MorphTarget {
    /// As in the file; may be empty.
    pub name: String,
    /// Added to positions; empty or one per vertex.
    pub positions: Vec<Vec3>,
    /// Added to normals; empty or one per vertex.
    pub normals: Vec<Vec3>,
    /// Added to the xyz of tangents; empty or one per vertex.
    pub tangents: Vec<Vec3>,
}

/// Triangles of one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// The vertices as columns.
    pub vertices: Vertices,
    /// Three per triangle, counter-clockwise seen from the front; each below the vertex count.
    pub indices: Vec<u32>,
    /// Position in [`super::ModelData::materials`]; `None` for the default material.
    pub material: Option<u32>,
    /// Morph targets, the same number in every primitive of a mesh.
    pub morph_targets: Vec<MorphTarget>,
}

impl Primitive {
    /// Returns vertex `index`, assembled from the columns; `None` past the end.
    pub fn vertex(&self, index: usize) -> Option<Vertex> {
        let vertices = &self.vertices;
        Some(Vertex {
            position: *vertices.positions.get(index)?,
            normal: vertices.normals.get(index).copied().unwrap_or(Vec3::Y),
            texture_coordinates: [0, 1]
                .map(|set| vertices.texture_coordinates[set].get(index).copied().unwrap_or(Vec2::ZERO)),
            influences: vertices.influences_of(index).to_vec(),
            material: self.material,
        })
    }
}

/// Geometry as the file groups it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// As in the file; may be empty.
    pub name: String,
    /// The primitives of the mesh, each of one material.
    pub primitives: Vec<Primitive>,
    /// Default weights of the morph targets; one per target.
    pub morph_weights: Vec<f32>,
}

/// A mesh placed in the scene: moved by a skin, carried by a bone, or static.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshInstance {
    /// Position in [`super::ModelData::meshes`].
    pub mesh: u32,
    /// Index of the glTF node, `None` for other formats.
    pub node: Option<u32>,
    /// Position in [`super::ModelData::skins`]; a skinned mesh ignores `bone` and `to_bone`.
    pub skin: Option<u32>,
    /// The bone that carries it; `None` when nothing moves it.
    pub bone: Option<BoneIndex>,
    /// Mesh space → space of `bone`, or scene space without one.
    pub to_bone: Mat4,
    /// Morph weights where nothing animates them; one per target.
    pub morph_weights: Vec<f32>,
}
