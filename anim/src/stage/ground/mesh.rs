//! The triangles of a model in its rest pose, and a tree to find those over a point.
//!
//! The tree is one of rectangles on the ground plane (a bounding volume hierarchy): its triangles are halved along the longer side until a few are left.
//! Nodes are in the order in which a search visits them, each with the position of the node after its branch, so that a search needs no stack.

use crate::data::{MeshInstance, ModelData, Primitive};
use crate::evaluator::Evaluator;
use glam::{DVec2, DVec3, Mat4, Vec3};
use std::sync::Arc;

/// Largest number of triangles, and of vertices, of a model that is ground, summed over its mesh instances: about 150 MB.
pub const GROUND_TRIANGLES: usize = 1 << 21;

/// Number of triangles below which a node is not halved again.
const LEAF: usize = 4;

#[derive(Clone, Copy, Debug)]
struct GroundTriangle {
    corners: [Vec3; 3],
    faces_up: bool,
}

/// A rectangle around triangles; without a number of triangles an inner node.
#[derive(Clone, Copy, Debug)]
struct GroundNode {
    min: [f32; 2],
    max: [f32; 2],
    /// The node after all nodes of its branch.
    after: u32,
    first: u32,
    count: u32,
}

/// The surface of a model in its rest pose, without vertical triangles.
#[derive(Clone, Debug, Default)]
pub(in crate::stage) struct GroundMesh {
    triangles: Vec<GroundTriangle>,
    nodes: Vec<GroundNode>,
}

impl GroundMesh {
    /// Collects the triangles of `model`: O(n log n). `None` for more than [`GROUND_TRIANGLES`].
    ///
    /// Triangles with missing corners, or corners that are not finite, are left out. In a model none of whose triangles faces up, those that face down
    /// count as if they did.
    pub(in crate::stage) fn new(model: &Arc<ModelData>) -> Option<Self> {
        if size(model) > GROUND_TRIANGLES {
            return None;
        }
        let mut evaluator = Evaluator::new(Arc::clone(model));
        evaluator.pose(None, 0.0);
        let mut triangles = Vec::new();
        let mut positions = Vec::new();
        for (number, instance) in model.instances.iter().enumerate() {
            let is_mirrored = mirrors(instance, evaluator.to_root());
            for (index, primitive) in evaluator.primitives(number).iter().enumerate() {
                if primitive.indices.is_empty() {
                    continue;
                }
                positions.clear();
                positions.resize(primitive.vertices.len(), Vec3::ZERO);
                evaluator.positions(number, index, &mut positions);
                triangles.extend(primitive.indices.chunks_exact(3).filter_map(|corners| {
                    let corner =
                        |at: usize| positions.get(corners[at] as usize).copied().filter(|it| it.is_finite());
                    triangle([corner(0)?, corner(1)?, corner(2)?], is_mirrored)
                }));
            }
        }
        if !triangles.iter().any(|triangle| triangle.faces_up) {
            triangles.iter_mut().for_each(|triangle| triangle.faces_up = true);
        }
        let mut nodes = Vec::with_capacity(triangles.len());
        if !triangles.is_empty() {
            halve(&mut triangles, 0, &mut nodes);
        }
        Some(Self { triangles, nodes })
    }

    /// Calls `found` with the height, the side and the unit normal of each surface over or under a point of the ground plane, in its own space: the
    /// side is whether it faces up, the normal points up. Allocates nothing.
    pub(in crate::stage) fn at(&self, point: DVec2, mut found: impl FnMut(f64, bool, DVec3)) {
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            let inside =
                |axis: usize| (f64::from(node.min[axis])..=f64::from(node.max[axis])).contains(&point[axis]);
            if !(inside(0) && inside(1)) {
                at = node.after as usize;
                continue;
            }
            let (first, count) = (node.first as usize, node.count as usize);
            for triangle in self.triangles.get(first..first + count).unwrap_or(&[]) {
                if let Some((height, normal)) = triangle.height(point) {
                    found(height, triangle.faces_up, normal);
                }
            }
            at += 1;
        }
    }
}

/// Returns the number of triangles or vertices of all instances, whichever is larger.
fn size(model: &ModelData) -> usize {
    let of_primitive = |primitive: &Primitive| match primitive.indices.len() / 3 {
        0 => 0,
        triangles => triangles.max(primitive.vertices.len()),
    };
    let of_mesh =
        |primitives: &[Primitive]| primitives.iter().map(of_primitive).fold(0, usize::saturating_add);
    let meshes: Vec<usize> = model.meshes.iter().map(|mesh| of_mesh(&mesh.primitives)).collect();
    let placed = model.instances.iter().filter_map(|instance| meshes.get(instance.mesh as usize));
    placed.copied().fold(0, usize::saturating_add)
}

/// Returns whether an instance without a skin is mirrored, which exchanges the sides of its triangles.
fn mirrors(instance: &MeshInstance, to_root: &[Mat4]) -> bool {
    let bone = instance.bone.and_then(|bone| to_root.get(bone as usize)).copied().unwrap_or(Mat4::IDENTITY);
    instance.skin.is_none() && (bone * instance.to_bone).determinant() < 0.0
}

/// Returns x and z of a point.
fn flat(point: Vec3) -> DVec2 {
    DVec2::new(f64::from(point.x), f64::from(point.z))
}

/// Returns a triangle; `None` for one that is vertical, or is a line or a point.
fn triangle(corners: [Vec3; 3], is_mirrored: bool) -> Option<GroundTriangle> {
    let [a, b, c] = corners.map(flat);
    // Seen from above, with x to the right and z down, what is counter-clockwise has a negative area.
    let area = (b - a).perp_dot(c - a);
    (area != 0.0).then_some(GroundTriangle { corners, faces_up: (area < 0.0) != is_mirrored })
}

/// Returns twice the area of the triangle of an edge and a point. The same edge backwards has exactly the opposite.
fn side(from: DVec2, to: DVec2, point: DVec2) -> f64 {
    let is_forward = (from.x, from.y) <= (to.x, to.y);
    let (first, second) = if is_forward { (from, to) } else { (to, from) };
    let area = (second - first).perp_dot(point - first);
    if is_forward { area } else { -area }
}

impl GroundTriangle {
    /// Returns the height over a point of the ground plane and the normal that points up; `None` where the triangle is not. Its edges belong to it.
    fn height(&self, point: DVec2) -> Option<(f64, DVec3)> {
        let [a, b, c] = self.corners.map(flat);
        let shares = [side(b, c, point), side(c, a, point), side(a, b, point)];
        if !(shares.iter().all(|&share| share >= 0.0) || shares.iter().all(|&share| share <= 0.0)) {
            return None;
        }
        let sum = shares[0] + shares[1] + shares[2];
        let [p, q, r] = self.corners.map(|corner| corner.as_dvec3());
        let height = (p.y * shares[0] + q.y * shares[1] + r.y * shares[2]) / sum;
        let normal = (q - p).cross(r - p).normalize_or_zero();
        let normal = if normal.y < 0.0 { -normal } else { normal };
        let (low, high) = (p.y.min(q.y).min(r.y), p.y.max(q.y).max(r.y));
        (height.is_finite() && normal.y > 0.0).then(|| (height.clamp(low, high), normal))
    }

    /// Returns the sum of the corners along x or z: three times the middle.
    fn middle(&self, axis: usize) -> f32 {
        self.corners.iter().map(|corner| if axis == 0 { corner.x } else { corner.z }).sum()
    }
}

/// Adds the nodes of `triangles`, the first of which is number `first`, and sorts these by node.
fn halve(triangles: &mut [GroundTriangle], first: usize, nodes: &mut Vec<GroundNode>) {
    let (mut min, mut max) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for corner in triangles.iter().flat_map(|triangle| triangle.corners) {
        for (axis, value) in [corner.x, corner.z].into_iter().enumerate() {
            (min[axis], max[axis]) = (min[axis].min(value), max[axis].max(value));
        }
    }
    let count = triangles.len();
    let axis = usize::from(max[1] - min[1] > max[0] - min[0]);
    // A little larger, because points on an edge belong to it up to rounding.
    let (min, max) = (min.map(f32::next_down), max.map(f32::next_up));
    let own = nodes.len();
    let is_leaf = count <= LEAF;
    let leaf = if is_leaf { count as u32 } else { 0 };
    nodes.push(GroundNode { min, max, after: 0, first: first as u32, count: leaf });
    if !is_leaf {
        let half = count / 2;
        triangles.select_nth_unstable_by(half, |a, b| a.middle(axis).total_cmp(&b.middle(axis)));
        let (left, right) = triangles.split_at_mut(half);
        halve(left, first, nodes);
        halve(right, first + half, nodes);
    }
    nodes[own].after = nodes.len() as u32;
}
