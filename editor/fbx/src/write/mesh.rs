//! Geometry: the vertices and triangles of all primitives of a mesh, and its shapes.

use super::images::UV_SETS;
use super::node::FbxNode;
use super::scene::{ObjectId, SceneWriter};
use super::space::FileSpace;
use dragonfly_anim::data::{Mesh, Primitive, Vertices};
use glam::{DMat3, DMat4, DVec3, Vec2, Vec4};

/// A mesh as it is stored: moved by a matrix if no node can hold it.
pub(super) struct GeometrySource<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) moved: DMat4,
    pub(super) space: &'a FileSpace,
}

/// Returns the three numbers of each vector.
fn numbers(vectors: impl IntoIterator<Item = DVec3>) -> Vec<f64> {
    vectors.into_iter().flat_map(|vector| vector.to_array()).collect()
}

/// Returns a layer of the geometry with one value for each vertex, which corners refer to by their vertex.
fn layer(
    kind: &'static str,
    number: i32,
    name: &str,
    version: i32,
    columns: (&'static str, Vec<f64>, &'static str, &[i32]),
) -> FbxNode {
    let (values, list, indices, corners) = columns;
    FbxNode::new(kind)
        .with(number)
        .value("Version", version)
        .value("Name", name)
        .value("MappingInformationType", "ByPolygonVertex")
        .value("ReferenceInformationType", "IndexToDirect")
        .value(values, list)
        .value(indices, corners.to_vec())
}

/// Returns the triangles of a primitive whose vertices exist.
fn triangles(primitive: &Primitive) -> impl Iterator<Item = &[u32]> {
    let count = primitive.vertices.len();
    let whole = primitive.indices.chunks_exact(3);
    whole.filter(move |triangle| triangle.iter().all(|&index| (index as usize) < count))
}

impl GeometrySource<'_> {
    fn vertices(&self) -> impl Iterator<Item = &Vertices> {
        self.mesh.primitives.iter().map(|primitive| &primitive.vertices)
    }

    fn has(&self, column: impl Fn(&Vertices) -> bool) -> bool {
        self.vertices().any(column)
    }

    /// Returns the triangles as numbers of vertices of the whole mesh.
    pub(super) fn corners(&self) -> Vec<i32> {
        let mut corners = Vec::new();
        let mut first = 0;
        for primitive in &self.mesh.primitives {
            corners.extend(triangles(primitive).flatten().map(|&index| (first + index as usize) as i32));
            first += primitive.vertices.len();
        }
        corners
    }

    /// Adds the geometry. `material_of` returns the number of the material of a primitive among those of its nodes.
    pub(super) fn add(
        &self,
        scene: &mut SceneWriter,
        material_of: impl Fn(&Primitive) -> Option<i32>,
    ) -> ObjectId {
        let corners = self.corners();
        let positions = self.vertices().flat_map(|vertices| &vertices.positions);
        let positions =
            positions.map(|position| self.space.position(self.moved.transform_point3(position.as_dvec3())));
        let polygons = corners.iter().enumerate();
        let polygons = polygons.map(|(at, &corner)| if at % 3 == 2 { !corner } else { corner });
        let mut children = vec![
            FbxNode::new("Properties70"),
            FbxNode::new("GeometryVersion").with(124),
            FbxNode::new("Vertices").with(numbers(positions)),
            FbxNode::new("PolygonVertexIndex").with(polygons.collect::<Vec<i32>>()),
        ];
        let mut layers = [FbxNode::new("Layer").with(0).value("Version", 100), second_layer()];
        let mut add = |element: FbxNode, kind: &str, number: i32| {
            let entry = FbxNode::new("LayerElement").value("Type", kind).value("TypedIndex", number);
            children.push(element);
            if let Some(layer) = layers.get_mut(number as usize) {
                layer.push(entry);
            }
        };
        if self.has(|vertices| !vertices.normals.is_empty()) {
            let normals = ("Normals", self.normals(), "NormalsIndex", &*corners);
            add(layer("LayerElementNormal", 0, "", 101, normals), "LayerElementNormal", 0);
        }
        let sets = [0, 1].map(|set| self.has(|vertices| !vertices.texture_coordinates[set].is_empty()));
        for set in 0..2 {
            // The second set keeps its number.
            if sets[set] || (set == 0 && sets[1]) {
                let uvs = ("UV", self.coordinates(set), "UVIndex", &*corners);
                let element = layer("LayerElementUV", set as i32, UV_SETS[set], 101, uvs);
                add(element, "LayerElementUV", set as i32);
            }
        }
        if self.has(|vertices| !vertices.colors.is_empty()) {
            let colors = ("Colors", self.colors(), "ColorIndex", &*corners);
            add(layer("LayerElementColor", 0, "Col", 101, colors), "LayerElementColor", 0);
        }
        if let Some(materials) = self.materials(material_of) {
            add(materials, "LayerElementMaterial", 0);
        }
        let [first, second] = layers;
        children.push(first);
        if sets[1] {
            children.push(second);
        }
        scene.object("Geometry", &self.mesh.name, ("Geometry", "Mesh"), children)
    }

    /// Returns the matrix of normals.
    fn normal_matrix(&self) -> DMat3 {
        let linear = DMat3::from_mat4(self.moved);
        let inverse = linear.inverse();
        if self.moved == DMat4::IDENTITY || !inverse.is_finite() {
            DMat3::IDENTITY
        } else {
            inverse.transpose()
        }
    }

    fn normals(&self) -> Vec<f64> {
        let matrix = self.normal_matrix();
        let of = |vertices: &Vertices, vertex: usize| {
            let normal = vertices.normals.get(vertex).map_or(DVec3::Y, |normal| normal.as_dvec3());
            let moved =
                if matrix == DMat3::IDENTITY { normal } else { (matrix * normal).normalize_or_zero() };
            self.space.direction(moved)
        };
        numbers(self.each(of))
    }

    fn coordinates(&self, set: usize) -> Vec<f64> {
        let of = |vertices: &Vertices, vertex: usize| {
            vertices.texture_coordinates[set].get(vertex).copied().unwrap_or(Vec2::ZERO)
        };
        self.each(of).flat_map(|uv| [f64::from(uv.x), 1.0 - f64::from(uv.y)]).collect()
    }

    fn colors(&self) -> Vec<f64> {
        let of =
            |vertices: &Vertices, vertex: usize| vertices.colors.get(vertex).copied().unwrap_or(Vec4::ONE);
        self.each(of).flat_map(|color| color.as_dvec4().to_array()).collect()
    }

    /// Returns a value for each vertex.
    fn each<T>(&self, of: impl Fn(&Vertices, usize) -> T) -> impl Iterator<Item = T> {
        self.vertices().flat_map(move |vertices| {
            (0..vertices.len()).map(|vertex| of(vertices, vertex)).collect::<Vec<T>>()
        })
    }

    fn materials(&self, material_of: impl Fn(&Primitive) -> Option<i32>) -> Option<FbxNode> {
        let mut numbers: Vec<i32> = Vec::new();
        for primitive in &self.mesh.primitives {
            let material = material_of(primitive)?;
            numbers.extend(triangles(primitive).map(|_| material));
        }
        let first = *numbers.first()?;
        let is_same = numbers.iter().all(|&number| number == first);
        let (mapping, numbers) = if is_same { ("AllSame", vec![first]) } else { ("ByPolygon", numbers) };
        Some(
            FbxNode::new("LayerElementMaterial")
                .with(0)
                .value("Version", 101)
                .value("Name", "")
                .value("MappingInformationType", mapping)
                .value("ReferenceInformationType", "IndexToDirect")
                .value("Materials", numbers),
        )
    }

    /// Adds the shape of a morph target.
    pub(super) fn add_shape(&self, scene: &mut SceneWriter, target: usize, name: &str) -> ObjectId {
        let linear = DMat3::from_mat4(self.moved);
        let normal = self.normal_matrix();
        let (mut indices, mut positions, mut normals) = (Vec::new(), Vec::new(), Vec::new());
        let mut first = 0;
        for primitive in &self.mesh.primitives {
            if let Some(target) = primitive.morph_targets.get(target) {
                for vertex in 0..primitive.vertices.len() {
                    let of = |column: &[glam::Vec3]| {
                        column.get(vertex).map_or(DVec3::ZERO, |value| value.as_dvec3())
                    };
                    let (position, turned) = (of(&target.positions), of(&target.normals));
                    if position != DVec3::ZERO || turned != DVec3::ZERO {
                        indices.push((first + vertex) as i32);
                        positions.push(self.space.position(linear * position));
                        normals.push(self.space.direction(normal * turned));
                    }
                }
            }
            first += primitive.vertices.len();
        }
        let children = [
            FbxNode::new("Properties70"),
            FbxNode::new("Version").with(100),
            FbxNode::new("Indexes").with(indices),
            FbxNode::new("Vertices").with(numbers(positions)),
            FbxNode::new("Normals").with(numbers(normals)),
        ];
        scene.object("Geometry", name, ("Geometry", "Shape"), children)
    }
}

fn second_layer() -> FbxNode {
    FbxNode::new("Layer").with(1).value("Version", 100)
}
