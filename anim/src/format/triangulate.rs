//! Polygons become triangles: of a convex polygon a fan, of any other one ear after ear is cut off in the plane of the polygon.

use glam::{DVec2, DVec3, Vec3};
use std::cmp::Ordering;

/// Steps that any file may need for its polygons: less than half a second. One with 6,000 corners that bend inwards half of the
/// time needs about all.
const STEPS: u64 = 20_000_000;

/// Further steps for each corner.
const STEPS_PER_CORNER: u64 = 100;

/// How a polygon was divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Division {
    /// The triangles cover the polygon.
    Exact,
    /// The polygon crosses itself or is too large: the triangles may overlap.
    Approximate,
    /// The polygon has no area; there is no triangle.
    Degenerate,
}

/// Divides polygons. Its lists are used again for the next polygon.
pub(super) struct Triangulator {
    /// Number of steps that are left for all polygons of a file.
    steps: u64,
    points: Vec<DVec2>,
    next: Vec<u32>,
    previous: Vec<u32>,
    /// Corners at which the polygon bends inwards.
    reflex: Vec<u32>,
}

impl Triangulator {
    /// Returns one for a file whose polygons have this number of corners in all.
    pub(super) fn new(corners: usize) -> Self {
        let steps = (corners as u64).saturating_mul(STEPS_PER_CORNER).saturating_add(STEPS);
        Self { steps, points: Vec::new(), next: Vec::new(), previous: Vec::new(), reflex: Vec::new() }
    }

    /// Calls `triangle` with three numbers of corners for each triangle, in the sense of the polygon. `normal` is that of
    /// the polygon, from [`normal`].
    pub(super) fn divide(
        &mut self,
        corners: &[Vec3],
        normal: DVec3,
        mut triangle: impl FnMut([u32; 3]),
    ) -> Division {
        let area = normal.length();
        if corners.len() < 3 || area == 0.0 || !area.is_finite() {
            return Division::Degenerate;
        }
        if corners.len() == 3 {
            triangle([0, 1, 2]);
            return Division::Exact;
        }
        self.project(corners, normal / area);
        if self.is_convex() {
            for corner in 1..corners.len() as u32 - 1 {
                triangle([0, corner, corner + 1]);
            }
            return Division::Exact;
        }
        self.cut_ears(triangle)
    }

    /// Projects the corners onto the plane in which the polygon has most of its area.
    fn project(&mut self, corners: &[Vec3], normal: DVec3) {
        let size = normal.abs();
        let (x, y, side) = if size.x >= size.y && size.x >= size.z {
            (1, 2, normal.x)
        } else if size.y >= size.z {
            (2, 0, normal.y)
        } else {
            (0, 1, normal.z)
        };
        let sign = if side < 0.0 { -1.0 } else { 1.0 };
        self.points.clear();
        self.points.extend(corners.iter().map(|corner| {
            let corner = corner.as_dvec3();
            DVec2::new(corner[x] * sign, corner[y])
        }));
    }

    /// Returns whether the polygon bends to the left at every corner, and goes around once.
    fn is_convex(&self) -> bool {
        let count = self.points.len();
        let at = |index: usize| self.points[index % count];
        let mut directions = 0;
        for index in 0..count {
            let (a, b, c) = (at(index), at(index + 1), at(index + 2));
            if (b - a).perp_dot(c - b) <= 0.0 {
                return false;
            }
            // The horizontal direction changes twice on a way around once.
            directions += usize::from((b.x > a.x) != (c.x > b.x));
        }
        directions <= 2
    }

    fn cut_ears(&mut self, mut triangle: impl FnMut([u32; 3])) -> Division {
        let count = self.points.len() as u32;
        self.next.clear();
        self.next.extend((1..count).chain([0]));
        self.previous.clear();
        self.previous.extend([count - 1].into_iter().chain(0..count - 1));
        let mut reflex = std::mem::take(&mut self.reflex);
        reflex.clear();
        reflex.extend((0..count).filter(|&corner| self.bend(corner) <= 0.0));
        self.reflex = reflex;
        let (mut left, mut corner, mut since_ear) = (count, 0, 0);
        let mut division = Division::Exact;
        while left > 3 {
            // Without any ear, first corners on a line and then any others are removed.
            let is_ear = self.steps > 0
                && match since_ear.cmp(&left) {
                    Ordering::Less => self.is_ear(corner),
                    Ordering::Equal | Ordering::Greater => self.bend(corner) == 0.0,
                };
            let is_forced = self.steps == 0 || since_ear > 2 * left;
            if !is_ear && !is_forced {
                corner = self.next[corner as usize];
                since_ear += 1;
                continue;
            }
            let (before, after) = (self.previous[corner as usize], self.next[corner as usize]);
            if self.bend(corner) != 0.0 {
                triangle([before, corner, after]);
                if !is_ear {
                    division = Division::Approximate;
                }
            }
            (self.next[before as usize], self.previous[after as usize]) = (after, before);
            self.previous[corner as usize] = corner;
            left -= 1;
            since_ear = 0;
            // Not the neighbor, so that triangles do not all meet in one corner.
            corner = self.next[after as usize];
        }
        let (before, after) = (self.previous[corner as usize], self.next[corner as usize]);
        if self.bend(corner) != 0.0 {
            triangle([before, corner, after]);
        }
        division
    }

    /// Returns twice the area of the triangle at a corner, negative where the polygon bends inwards.
    fn bend(&self, corner: u32) -> f64 {
        let [a, b, c] = self.ear(corner);
        (b - a).perp_dot(c - a)
    }

    fn ear(&self, corner: u32) -> [DVec2; 3] {
        let (before, after) = (self.previous[corner as usize], self.next[corner as usize]);
        [before, corner, after].map(|corner| self.points[corner as usize])
    }

    /// Returns whether the triangle at a corner is inside of the polygon.
    fn is_ear(&mut self, corner: u32) -> bool {
        let [a, b, c] = self.ear(corner);
        let bend = (b - a).perp_dot(c - a);
        self.steps = self.steps.saturating_sub(1);
        if bend <= 0.0 {
            return false;
        }
        self.steps = self.steps.saturating_sub(self.reflex.len() as u64);
        // Corners that were cut off, or that bend outwards by now, can no longer be inside.
        let mut reflex = std::mem::take(&mut self.reflex);
        reflex.retain(|&other| self.previous[other as usize] != other && self.bend(other) <= 0.0);
        let is_inside = |&other: &u32| {
            let point = self.points[other as usize];
            // A corner at the same place is where a hole is joined to the outline.
            let is_same = point == a || point == b || point == c;
            !is_same
                && (b - a).perp_dot(point - a) >= 0.0
                && (c - b).perp_dot(point - b) >= 0.0
                && (a - c).perp_dot(point - c) >= 0.0
        };
        let is_ear = !reflex.iter().any(is_inside);
        self.reflex = reflex;
        is_ear
    }
}

/// Returns the normal of a polygon, as long as twice its area (Newell's method).
pub(super) fn normal(corners: &[Vec3]) -> DVec3 {
    let [first, second, others @ ..] = corners else { return DVec3::ZERO };
    // Relative to a corner: far from the origin nothing is lost.
    let edge = |corner: &Vec3| corner.as_dvec3() - first.as_dvec3();
    let (mut sum, mut before) = (DVec3::ZERO, edge(second));
    for corner in others {
        let next = edge(corner);
        sum += before.cross(next);
        before = next;
    }
    sum + before.cross(edge(first))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn divided(points: &[(f32, f32)]) -> (Division, Vec<[u32; 3]>, f64) {
        let corners: Vec<Vec3> = points.iter().map(|&(x, y)| Vec3::new(x, 0.5 * x, y)).collect();
        let mut triangles = Vec::new();
        let division = Triangulator::new(corners.len())
            .divide(&corners, normal(&corners), |triangle| triangles.push(triangle));
        let area = |triangle: &[u32; 3]| {
            let corners = triangle.map(|corner| corners[corner as usize]);
            normal(&corners).dot(normal(&corners)).sqrt()
        };
        let sum = triangles.iter().map(area).sum::<f64>() / normal(&corners).length();
        (division, triangles, sum)
    }

    #[test]
    fn concave_polygons_are_covered_exactly() {
        let star: Vec<(f32, f32)> = (0..20)
            .map(|corner| {
                let (angle, radius) =
                    (f64::from(corner) * 0.314_159_265, if corner % 2 == 0 { 3.0 } else { 1.0 });
                ((libm::cos(angle) * radius) as f32, (libm::sin(angle) * radius) as f32)
            })
            .collect();
        let arrow = vec![(0.0, 0.0), (4.0, 4.0), (0.0, 8.0), (1.0, 4.0)];
        let comb: Vec<(f32, f32)> = (0..41)
            .map(|tooth| (tooth as f32, if tooth % 2 == 0 { 0.0 } else { 9.0 }))
            .chain([(40.0, -1.0), (0.0, -1.0)])
            .collect();
        for polygon in [star, arrow, comb] {
            for reversed in [false, true] {
                let mut polygon = polygon.clone();
                if reversed {
                    polygon.reverse();
                }
                for start in 0..polygon.len() {
                    polygon.rotate_left(1);
                    let (division, triangles, area) = divided(&polygon);
                    assert_eq!((division, triangles.len()), (Division::Exact, polygon.len() - 2), "{start}");
                    assert!((area - 1.0).abs() < 1e-6, "{area}");
                }
            }
        }
    }

    #[test]
    fn a_hole_that_is_joined_to_the_outline_stays_a_hole() {
        let square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0), (0.0, 0.0)];
        let hole = [(3.0, 3.0), (3.0, 6.0), (6.0, 6.0), (6.0, 3.0), (3.0, 3.0)];
        let (division, triangles, area) = divided(&[square, hole].concat());
        assert_eq!((division, triangles.len()), (Division::Exact, 8));
        assert!((area - 1.0).abs() < 1e-6, "{area}");
    }

    #[test]
    fn no_triangle_is_without_area() {
        let (division, triangles, area) =
            divided(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
        assert_eq!((division, triangles.len()), (Division::Exact, 3));
        assert!((area - 1.0).abs() < 1e-6);
        for polygon in [
            &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.0)][..],
            &[(1.0, 1.0); 5],
            &[(0.0, 0.0), (1.0, 1.0)],
            &[],
        ] {
            assert_eq!(divided(polygon).0, Division::Degenerate);
        }
    }

    #[test]
    fn the_steps_for_huge_polygons_are_bounded() {
        let count = 60_000;
        let comb: Vec<(f32, f32)> = (0..count)
            .map(|tooth| (tooth as f32, if tooth % 2 == 0 { 0.0 } else { 9.0 }))
            .chain([(count as f32, -1.0), (0.0, -1.0)])
            .collect();
        let (_, triangles, _) = divided(&comb);
        assert!(triangles.len() <= comb.len() - 2 && triangles.len() > count / 2);
    }
}
