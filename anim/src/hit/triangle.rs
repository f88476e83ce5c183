//! One triangle against a ray and against a point: the formulas.

use super::Ray;
use glam::{DVec3, Vec3};

/// A triangle whose edges enclose an angle with a smaller sine counts as without area.
const DEGENERATE: f64 = 1e-12;

/// A ray that rises less over a plane, per unit of its length, counts as parallel. With less, the distance would not be
/// known to more than a few digits.
const PARALLEL: f64 = 1e-6;

/// The intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Scene units from the ray's origin, not negative.
    pub distance: f64,
    /// Barycentric coordinates: shares of the three corners, not negative, together 1.
    pub barycentric: DVec3,
    /// Whether the ray meets the side from which the corners run counter-clockwise.
    pub counter_clockwise: bool,
}

/// A ray in `f64` whose direction has unit length.
#[derive(Clone, Copy, Debug)]
pub(super) struct UnitRay {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
}

impl UnitRay {
    /// Converts a ray. `None` where it has no direction, or a number is not finite.
    pub(super) fn of(ray: &Ray) -> Option<Self> {
        let direction = ray.direction.as_dvec3();
        let length = direction.length();
        let valid = ray.origin.is_finite() && length.is_finite() && length > 0.0;
        valid.then(|| Self { origin: ray.origin.as_dvec3(), direction: direction / length })
    }
}

/// Returns the intersection of `ray` with the triangle of `corners` (Möller and Trumbore 1997).
///
/// ```text
/// origin + t * direction = a + u * (b - a) + v * (c - a)            three equations, solved by Cramer's rule
///
/// e1 = b - a     e2 = c - a     p = direction × e2     s = origin - a     q = s × e1
/// det = e1 · p   u = s · p / det     v = direction · q / det     t = e2 · q / det
/// a hit where  0 ≤ u,  0 ≤ v,  u + v ≤ 1,  0 ≤ t
/// ```
///
/// The edges are included. `None` also where the triangle has no area, the ray is in its plane, or a number is not
/// finite.
pub fn crossing(ray: &Ray, corners: [Vec3; 3]) -> Option<Crossing> {
    meet(&UnitRay::of(ray)?, corners)
}

/// As [`crossing`], for a prepared ray.
pub(super) fn meet(line: &UnitRay, corners: [Vec3; 3]) -> Option<Crossing> {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let (e1, e2) = (b - a, c - a);
    let p = line.direction.cross(e2);
    let det = e1.dot(p);
    let s = line.origin - a;
    let u = s.dot(p) / det;
    // Most triangles are rejected here, and NaN too.
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = s.cross(e1);
    let v = line.direction.dot(q) / det;
    let distance = e2.dot(q) / det;
    if !(v >= 0.0 && u + v <= 1.0 && distance >= 0.0 && distance.is_finite()) {
        return None;
    }
    let area = normal(e1, e2)?.1;
    let steep = det.abs() > PARALLEL * area;
    let barycentric = DVec3::new((1.0 - u - v).max(0.0), u, v);
    steep.then_some(Crossing { distance, barycentric, counter_clockwise: det > 0.0 })
}

/// Returns the unit normal of two edges, and its length before normalization (twice the area); `None` without area.
fn normal(e1: DVec3, e2: DVec3) -> Option<(DVec3, f64)> {
    let normal = e1.cross(e2);
    let length = normal.length();
    // False where a number is NaN.
    let valid = length > DEGENERATE * (e1.length() * e2.length()) && length.is_finite();
    valid.then(|| (normal / length, length))
}

/// Returns the unit normal of a triangle, on the side from which its corners run counter-clockwise; `None` without
/// area.
pub(super) fn normal_of(corners: [Vec3; 3]) -> Option<DVec3> {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    normal(b - a, c - a).map(|(normal, _)| normal)
}

/// Returns the point of the triangle of `corners` that is nearest to `point`: its barycentric coordinates, and the
/// distance (Ericson 2005, §5.1.5).
///
/// The plane around the triangle has seven regions, which the signs of dot products distinguish: over a corner the
/// corner is nearest, over an edge the foot on it, over the inside the foot on the plane. `None` where the triangle has
/// no area or a number is not finite.
pub fn nearest_on_triangle(point: DVec3, corners: [Vec3; 3]) -> Option<(DVec3, f64)> {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    normal(b - a, c - a)?;
    let shares = nearest_shares(point, a, b, c);
    let distance = point.distance(a * shares.x + b * shares.y + c * shares.z);
    distance.is_finite().then_some((shares, distance))
}

/// As [`nearest_on_triangle`] for a triangle without area, which is a line or a point: the nearest of its three edges.
pub(super) fn nearest_on_flat(point: DVec3, corners: [Vec3; 3]) -> Option<(DVec3, f64)> {
    let corners = corners.map(|corner| corner.as_dvec3());
    let mut nearest: Option<(DVec3, f64)> = None;
    for edge in 0..3 {
        let next = (edge + 1) % 3;
        let (from, along) = (corners[edge], corners[next] - corners[edge]);
        let part = (point - from).dot(along) / along.length_squared();
        let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
        let distance = point.distance(from + along * part);
        if distance.is_finite() && nearest.is_none_or(|(_, least)| distance < least) {
            let mut shares = [0.0; 3];
            (shares[edge], shares[next]) = (1.0 - part, part);
            nearest = Some((DVec3::from_array(shares), distance));
        }
    }
    nearest
}

fn nearest_shares(point: DVec3, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac, ap, bp, cp) = (b - a, c - a, point - a, point - b, point - c);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return DVec3::X;
    }
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return DVec3::Y;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let part = d1 / (d1 - d3);
        return DVec3::new(1.0 - part, part, 0.0);
    }
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return DVec3::Z;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let part = d2 / (d2 - d6);
        return DVec3::new(1.0 - part, 0.0, part);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return DVec3::new(0.0, 1.0 - part, part);
    }
    let sum = va + vb + vc;
    DVec3::new(va / sum, vb / sum, vc / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    fn down(x: f32, y: f32) -> Ray {
        Ray { origin: Vec3::new(x, y, 2.0), direction: Vec3::NEG_Z * 3.0 }
    }

    #[test]
    fn a_ray_hits_a_triangle_inside_and_on_its_border_and_nowhere_else() {
        let hit = crossing(&down(0.25, 0.5), CORNERS).unwrap();
        assert_eq!((hit.distance, hit.barycentric), (2.0, DVec3::new(0.25, 0.25, 0.5)));
        assert!(hit.counter_clockwise);
        let [a, b, c] = CORNERS;
        assert!(!crossing(&down(0.25, 0.5), [a, c, b]).unwrap().counter_clockwise);
        // Edges and corners are included, points outside are not.
        assert!(crossing(&down(0.5, 0.5), CORNERS).is_some() && crossing(&down(0.0, 0.0), CORNERS).is_some());
        assert_eq!(crossing(&down(0.6, 0.6), CORNERS), None);
        assert_eq!(crossing(&Ray { direction: Vec3::Z, ..down(0.2, 0.2) }, CORNERS), None);
    }

    #[test]
    fn triangles_without_area_and_numbers_that_are_not_finite_give_no_hit() {
        let ray = down(0.0, 0.0);
        for corners in [[Vec3::ZERO; 3], [Vec3::ZERO, Vec3::X, Vec3::X * 2.0], [Vec3::NAN, Vec3::X, Vec3::Y]]
        {
            assert_eq!(crossing(&ray, corners), None);
            assert_eq!(nearest_on_triangle(DVec3::ZERO, corners), None);
        }
        for direction in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            assert_eq!(crossing(&Ray { direction, ..ray }, CORNERS), None);
        }
        assert_eq!(crossing(&Ray { origin: Vec3::ZERO, direction: Vec3::X }, CORNERS), None);
        assert_eq!(nearest_on_triangle(DVec3::NAN, CORNERS), None);
    }

    #[test]
    fn each_of_the_seven_regions_around_a_triangle_has_its_own_nearest_point() {
        let nearest = |x: f64, y: f64| nearest_on_triangle(DVec3::new(x, y, 0.0), CORNERS).unwrap();
        assert_eq!(nearest(-1.0, -1.0).0, DVec3::X);
        assert_eq!(nearest(3.0, 0.0), (DVec3::Y, 2.0));
        assert_eq!(nearest(0.0, 4.0), (DVec3::Z, 3.0));
        assert_eq!(nearest(0.5, -1.0), (DVec3::new(0.5, 0.5, 0.0), 1.0));
        assert_eq!(nearest(-2.0, 0.25), (DVec3::new(0.75, 0.0, 0.25), 2.0));
        assert_eq!(nearest(1.0, 1.0).0, DVec3::new(0.0, 0.5, 0.5));
        assert_eq!(nearest(0.25, 0.25), (DVec3::new(0.5, 0.25, 0.25), 0.0));
    }
}
