//! Bounding spheres.

use glam::{DVec3, Vec3};

/// A sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sphere {
    /// The center.
    pub center: Vec3,
    /// The radius: not negative, at most the largest `f32`.
    pub radius: f32,
}

impl Sphere {
    /// Returns a sphere around those of `points` that are finite; `min` and `max` are their smallest and largest
    /// coordinates.
    ///
    /// It is the smaller of two spheres: one about the center of the box, and Ritter's (start with the two points
    /// furthest apart along an axis, then grow just enough for each point outside). Its radius is usually at most a
    /// fifth larger than the smallest possible one. Computed in f64, so that neither squares nor rounding lose a point.
    pub(super) fn of_points(points: &[Vec3], min: Vec3, max: Vec3) -> Self {
        let middle = min * 0.5 + max * 0.5;
        let around_box = Self::about(middle, points);
        let ritter = Self::about(ritter_center(points, min, max), points);
        if ritter.radius < around_box.radius { ritter } else { around_box }
    }

    /// Returns whether `point` is inside, the surface included.
    pub fn contains(&self, point: Vec3) -> bool {
        point.as_dvec3().distance(self.center.as_dvec3()) <= f64::from(self.radius)
    }

    /// Returns the smallest sphere about `center` that contains those of `points` that are finite.
    fn about(center: Vec3, points: &[Vec3]) -> Self {
        let middle = center.as_dvec3();
        let largest = finite(points).map(|point| point.distance_squared(middle)).fold(0.0, f64::max).sqrt();
        // Rounded up, so that the furthest point stays inside.
        let mut radius = largest as f32;
        if f64::from(radius) < largest {
            radius = radius.next_up();
        }
        Self { center, radius: radius.min(f32::MAX) }
    }
}

/// Returns the center that Ritter's algorithm ends with.
fn ritter_center(points: &[Vec3], min: Vec3, max: Vec3) -> Vec3 {
    let size = max.as_dvec3() - min.as_dvec3();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let at = |limit: f32| finite(points).find(|point| point[axis] == f64::from(limit));
    let (Some(low), Some(high)) = (at(min[axis]), at(max[axis])) else { return Vec3::ZERO };
    let mut center = (low + high) * 0.5;
    let mut radius = low.distance(high) * 0.5;
    for point in finite(points) {
        let distance = point.distance(center);
        if distance > radius {
            // The new sphere touches the point and the far side of the old one.
            radius = (radius + distance) * 0.5;
            center = point + (center - point) * (radius / distance);
        }
    }
    center.as_vec3()
}

/// Returns the points without NaN or infinity.
fn finite(points: &[Vec3]) -> impl Iterator<Item = DVec3> + '_ {
    points.iter().filter(|point| point.is_finite()).map(|point| point.as_dvec3())
}
