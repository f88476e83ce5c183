//! How much room a model takes in a pose: a box along the axes and a sphere (thesis §3.1.3, `GetBoundingSphere`).
//!
//! Both are measured on the vertices as they are skinned in that pose, so they hold every vertex and nothing is
//! guessed. A model without vertices is measured on the origins of its bones; a model with neither has the box and
//! sphere of no size in the origin.
//!
//! Measuring every vertex costs as much as skinning them. Where that is too much, [`BoneBoxes`] keeps one box a bone
//! and finds bounds of a pose from those alone: never too small, somewhat too large.

mod axis_box;
mod bones;
pub(crate) mod reach;
pub(crate) mod reach_builder;
mod sphere;

pub use axis_box::AxisBox;
pub use bones::BoneBoxes;
pub use sphere::Sphere;

use crate::data::ModelData;
use crate::evaluator::Evaluator;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// A box along the axes and a sphere, each around the same points; never NaN.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// The smallest coordinate along each axis.
    pub min: Vec3,
    /// The largest.
    pub max: Vec3,
    /// Holds every point; its centre need not be that of the box.
    pub sphere: Sphere,
}

impl Bounds {
    /// Around all `points`; NaN and infinite ones are left out. Without any: no size, in the origin.
    pub fn of_points(points: &[Vec3]) -> Self {
        let mut finite = points.iter().copied().filter(|point| point.is_finite());
        let Some(first) = finite.next() else { return Self::default() };
        let (min, max) = finite.fold((first, first), |(min, max), point| (min.min(point), max.max(point)));
        Self { min, max, sphere: Sphere::of_points(points, min, max) }
    }

    /// The middle of the box.
    pub fn center(&self) -> Vec3 {
        // Halved first: the sum of two large numbers may be none.
        self.min * 0.5 + self.max * 0.5
    }

    /// Does the box hold `point`, its faces included?
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }
}

/// Bounds of the origins of bones: for a skeleton without geometry.
///
/// `to_root` are the relative poses: bone space → scene space.
pub fn bounds_of_bones(to_root: &[Mat4]) -> Bounds {
    let origins: Vec<Vec3> = to_root.iter().map(|to_root| to_root.w_axis.truncate()).collect();
    Bounds::of_points(&origins)
}

/// Bounds of `model` at `time` seconds of take number `take`; `None` is the rest pose.
///
/// Poses the model for this one question; for many, keep an [`Evaluator`] and ask [`Evaluator::bounds`].
pub fn bounds_of_pose(model: &Arc<ModelData>, take: Option<usize>, time: f32) -> Bounds {
    let mut evaluator = Evaluator::new(Arc::clone(model));
    evaluator.pose(take, time);
    evaluator.bounds()
}
