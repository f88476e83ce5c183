//! The loop: the cheapest valid collapse, again and again.

use super::cost::{Quadric, cost, quadrics};
use super::progression::{Move, Progression};
use super::surface::{MOST_AROUND, Surface};
use crate::data::Primitive;
use glam::{DVec3, Vec3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Smallest cosine between a triangle's normals before and after one step: about 78°.
const TURN: f64 = 0.2;

/// Largest number of passes over all edges: a collapse makes others possible that were rejected.
const PASSES: usize = 8;

/// Settings of [`simplify`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimplifySettings {
    /// Number of triangles at which to stop.
    pub triangles: usize,
    /// Weight of the difference in influences between the ends of an edge, 0 for none. With 1, an edge whose ends have
    /// no bone in common costs as if the surface moved by its whole length. With poses to measure in, a small weight is
    /// enough.
    pub skin: f32,
}

impl Default for SimplifySettings {
    /// Returns settings to simplify as far as possible, with the influences considered.
    fn default() -> Self {
        Self { triangles: 0, skin: 0.1 }
    }
}

/// Returns the order in which triangles of `primitive` are best removed.
///
/// `poses` are positions of all vertices in poses in which it should look good (those of
/// [`crate::evaluator::Evaluator::positions`]; a few are enough, none is allowed). Vertices for which `locked` returns
/// true stay in place. Ends when `settings.triangles` are left or nothing can be removed without tearing or turning
/// over. The rules are those of the [module](super). Total: triangles with two corners at one place, and those with
/// missing vertices, are removed in the first step; positions that are not finite stay. A `skin` that is negative or
/// not finite counts as 0. O(n log n); the same input gives the same order.
#[doc(alias("decimate", "edge collapse"))]
pub fn simplify(
    primitive: &Primitive,
    poses: &[Vec<Vec3>],
    locked: &dyn Fn(usize) -> bool,
    settings: &SimplifySettings,
) -> Progression {
    let surface = Surface::of(primitive, poses, locked);
    let skin = f64::from(settings.skin);
    let skin = if skin.is_finite() { skin.max(0.0) } else { 0.0 };
    let mut collapser = Collapser::of(surface, skin);
    for _ in 0..PASSES {
        let before = collapser.left;
        collapser.seed();
        collapser.run(settings.triangles);
        let worth_it = before - collapser.left > before / 100;
        if collapser.left <= settings.triangles || !worth_it {
            break;
        }
    }
    collapser.progression
}

/// An edge with a direction, and the cost of collapsing it.
#[derive(Clone, Copy, Debug)]
struct CollapseCandidate {
    cost: f64,
    from: u32,
    onto: u32,
    /// Versions of both ends when the cost was computed.
    versions: [u32; 2],
}

impl Ord for CollapseCandidate {
    /// Orders the cheapest candidate as the greatest. Of two equally cheap candidates, the one whose vertices come
    /// first is the greater, so that the order is always the same.
    fn cmp(&self, other: &Self) -> Ordering {
        let ends = |candidate: &Self| (candidate.from, candidate.onto);
        other.cost.total_cmp(&self.cost).then(ends(other).cmp(&ends(self)))
    }
}

impl PartialOrd for CollapseCandidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for CollapseCandidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for CollapseCandidate {}

/// State of the simplification.
struct Collapser<'a> {
    surface: Surface<'a>,
    /// One list per pose.
    quadrics: Vec<Vec<Quadric>>,
    skin: f64,
    /// For each place, the number of changes around it.
    versions: Vec<u32>,
    heap: BinaryHeap<CollapseCandidate>,
    /// Normals of the original triangles, of any length.
    normals: Vec<DVec3>,
    left: usize,
    progression: Progression,
    scratch: CollapseScratch,
}

/// Lists reused by every collapse.
#[derive(Default)]
struct CollapseScratch {
    /// Triangles around the place that is removed: index, corners, and whether the other place is a corner too.
    around: Vec<(u32, [u32; 3], bool)>,
    /// Places next to the one that is removed, and the number of triangles that each shares with it.
    adjacent: Vec<(u32, u32)>,
    /// Sides of the place that is removed, and the side that each becomes.
    sides: Vec<(u32, u32)>,
    /// Vertices that are removed, and the vertices they become.
    moves: Vec<(u32, u32)>,
    /// Places next to the one that stays.
    next: Vec<u32>,
}

impl<'a> Collapser<'a> {
    fn of(surface: Surface<'a>, skin: f64) -> Self {
        let left = surface.left();
        let all = surface.triangles.len();
        let gone_after =
            surface.triangles.iter().map(|corners| if corners.is_some() { u32::MAX } else { 1 }).collect();
        let normal = |corners: &Option<[u32; 3]>| {
            corners.map_or(DVec3::ZERO, |corners| normal(corners.map(|at| surface.poses[0][at as usize])))
        };
        Self {
            normals: surface.triangles.iter().map(normal).collect(),
            quadrics: quadrics(&surface),
            versions: vec![0; surface.place.len()],
            heap: BinaryHeap::new(),
            progression: Progression { moves: Vec::new(), gone_after, left: vec![all as u32] },
            scratch: CollapseScratch::default(),
            surface,
            skin,
            left,
        }
    }

    /// Pushes every edge, in both directions.
    fn seed(&mut self) {
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for corners in self.surface.triangles.iter().flatten() {
            let [a, b, c] = self.surface.places(*corners);
            edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
        }
        edges.sort_unstable();
        edges.dedup();
        self.heap.clear();
        for [a, b] in edges {
            self.push(a, b);
            self.push(b, a);
        }
    }

    fn push(&mut self, from: u32, onto: u32) {
        if self.surface.locked[from as usize] {
            return;
        }
        let cost = cost(&self.surface, &self.quadrics, self.skin, from, onto);
        if cost.is_finite() {
            let versions = [from, onto].map(|place| self.versions[place as usize]);
            self.heap.push(CollapseCandidate { cost, from, onto, versions });
        }
    }

    /// Collapses until `triangles` are left, or nothing more can be collapsed.
    fn run(&mut self, triangles: usize) {
        while self.left > triangles {
            let Some(candidate) = self.heap.pop() else { return };
            let CollapseCandidate { from, onto, versions, .. } = candidate;
            let fresh = versions == [from, onto].map(|place| self.versions[place as usize]);
            if fresh && self.can_collapse(from, onto) {
                self.collapse(from, onto);
            }
        }
    }

    /// Returns whether `from` may move onto `onto`. Leaves the lists for the collapse in the scratch memory.
    fn can_collapse(&mut self, from: u32, onto: u32) -> bool {
        let mut scratch = std::mem::take(&mut self.scratch);
        let can_collapse = self.keeps_manifold(from, onto, &mut scratch)
            && self.match_sides(from, onto, &mut scratch)
            && self.keeps_facing(from, onto, &scratch);
        self.scratch = scratch;
        can_collapse
    }

    /// Returns whether the surface stays a manifold: the link condition (Dey and others 1999), and that borders stay
    /// borders.
    fn keeps_manifold(&self, from: u32, onto: u32, scratch: &mut CollapseScratch) -> bool {
        let surface = &self.surface;
        scratch.around.clear();
        scratch.adjacent.clear();
        scratch.next.clear();
        for (triangle, corners) in surface.around(from) {
            let places = surface.places(corners);
            scratch.around.push((triangle, corners, places.contains(&onto)));
            for place in places.into_iter().filter(|&place| place != from) {
                match scratch.adjacent.iter_mut().find(|(other, _)| *other == place) {
                    Some((_, count)) => *count += 1,
                    None => scratch.adjacent.push((place, 1)),
                }
            }
        }
        let shared = scratch.around.iter().filter(|(.., shared)| *shared).count();
        let borders = scratch.adjacent.iter().filter(|(_, count)| *count == 1).count();
        let along = if borders == 0 { shared == 2 } else { borders == 2 && shared == 1 };
        if !along || shared == scratch.around.len() || scratch.adjacent.iter().any(|(_, count)| *count > 2) {
            return false;
        }
        if surface.locked[onto as usize] && surface.around(onto).take(MOST_AROUND + 1).count() > MOST_AROUND {
            return false;
        }
        let mut around_onto = 0;
        for (_, corners) in surface.around(onto) {
            around_onto += 1;
            scratch.next.extend(surface.places(corners));
        }
        let common = scratch
            .adjacent
            .iter()
            .filter(|(place, _)| *place != onto && scratch.next.contains(place))
            .count();
        if common != shared || around_onto + scratch.around.len() - 2 * shared > MOST_AROUND {
            return false;
        }
        // A triangle that would coincide with another.
        let survivors = scratch.around.iter().filter(|(.., shared)| !shared);
        survivors.into_iter().all(|(_, corners, _)| {
            let places = surface.places(*corners);
            scratch.next.chunks_exact(3).all(|other| {
                !places.iter().filter(|&&place| place != from).all(|place| other.contains(place))
            })
        })
    }

    /// Matches every side of a seam with its other side, and chooses for each vertex the vertex that it becomes: of
    /// those on that side the one with the most similar normal. Returns whether every side has a match.
    fn match_sides(&self, from: u32, onto: u32, scratch: &mut CollapseScratch) -> bool {
        let surface = &self.surface;
        let side = |vertex: u32| surface.side[vertex as usize];
        scratch.sides.clear();
        scratch.moves.clear();
        let at = |corners: &[u32; 3], place: u32| {
            corners.iter().copied().find(|&corner| surface.place[corner as usize] == place)
        };
        for (_, corners, _) in scratch.around.iter().filter(|(.., shared)| *shared) {
            let (Some(own), Some(other)) = (at(corners, from), at(corners, onto)) else { return false };
            match scratch.sides.iter().find(|(known, _)| *known == side(own)) {
                Some((_, known)) if *known != side(other) => return false,
                Some(_) => {}
                None => scratch.sides.push((side(own), side(other))),
            }
        }
        for (_, corners, _) in scratch.around.iter().filter(|(.., shared)| !shared) {
            let Some(own) = at(corners, from) else { return false };
            let Some(&(_, onto)) = scratch.sides.iter().find(|(known, _)| *known == side(own)) else {
                return false;
            };
            if scratch.moves.iter().all(|(known, _)| *known != own) {
                let Some(vertex) = self.most_similar(own, onto) else { return false };
                scratch.moves.push((own, vertex));
            }
        }
        true
    }

    /// Returns the vertex on `side` whose normal is most similar to that of `vertex`; of equally similar ones the
    /// first.
    fn most_similar(&self, vertex: u32, side: u32) -> Option<u32> {
        let normals = &self.surface.primitive.vertices.normals;
        let normal = |vertex: u32| normals.get(vertex as usize).copied().unwrap_or_default();
        let own = normal(vertex);
        let mut best: Option<(u32, f32)> = None;
        for member in self.surface.members(side) {
            let likeness = own.dot(normal(member));
            if best.is_none_or(|(_, most)| likeness > most) {
                best = Some((member, likeness));
            }
        }
        best.map(|(member, _)| member)
    }

    /// Returns whether every triangle that stays keeps its orientation, in every pose.
    fn keeps_facing(&self, from: u32, onto: u32, scratch: &CollapseScratch) -> bool {
        scratch.around.iter().filter(|(.., shared)| !shared).all(|(triangle, corners, _)| {
            let after = corners.map(|corner| {
                let moves = self.surface.place[corner as usize] == from;
                if moves { onto } else { corner }
            });
            let first = self.normals[*triangle as usize];
            self.surface.poses.iter().enumerate().all(|(pose, positions)| {
                let [before, after] =
                    [*corners, after].map(|corners| normal(corners.map(|corner| positions[corner as usize])));
                // A triangle without area has no orientation.
                let flat = if pose == 0 { first == DVec3::ZERO } else { before == DVec3::ZERO };
                flat || (after.dot(before) > TURN * after.length() * before.length()
                    && (pose != 0 || after.dot(first) > 0.0))
            })
        })
    }

    /// Moves `from` onto `onto`, with the lists of the scratch memory.
    fn collapse(&mut self, from: u32, onto: u32) {
        let step = self.progression.left.len() as u32 - 1;
        for &(triangle, corners, shared) in &self.scratch.around {
            let place = &mut self.surface.triangles[triangle as usize];
            if shared {
                *place = None;
                self.left -= 1;
                self.progression.gone_after[triangle as usize] = step + 1;
            } else {
                let moved =
                    |corner: u32| self.scratch.moves.iter().find(|one| one.0 == corner).map(|one| one.1);
                *place = Some(corners.map(|corner| moved(corner).unwrap_or(corner)));
            }
        }
        let moves = self.scratch.moves.iter().map(|&(vertex, onto)| Move { step, vertex, onto });
        self.progression.moves.extend(moves);
        self.progression.left.push(self.left as u32);
        self.surface.move_triangles(from, onto);
        for quadrics in &mut self.quadrics {
            let gone = quadrics[from as usize];
            quadrics[onto as usize].add(&gone);
        }
        self.versions[from as usize] += 1;
        self.versions[onto as usize] += 1;
        let mut next = std::mem::take(&mut self.scratch.next);
        next.clear();
        for (_, corners) in self.surface.around(onto) {
            next.extend(self.surface.places(corners));
        }
        next.sort_unstable();
        next.dedup();
        for &place in next.iter().filter(|&&place| place != onto) {
            self.push(place, onto);
            self.push(onto, place);
        }
        self.scratch.next = next;
    }
}

/// Returns the normal with twice the area as its length.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
