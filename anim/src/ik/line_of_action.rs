//! A pose from a stroke: the bones of a chain follow a line of action that was drawn in the view.
//!
//! ```text
//! l_i = length of bone i in the view plane, d_i = its depth            both as they are
//! s_i = (l_1 + … + l_i) / (l_1 + … + l_n) · length of the stroke       where its end is on the stroke
//! bone i = l_i · direction from stroke(s_i-1) to stroke(s_i) + d_i · line of sight
//! ```
//!
//! The first joint stays where it is, so the shape of the stroke counts and neither its place nor its size. Bones keep their lengths and their
//! depth, so from the side of the viewer the chain looks like the stroke, and from any other side it bends as before.
//!
//! (M. Guay, M.-P. Cani, R. Ronfard: "The Line of Action: an Intuitive Interface for Expressive Character Posing", ACM Transactions on Graphics
//! 32 (6), 2013. There the line is matched by optimization over the whole figure; for one chain with its first joint fixed, matching the
//! directions part by part needs none.)

use super::IkError;
use super::chain::Limit;
use super::limited::limited;
use super::path::{parent_to_root, pose_of};
use super::turn::arc_between;
use crate::data::{BoneIndex, Skeleton, Transform};
use glam::{DMat3, DMat4, DQuat, DVec2, DVec3, Mat4, Vec3};

/// A stroke, and the chain of bones to lay along it.
#[derive(Clone, Copy, Debug)]
pub struct ActionLine<'a> {
    /// First bone that turns.
    pub root: BoneIndex,
    /// Last bone, below `root`; its origin is the end of the chain. It is not turned itself. All bones between are turned.
    pub end: BoneIndex,
    /// Points of the stroke, to-root space. Their depth along `back` does not count.
    pub stroke: &'a [Vec3],
    /// Direction towards the viewer, to-root space; of any length.
    pub back: Vec3,
}

/// Turns the bones of a chain so that they follow a stroke, as seen from `line.back`. The end of the stroke that is nearer to the first joint is its
/// start: the sum of the distances of both ends to the ends of the chain decides.
///
/// A bone without length in the view plane keeps its direction, and so does one whose part of the stroke has no length. A `limit` is applied to each bone in
/// turn, first to last; those below one that is limited have the direction of the stroke again. Of `to_root`, only the matrix of the parent of the first bone is
/// read.
///
/// # Errors
///
/// A bone is missing, `line.end` is not below `line.root`, something is not finite, or there is no volume above the chain. [`IkError::NoLine`] for a stroke
/// without length, a `back` without length, and a chain that points at the viewer. The poses are as they were.
pub fn line_of_action(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    line: &ActionLine<'_>,
    mut limit: Option<Limit<'_>>,
    poses: &mut [Transform],
) -> Result<(), IkError> {
    let parent = parent_to_root(skeleton, to_root, line.root)?.as_dmat4();
    let links = links_of(skeleton, poses, line)?;
    let wrong = IkError::NotFinite { bone: line.root };
    if links.iter().any(|(_, pose)| !pose.is_finite()) {
        return Err(wrong);
    }
    if !line.back.is_finite() || !line.stroke.iter().all(|point| point.is_finite()) {
        return Err(wrong);
    }
    let back = line.back.as_dvec3().try_normalize().ok_or(IkError::NoLine)?;
    let plane = ViewPlane::of(back);
    let joints = joints_of(&parent, &links);
    if !joints.iter().all(|joint| joint.is_finite()) {
        return Err(wrong);
    }
    let bones: Vec<DVec3> = joints.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let flat: Vec<f64> = bones.iter().map(|bone| plane.flat(*bone).length()).collect();
    let total: f64 = flat.iter().sum();
    let stroke = StrokeCourse::new(line.stroke.iter().map(|point| plane.flat(point.as_dvec3())));
    let (Some(first), Some(last)) = (joints.first(), joints.last()) else { return Err(wrong) };
    let stroke = stroke
        .filter(|_| total > 0.0)
        .ok_or(IkError::NoLine)?
        .towards([plane.flat(*first), plane.flat(*last)]);

    let mut rotations = Vec::with_capacity(bones.len());
    let (mut linear, mut done) = (DMat3::from_mat4(parent), 0.0);
    for (index, bone) in bones.iter().enumerate() {
        let ((own, pose), arm) = (links[index], links[index + 1].1.translation.as_dvec3());
        let share = [done, done + flat[index]].map(|length| stroke.at(length / total));
        done += flat[index];
        let direction = (share[1] - share[0]).try_normalize().filter(|_| flat[index] > 0.0);
        let wanted =
            direction.map_or(*bone, |along| plane.point(along) * flat[index] + back * bone.dot(back));
        let inverse = linear.inverse();
        if linear.determinant() == 0.0 || !inverse.is_finite() {
            return Err(IkError::Flat { bone: own });
        }
        let posed = pose.rotation.as_dquat().normalize();
        let scale = pose.scale.as_dvec3();
        let turn = arc_between(posed * (scale * arm), inverse * wanted);
        let mut rotation = (turn * posed).normalize();
        if let Some(limit) = &mut limit {
            rotation = limited(limit, own, rotation);
        }
        if !rotation.is_finite() {
            return Err(wrong);
        }
        linear *= DMat3::from_quat(rotation) * DMat3::from_diagonal(scale);
        rotations.push((own, rotation));
    }
    for (bone, rotation) in rotations {
        poses[bone as usize].rotation = rotation.as_quat().normalize();
    }
    Ok(())
}

/// Returns the bones of the chain with their poses, first to last.
fn links_of(
    skeleton: &Skeleton,
    poses: &[Transform],
    line: &ActionLine<'_>,
) -> Result<Vec<(BoneIndex, Transform)>, IkError> {
    let below = IkError::NotBelow { above: line.root, below: line.end };
    let (mut links, mut bone) = (Vec::new(), line.end);
    loop {
        links.push((bone, pose_of(skeleton, poses, bone)?));
        if bone == line.root {
            break;
        }
        bone = skeleton.parent(bone).ok_or(below)?;
    }
    links.reverse();
    if links.len() > 1 { Ok(links) } else { Err(below) }
}

/// Returns the origins of the bones, to-root space.
fn joints_of(parent: &DMat4, links: &[(BoneIndex, Transform)]) -> Vec<DVec3> {
    let (mut matrix, mut joints) = (*parent, Vec::with_capacity(links.len()));
    for (_, pose) in links {
        let rotation: DQuat = pose.rotation.as_dquat().normalize();
        matrix *= DMat4::from_scale_rotation_translation(
            pose.scale.as_dvec3(),
            rotation,
            pose.translation.as_dvec3(),
        );
        joints.push(matrix.w_axis.truncate());
    }
    joints
}

/// The plane that faces the viewer.
#[derive(Clone, Copy)]
struct ViewPlane {
    right: DVec3,
    up: DVec3,
}

impl ViewPlane {
    fn of(back: DVec3) -> Self {
        let (right, up) = back.any_orthonormal_pair();
        Self { right, up }
    }

    fn flat(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.up))
    }

    fn point(&self, flat: DVec2) -> DVec3 {
        self.right * flat.x + self.up * flat.y
    }
}

/// A stroke in the view plane, by its length.
struct StrokeCourse {
    points: Vec<DVec2>,
    /// Length from the start to each point.
    lengths: Vec<f64>,
}

impl StrokeCourse {
    /// Returns the stroke through points; `None` for one without length, or with a point that is not finite.
    fn new(points: impl Iterator<Item = DVec2>) -> Option<Self> {
        let mut points: Vec<DVec2> = points.collect();
        points.dedup();
        let mut lengths = vec![0.0];
        let mut length = 0.0;
        for pair in points.windows(2) {
            length += pair[0].distance(pair[1]);
            lengths.push(length);
        }
        (length > 0.0 && length.is_finite()).then_some(Self { points, lengths })
    }

    /// Returns the stroke with the end first that belongs to the first joint of a chain with these ends.
    fn towards(self, [first, last]: [DVec2; 2]) -> Self {
        let (start, end) = (self.points[0], self.points[self.points.len() - 1]);
        if start.distance(first) + end.distance(last) <= end.distance(first) + start.distance(last) {
            return self;
        }
        Self::new(self.points.iter().rev().copied()).unwrap_or(self)
    }

    /// Returns the point at a share of the length, clamped to 0..=1.
    fn at(&self, share: f64) -> DVec2 {
        let last = self.points.len() - 1;
        let along = share.clamp(0.0, 1.0) * self.lengths[last];
        let next = self.lengths.partition_point(|&length| length < along).clamp(1, last);
        let [from, to] = [self.lengths[next - 1], self.lengths[next]];
        let between = if to > from { ((along - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        self.points[next - 1].lerp(self.points[next], between)
    }
}
