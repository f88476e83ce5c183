//! The cost of a collapse: how far the surface moves, and how differently it is skinned afterwards.

use super::surface::Surface;
use crate::data::{Influence, MAX_INFLUENCES};
use glam::{DMat3, DVec3, Vec3};

/// Weight of borders relative to planes of triangles: there is nothing beyond a border that would hide a gap.
const BORDER: f64 = 10.0;

/// Weight of seams, the same as of triangles.
const SEAM: f64 = 1.0;

/// Weight of the squared length, so that of two otherwise equal collapses the shorter is chosen.
const LENGTH: f64 = 1e-6;

/// Sum of squared distances to planes, each times an area (Garland and Heckbert 1997).
///
/// ```text
/// plane: n · p + d = 0, n of unit length      squared distance = (n · p + d)²
/// sum of weight * squared distance = p · A p + 2 b · p + c
/// A = Σ weight * n nᵀ      b = Σ weight * d n      c = Σ weight * d²
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
    /// Sum of the areas of triangles alone.
    pub(super) area: f64,
}

impl Quadric {
    /// The empty sum.
    pub(super) const ZERO: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0, area: 0.0 };

    /// Returns the quadric of the plane through `point` with the unit normal `normal`.
    pub(super) fn plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let d = -normal.dot(point);
        let a = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z) * weight;
        Self { a, b: normal * (d * weight), c: d * d * weight, area: 0.0 }
    }

    /// Adds another sum.
    pub(super) fn add(&mut self, other: &Self) {
        self.a += other.a;
        self.b += other.b;
        self.c += other.c;
        self.area += other.area;
    }

    /// Returns the sum at `point`; not negative.
    pub(super) fn at(&self, point: DVec3) -> f64 {
        (point.dot(self.a * point) + 2.0 * self.b.dot(point) + self.c).max(0.0)
    }
}

/// Returns the quadrics of every place, one list per pose.
pub(super) fn quadrics(surface: &Surface<'_>) -> Vec<Vec<Quadric>> {
    surface.poses.iter().map(|positions| quadrics_of(surface, positions)).collect()
}

/// Returns the quadric of every place in one pose: its triangles, and planes perpendicular to borders and seams that
/// keep those in place.
fn quadrics_of(surface: &Surface<'_>, positions: &[DVec3]) -> Vec<Quadric> {
    let mut quadrics = vec![Quadric::ZERO; surface.place.len()];
    // One entry per triangle of each edge: places in ascending order, then the sides, then the direction of travel.
    let mut edges: Vec<([u32; 2], [u32; 2], DVec3)> = Vec::new();
    for corners in surface.triangles.iter().flatten() {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let double = (b - a).cross(c - a);
        let length = double.length();
        let normal = if length > 0.0 { double / length } else { DVec3::ZERO };
        let area = length * 0.5;
        let mut quadric = Quadric::plane(normal, a, area);
        quadric.area = area;
        let places = surface.places(*corners);
        places.iter().for_each(|&place| quadrics[place as usize].add(&quadric));
        for at in 0..3 {
            let pair = [corners[at], corners[(at + 1) % 3]];
            let (mut places, mut sides) = (
                pair.map(|corner| surface.place[corner as usize]),
                pair.map(|corner| surface.side[corner as usize]),
            );
            if places[0] > places[1] {
                places.reverse();
                sides.reverse();
            }
            edges.push((places, sides, normal));
        }
    }
    edges.sort_by_key(|edge| (edge.0, edge.1));
    for edge in edges.chunk_by(|a, b| a.0 == b.0) {
        let weight = match edge {
            [_] => BORDER,
            [a, .., b] if a.1 != b.1 => SEAM,
            _ => continue,
        };
        let [a, b] = edge[0].0;
        let (from, to) = (positions[a as usize], positions[b as usize]);
        for (.., normal) in edge {
            let upright = (to - from).cross(*normal).normalize_or_zero();
            let quadric = Quadric::plane(upright, from, weight * from.distance_squared(to));
            quadrics[a as usize].add(&quadric);
            quadrics[b as usize].add(&quadric);
        }
    }
    quadrics
}

/// Returns half the sum of the differences of weights by joint: 0 where two vertices have equal influences, 1 where
/// they have no bone in common.
fn skin_difference(surface: &Surface<'_>, a: u32, b: u32) -> f64 {
    let vertices = &surface.primitive.vertices;
    // Valid vertices have no more influences; the limit bounds the time that invalid ones take.
    let [of_a, of_b] = [a, b].map(|vertex| {
        let list = vertices.influences_of(vertex as usize);
        &list[..list.len().min(MAX_INFLUENCES)]
    });
    let weight = |list: &[Influence], joint: u16| -> f64 {
        let own = list.iter().filter(|influence| influence.joint == joint);
        own.map(|influence| f64::from(influence.weight)).sum()
    };
    let mut sum = 0.0;
    for (at, influence) in of_a.iter().enumerate() {
        // A joint that is listed twice counts once.
        if of_a[..at].iter().all(|other| other.joint != influence.joint) {
            sum += (weight(of_a, influence.joint) - weight(of_b, influence.joint)).abs();
        }
    }
    for (at, influence) in of_b.iter().enumerate() {
        let new = of_b[..at].iter().chain(of_a).all(|other| other.joint != influence.joint);
        sum += if new { weight(of_b, influence.joint).abs() } else { 0.0 };
    }
    (sum * 0.5).min(1.0)
}

/// Returns the cost of moving the place `from` onto `onto`; not finite where it cannot be computed.
///
/// ```text
/// mean over poses of (Q_from + Q_onto)(p_onto)
///     + area * length² * ((skin * difference)² + 1e-6) + area * Σ |morph difference|²
/// ```
///
/// Because of the mean over poses, the shape in motion determines the cost (Mohr and Gleicher 2003). `area` is that
/// around `from`, `length` that of the edge, both as stored; `difference` (0..1) is how differently bones move its
/// ends: the poses cover the given takes, and this term covers other ones.
pub(super) fn cost(surface: &Surface<'_>, quadrics: &[Vec<Quadric>], skin: f64, from: u32, onto: u32) -> f64 {
    let (from_at, onto_at) = (from as usize, onto as usize);
    let mut moved = 0.0;
    for (positions, quadrics) in surface.poses.iter().zip(quadrics) {
        moved += quadrics[from_at].at(positions[onto_at]) + quadrics[onto_at].at(positions[onto_at]);
    }
    let stored = &surface.poses[0];
    let length_squared = stored[from_at].distance_squared(stored[onto_at]);
    let bent = skin * skin_difference(surface, from, onto);
    let mut morph = 0.0;
    for &target in &surface.targets {
        let differences = &surface.primitive.morph_targets[target as usize].positions;
        let of = |place: usize| differences.get(place).copied().unwrap_or(Vec3::ZERO).as_dvec3();
        morph += (of(from_at) - of(onto_at)).length_squared() * surface.scale * surface.scale;
    }
    let area = quadrics[0][from_at].area;
    moved / quadrics.len() as f64 + area * (length_squared * (bent * bent + LENGTH) + morph)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadric_is_the_squared_distance_to_its_planes() {
        let point = DVec3::new(1.0, 2.0, 3.0);
        let mut quadric = Quadric::plane(DVec3::Y, point, 2.0);
        quadric.add(&Quadric::plane(DVec3::X, DVec3::ZERO, 1.0));
        assert_eq!(quadric.at(DVec3::new(0.0, 2.0, 9.0)), 0.0);
        assert!((quadric.at(DVec3::new(3.0, 5.0, 0.0)) - (2.0 * 9.0 + 9.0)).abs() < 1e-12);
    }
}
