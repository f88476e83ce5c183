//! Symmetry of the rest pose, and the plane that mirrors it.

use super::mirror_pair::MirrorPair;
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_anim::sample::rest_pose;
use glam::{Mat4, Vec3};

/// Maximum distance of a bone from the mirror image of its partner, relative to the size of the model.
const NEAR: f32 = 0.03;
/// Distance beyond which a pair counts as wrong, relative to the size of the model.
const FAR: f32 = 0.06;

/// The mirror plane of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorPlane {
    /// Unit vector.
    pub normal: Vec3,
    /// Distance of the plane from the origin along the normal, scene units.
    pub distance: f32,
}

impl MirrorPlane {
    /// Returns the mirror image of a position.
    pub fn place(&self, place: Vec3) -> Vec3 {
        place - 2.0 * (self.normal.dot(place) - self.distance) * self.normal
    }

    /// Returns the mirror image of a direction.
    pub fn direction(&self, direction: Vec3) -> Vec3 {
        direction - 2.0 * self.normal.dot(direction) * self.normal
    }
}

/// A skeleton in the pose in which it is symmetric.
#[derive(Clone, Debug)]
pub struct Stance {
    /// Matrices from bone space to scene space.
    pub to_root: Vec<Mat4>,
    /// The mirror plane; x = 0 where it is unknown.
    pub plane: MirrorPlane,
    /// Number of pairs that agree with the plane.
    agree: usize,
    /// The largest extent of the model.
    size: f32,
}

impl Stance {
    /// Returns the more symmetric one of two poses: the rest pose or the bind pose. The bind pose is often better,
    /// because some files have a frame of an animation as rest pose.
    pub fn of(skeleton: &Skeleton, pairs: &[MirrorPair]) -> Self {
        let rest: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
        let mut rest_to_root = vec![Mat4::IDENTITY; skeleton.len()];
        to_root(skeleton, &rest, &mut rest_to_root);
        let bound = bound(skeleton, &rest_to_root);
        let (rest, bound) = (Self::judged(rest_to_root, pairs), Self::judged(bound, pairs));
        if bound.agree > rest.agree { bound } else { rest }
    }

    fn judged(to_root: Vec<Mat4>, pairs: &[MirrorPair]) -> Self {
        let places =
            || to_root.iter().map(|matrix| matrix.w_axis.truncate()).filter(|place| place.is_finite());
        let (min, max) = places()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), place| (min.min(place), max.max(place)));
        let size = (max - min).max_element();
        let size = if size.is_finite() && size > 0.0 { size } else { 1.0 };
        let plane = MirrorPlane { normal: Vec3::X, distance: 0.0 };
        let mut stance = Self { to_root, plane, agree: 0, size };
        for normal in [Vec3::X, Vec3::Z, Vec3::Y] {
            let plane = MirrorPlane { normal, distance: stance.middle(normal, pairs) };
            let agree = pairs.iter().filter(|pair| stance.agrees(&plane, pair)).count();
            if agree > stance.agree {
                (stance.plane, stance.agree) = (plane, agree);
            }
        }
        stance
    }

    /// Returns the median of the middles of all pairs along the normal.
    fn middle(&self, normal: Vec3, pairs: &[MirrorPair]) -> f32 {
        let middle = |pair: &MirrorPair| {
            let (left, right) = (self.place(pair.left)?, self.place(pair.right)?);
            Some(normal.dot(left + right) / 2.0)
        };
        let mut middles: Vec<f32> = pairs.iter().filter_map(middle).collect();
        middles.sort_by(f32::total_cmp);
        middles.get(middles.len() / 2).copied().unwrap_or(0.0)
    }

    fn agrees(&self, plane: &MirrorPlane, pair: &MirrorPair) -> bool {
        // Two bones in the plane agree with any plane.
        let apart = self
            .place(pair.left)
            .is_some_and(|place| (plane.normal.dot(place) - plane.distance).abs() > self.size * 1e-3);
        apart && self.miss(plane, pair.left, pair.right) <= NEAR
    }

    fn place(&self, bone: BoneIndex) -> Option<Vec3> {
        self.to_root
            .get(bone as usize)
            .map(|matrix| matrix.w_axis.truncate())
            .filter(|place| place.is_finite())
    }

    /// Returns the distance of one bone from the mirror image of the other, relative to the size of the model.
    fn miss(&self, plane: &MirrorPlane, one: BoneIndex, other: BoneIndex) -> f32 {
        match (self.place(one), self.place(other)) {
            (Some(one), Some(other)) => plane.place(one).distance(other) / self.size,
            _ => f32::INFINITY,
        }
    }

    /// Returns whether enough pairs agree with the plane.
    pub(super) fn is_sure(&self, pairs: usize) -> bool {
        self.agree > 0 && self.agree * 2 >= pairs
    }

    /// Returns whether two bones are clearly not symmetric.
    pub(super) fn contradicts(&self, left: BoneIndex, right: BoneIndex) -> bool {
        self.miss(&self.plane, left, right) > FAR
    }

    /// Returns the bone of `others` that is the mirror image; `None` where there is none.
    pub(super) fn opposite(&self, bone: BoneIndex, others: &[BoneIndex]) -> Option<BoneIndex> {
        let misses = others.iter().map(|&other| (self.miss(&self.plane, bone, other), other));
        misses
            .filter(|(miss, _)| *miss <= NEAR)
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map(|(_, other)| other)
    }
}

/// Returns the bind pose. A bone without a skin, or with a parent without one, has its rest pose relative to its
/// parent: the space of bind poses may differ from the scene.
fn bound(skeleton: &Skeleton, rest_to_root: &[Mat4]) -> Vec<Mat4> {
    let differs = |bone: usize| {
        let offset = skeleton.bones[bone].offset;
        let stays = offset * rest_to_root[bone];
        stays.is_finite() && !stays.abs_diff_eq(Mat4::IDENTITY, 1e-3) && offset.determinant().abs() > 1e-18
    };
    let mut found: Vec<Mat4> = Vec::with_capacity(rest_to_root.len());
    for (index, bone) in skeleton.bones.iter().enumerate() {
        let parent = bone.parent.map(|parent| parent as usize).filter(|&parent| parent < index);
        let to_root = match parent {
            Some(parent) if differs(parent) && differs(index) => {
                found[parent] * skeleton.bones[parent].offset * bone.offset.inverse()
            }
            Some(parent) => found[parent] * (rest_to_root[parent].inverse() * rest_to_root[index]),
            None => rest_to_root[index],
        };
        found.push(if to_root.is_finite() { to_root } else { rest_to_root[index] });
    }
    found
}
