//! The tree in a pose: its boxes refitted, and the traversal for queries.

use super::candidate::{Candidate, RaySearch, SphereSearch, TriangleAddress, complete};
use super::tree::MIXED;
use super::triangle::UnitRay;
use super::{Hit, HitNode, HitSettings, HitTree, Ray, TREE_DEPTH};
use crate::bounds::AxisBox;
use crate::data::Primitive;
use crate::evaluator::Evaluator;
use crate::skin::{Movement, skin_position};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// Relative widening of boxes in a query: a hundred roundings of `f64`, so that no triangle is skipped that the
/// formulas would hit by rounding.
const PAD: f64 = 1e-14;

/// Relative margin by which a box may be further away than the best hit and is still visited: the distance to a
/// triangle nearly parallel to the ray is known to no more digits.
const NEAR_TIE: f64 = 1.0 + 1e-9;

/// A [`HitTree`] with its boxes fitted to one pose, and working memory.
///
/// Call [`Self::refit`] after each new pose, then any number of queries; each takes the evaluator of the refit, in the
/// same pose. (With another pose or another model the result is finite but meaningless.) Neither allocates. A box is
/// fitted when a query first visits it, from the final poses of its joints, and the vertices of a leaf are skinned when
/// a query first reaches it; both are cached until the next refit. Therefore queries need `&mut self`, and the first
/// after a refit takes longer than those that follow.
#[derive(Clone, Debug)]
pub struct HitPose {
    tree: Arc<HitTree>,
    /// Number of refits; entries with another number are out of date.
    now: u32,
    /// One box per node, and the refit for which it was fitted.
    boxes: Vec<(AxisBox, u32)>,
    /// Positions of the tree's vertices: scene space.
    positions: Vec<Vec3>,
    /// For each leaf, the refit for which it was skinned.
    skinned: Vec<u32>,
    /// Nodes still to visit, and the distance at which each begins.
    stack: Vec<(u32, f64)>,
}

impl HitPose {
    /// Creates the tree in no pose: nothing is hit until [`Self::refit`].
    pub fn new(tree: Arc<HitTree>) -> Self {
        let parts = tree.parts();
        Self {
            now: 0,
            boxes: vec![(AxisBox::EMPTY, 0); parts.nodes.len()],
            positions: vec![Vec3::ZERO; tree.vertices.len()],
            skinned: vec![0; parts.leaves.len()],
            stack: Vec::with_capacity(TREE_DEPTH + 2),
            tree,
        }
    }

    /// Returns the tree.
    pub fn tree(&self) -> &Arc<HitTree> {
        &self.tree
    }

    /// Discards the last pose and fits the highest boxes to that of `evaluator`, from the final poses of the joints:
    /// O(joints of all instances). Reads no vertex. Allocates nothing.
    pub fn refit(&mut self, evaluator: &Evaluator) {
        self.now = self.now.wrapping_add(1);
        if self.now == 0 {
            // After 2³² poses the numbers start again, so all old ones are cleared.
            self.now = 1;
            self.boxes.iter_mut().for_each(|(_, when)| *when = 0);
            self.skinned.fill(0);
        }
        if !self.boxes.is_empty() {
            self.fit(evaluator, 0);
        }
    }

    /// Returns the box of a node in the pose, and fits it if needed.
    fn fit(&mut self, evaluator: &Evaluator, node: u32) -> AxisBox {
        let (bounds, when) = self.boxes[node as usize];
        if when == self.now {
            return bounds;
        }
        let (part, instance, primitive) = self.tree.parts_of[node as usize];
        let bounds = if part != MIXED {
            let movement = evaluator.movement(instance as usize, primitive as usize);
            let weights = evaluator.morph_weights(instance as usize);
            movement
                .map_or(AxisBox::EMPTY, |movement| self.tree.reaches.fit(part as usize, movement, weights))
        } else if let HitNode::Inner([left, right]) = self.tree.parts().nodes[node as usize] {
            // The depth of recursion is that of the tree.
            self.fit(evaluator, left).union(self.fit(evaluator, right))
        } else {
            AxisBox::EMPTY
        };
        self.boxes[node as usize] = (bounds, self.now);
        bounds
    }

    /// Returns a box around everything in the pose; empty before the first refit and without triangles.
    pub fn whole(&self) -> AxisBox {
        self.boxes.first().map_or(AxisBox::EMPTY, |(bounds, _)| *bounds)
    }

    /// Returns the nearest hit of `ray` on the mesh; of two equally near hits, the one whose triangle comes first in
    /// the file. The same result as [`super::ray_open`]. `None` when nothing is hit. Allocates nothing.
    #[doc(alias = "raycast")]
    pub fn ray(&mut self, evaluator: &Evaluator, ray: &Ray, settings: &HitSettings) -> Option<Hit> {
        let best = self.search_ray(evaluator, ray, settings, false)?;
        Some(complete(evaluator, &best))
    }

    /// Returns whether `ray` hits the mesh anywhere. Stops at the first hit it finds, so it is faster than
    /// [`Self::ray`]. Allocates nothing.
    pub fn any(&mut self, evaluator: &Evaluator, ray: &Ray, settings: &HitSettings) -> bool {
        self.search_ray(evaluator, ray, settings, true).is_some()
    }

    /// Returns the point of the mesh nearest to `center`, at most `radius` scene units away; of two equally near
    /// points, the one whose triangle comes first in the file. The same result as [`super::sphere_open`]. `None` when
    /// nothing is within the radius. Allocates nothing.
    pub fn sphere(&mut self, evaluator: &Evaluator, center: Vec3, radius: f32) -> Option<Hit> {
        let best = self.search_sphere(evaluator, SphereSearch::of(center, radius)?, None)?;
        Some(complete(evaluator, &best))
    }

    /// Returns the distance from `center` to the nearest point of instance number `instance`, where triangles without
    /// area count as the lines and points that they are. `None` where the instance has no triangle.
    pub(crate) fn distance_to_instance(
        &mut self,
        evaluator: &Evaluator,
        center: Vec3,
        instance: u32,
    ) -> Option<f64> {
        let search = SphereSearch { flat: true, ..SphereSearch::of(center, f32::INFINITY)? };
        self.search_sphere(evaluator, search, Some(instance)).map(|best| best.distance)
    }

    /// Returns the nearest point, of one instance or of all.
    fn search_sphere(
        &mut self,
        evaluator: &Evaluator,
        mut search: SphereSearch,
        instance: Option<u32>,
    ) -> Option<Candidate> {
        let pad = self.pad(search.center);
        self.start(|bounds| distance_to(search.center, bounds));
        while let Some((node, distance)) = self.stack.pop() {
            let (part, of, _) = self.tree.parts_of[node as usize];
            let other = instance.is_some_and(|instance| part != MIXED && instance != of);
            if other || distance > search.limit() * NEAR_TIE + pad {
                continue;
            }
            match self.tree.parts().nodes[node as usize] {
                HitNode::Inner(children) => {
                    self.push(evaluator, node, children, |bounds| distance_to(search.center, bounds))
                }
                HitNode::Leaf(leaf) => {
                    self.for_each_triangle(evaluator, leaf, |primitive, movement, address, corners| {
                        search.test(primitive, movement, address, corners);
                        true
                    });
                }
            }
        }
        search.best
    }

    /// Returns the nearest hit, or with `any` the first one found.
    fn search_ray(
        &mut self,
        evaluator: &Evaluator,
        ray: &Ray,
        settings: &HitSettings,
        any: bool,
    ) -> Option<Candidate> {
        let line = UnitRay::of(ray)?;
        let slabs = Slabs { line, inverse: inverse(line.direction), pad: self.pad(line.origin) };
        let mut search = RaySearch { line, settings: *settings, best: None };
        self.start(|bounds| slabs.entry(bounds));
        while let Some((node, distance)) = self.stack.pop() {
            // Equal distances are visited: the triangle earlier in the file may be there. False where the limit is NaN.
            let within = distance <= search.limit() * NEAR_TIE;
            if !within {
                continue;
            }
            match self.tree.parts().nodes[node as usize] {
                HitNode::Inner(children) => {
                    self.push(evaluator, node, children, |bounds| slabs.entry(bounds))
                }
                HitNode::Leaf(leaf) => {
                    self.for_each_triangle(evaluator, leaf, |primitive, movement, address, corners| {
                        !(search.test(primitive, movement, address, corners) && any)
                    });
                    if any && search.best.is_some() {
                        break;
                    }
                }
            }
        }
        search.best
    }

    /// Returns [`PAD`] times the largest number of the query and of the boxes.
    fn pad(&self, point: DVec3) -> f64 {
        let whole = self.whole();
        let largest = if whole.is_empty() { 0.0 } else { whole.min.abs().max(whole.max.abs()).max_element() };
        (f64::from(largest) + point.abs().max_element()) * PAD
    }

    /// Starts at the root, unless `measure` returns `None` for its box.
    fn start(&mut self, measure: impl Fn(&AxisBox) -> Option<f64>) {
        self.stack.clear();
        if let Some(distance) = self.boxes.first().and_then(|(bounds, _)| measure(bounds)) {
            self.stack.push((0, distance));
        }
    }

    /// Pushes those of the two children of `node` that are met, the nearer to be visited first.
    fn push(
        &mut self,
        evaluator: &Evaluator,
        node: u32,
        [left, right]: [u32; 2],
        measure: impl Fn(&AxisBox) -> Option<f64>,
    ) {
        let (of_left, of_right) = (self.fit(evaluator, left), self.fit(evaluator, right));
        // The union of the children is often smaller than the box, which helps the next query.
        let below = of_left.union(of_right);
        let own = &mut self.boxes[node as usize].0;
        *own = AxisBox { min: own.min.max(below.min), max: own.max.min(below.max) };
        match (measure(&of_left), measure(&of_right)) {
            (Some(a), Some(b)) if a <= b => self.stack.extend([(right, b), (left, a)]),
            (Some(a), Some(b)) => self.stack.extend([(left, a), (right, b)]),
            (Some(a), None) => self.stack.push((left, a)),
            (None, Some(b)) => self.stack.push((right, b)),
            (None, None) => {}
        }
    }

    /// Calls `visit` with the triangles of a leaf, skinned, until it returns `false`.
    fn for_each_triangle(
        &mut self,
        evaluator: &Evaluator,
        leaf: u32,
        mut visit: impl FnMut(&Primitive, Movement<'_>, TriangleAddress, [Vec3; 3]) -> bool,
    ) {
        let of = self.tree.parts().leaves[leaf as usize];
        let (instance, index) = (of.instance as usize, of.primitive as usize);
        let Some(movement) = evaluator.movement(instance, index) else { return };
        let primitive = &evaluator.primitives(instance)[index];
        let first = self.tree.first_vertex[leaf as usize] as usize;
        let end = self.tree.first_vertex[leaf as usize + 1] as usize;
        if std::mem::replace(&mut self.skinned[leaf as usize], self.now) != self.now {
            let weights = evaluator.morph_weights(instance);
            for (position, &vertex) in
                self.positions[first..end].iter_mut().zip(&self.tree.vertices[first..end])
            {
                *position =
                    skin_position(primitive, movement, weights, vertex as usize).unwrap_or(Vec3::ZERO);
            }
        }
        for at in of.first as usize..(of.first + of.count) as usize {
            let corners = self.tree.corners[at].map(|corner| self.positions[first + usize::from(corner)]);
            let triangle = self.tree.parts().triangles[at];
            let address = TriangleAddress { instance: of.instance, primitive: of.primitive, triangle };
            if !visit(primitive, movement, address, corners) {
                return;
            }
        }
    }
}

/// Returns the reciprocal of each number; for zero a huge finite number, whose product with any distance but zero is
/// huge too.
fn inverse(direction: DVec3) -> DVec3 {
    // Not infinite: its product with zero must stay zero.
    const LARGEST: f64 = 1e300;
    (1.0 / direction).clamp(DVec3::splat(-LARGEST), DVec3::splat(LARGEST))
}

/// A ray prepared for tests against many boxes.
struct Slabs {
    line: UnitRay,
    inverse: DVec3,
    pad: f64,
}

impl Slabs {
    /// Returns the distance at which the ray enters the box, not negative; `None` where it misses (the slab test, Kay
    /// and Kajiya 1986).
    fn entry(&self, bounds: &AxisBox) -> Option<f64> {
        if bounds.is_empty() {
            return None;
        }
        let a = (bounds.min.as_dvec3() - self.pad - self.line.origin) * self.inverse;
        let b = (bounds.max.as_dvec3() + self.pad - self.line.origin) * self.inverse;
        let near = a.min(b).max_element().max(0.0);
        let far = a.max(b).min_element();
        (near <= far * NEAR_TIE).then_some(near)
    }
}

/// Returns the distance from `point` to the box, zero within; `None` for an empty one.
fn distance_to(point: DVec3, bounds: &AxisBox) -> Option<f64> {
    let nearest = point.max(bounds.min.as_dvec3()).min(bounds.max.as_dvec3());
    (!bounds.is_empty()).then(|| point.distance(nearest))
}
