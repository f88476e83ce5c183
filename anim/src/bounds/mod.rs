//! Bounds of a model in a pose: an axis-aligned box and a sphere (thesis §3.1.3, `GetBoundingSphere`).
//!
//! Both are measured on the vertices as they are skinned in that pose, so they contain every vertex and nothing is
//! estimated. A model without vertices is measured on the origins of its bones; a model with neither has a box and
//! sphere of size zero at the origin. A model whose vertices are too many to be measured, such as a mesh in ten thousand
//! nodes, gets the bounds of [`BoneBoxes`]: [`MEASURED_STEPS`](crate::evaluator::MEASURED_STEPS) is the limit.
//!
//! Measuring every vertex costs as much as skinning them. Where that is too much, [`BoneBoxes`] keeps one box per bone
//! and computes bounds of a pose from those alone: never too small, slightly too large.

mod axis_box;
mod bones;
mod pose;
pub(crate) mod reach;
pub(crate) mod reach_builder;
mod sphere;

pub use axis_box::AxisBox;
pub use bones::BoneBoxes;
pub use pose::bounds_of_pose;
pub use sphere::Sphere;

use glam::{Mat4, Vec3};

/// An axis-aligned box and a sphere, each around the same points; never NaN.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// The smallest coordinate along each axis.
    pub min: Vec3,
    /// The largest coordinate along each axis.
    pub max: Vec3,
    /// Sphere that contains every point; its center need not be that of the box.
    pub sphere: Sphere,
}

impl Bounds {
    /// Returns the bounds of all `points`; NaN and infinite ones are left out. Without any: size zero, at the origin.
    pub fn of_points(points: &[Vec3]) -> Self {
        let mut finite = points.iter().copied().filter(|point| point.is_finite());
        let Some(first) = finite.next() else { return Self::default() };
        let (min, max) = finite.fold((first, first), |(min, max), point| (min.min(point), max.max(point)));
        Self { min, max, sphere: Sphere::of_points(points, min, max) }
    }

    /// Returns the center of the box.
    pub fn center(&self) -> Vec3 {
        // Halved first: the sum of two large numbers may overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Returns whether `point` is inside the box, the faces included.
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }
}

/// Returns the bounds of the origins of bones: for a skeleton without geometry.
///
/// `to_root` are the relative poses: bone space → scene space.
pub fn bounds_of_bones(to_root: &[Mat4]) -> Bounds {
    let origins: Vec<Vec3> = to_root.iter().map(|to_root| to_root.w_axis.truncate()).collect();
    Bounds::of_points(&origins)
}
