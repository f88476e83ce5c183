//! A skeleton in a pose as lines, for small pictures of poses.

use crate::edit::{BonePose, BoneRef};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::sample::mix::slerp;
use dragonfly_anim::sample::rest_pose;
use glam::{Mat4, Quat, Vec2, Vec3};
use std::collections::HashMap;

/// Most lines of a figure; of more bones, those without a pose are left out.
const LINES: usize = 2000;

/// A line from a bone to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StickLine {
    /// The parent, 0 to 1 from the left and from the top.
    pub from: [f32; 2],
    /// The bone.
    pub to: [f32; 2],
    /// Whether the pose moves the bone or its parent.
    pub posed: bool,
}

/// Returns the rest pose of a skeleton with the given poses of bones. Bones that it does not have are left out.
fn posed_skeleton(skeleton: &Skeleton, poses: &[BonePose]) -> (Vec<Transform>, Vec<bool>) {
    let mut all: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
    let mut posed = vec![false; all.len()];
    let names: HashMap<&str, usize> =
        skeleton.bones.iter().enumerate().rev().map(|(at, bone)| (bone.name.as_str(), at)).collect();
    for pose in poses {
        let bone = match &pose.bone {
            BoneRef::Index(bone) => Some(*bone as usize),
            BoneRef::Name(name) => names.get(name.as_str()).copied(),
        };
        let Some((bone, place)) = bone.and_then(|bone| Some((bone, all.get_mut(bone)?))) else { continue };
        *place = with_pose(place, pose);
        posed[bone] = true;
    }
    (all, posed)
}

/// Returns a transform with the parts that a pose gives.
fn with_pose(from: &Transform, pose: &BonePose) -> Transform {
    let rotation = pose.rotation.map(Quat::from_array).filter(|rotation| rotation.length_squared() > 1e-12);
    Transform {
        translation: pose.translation.map_or(from.translation, Vec3::from_array),
        rotation: rotation.map_or(from.rotation, Quat::normalize),
        scale: pose.scale.map_or(from.scale, Vec3::from_array),
    }
}

/// Returns the figure seen from the front, along -z with y up, fitted into a square. A skeleton whose bones are all at one place has no
/// lines.
pub fn stick_figure(skeleton: &Skeleton, poses: &[BonePose]) -> Vec<StickLine> {
    let (all, posed) = posed_skeleton(skeleton, poses);
    let mut matrices = vec![Mat4::IDENTITY; all.len()];
    to_root(skeleton, &all, &mut matrices);
    let place = |bone: usize| {
        let place = matrices.get(bone)?.w_axis.truncate();
        place.is_finite().then_some(Vec2::new(place.x, -place.y))
    };
    let mut lines = Vec::new();
    for pass in [true, false] {
        for (at, bone) in skeleton.bones.iter().enumerate() {
            let Some(parent) = bone.parent.map(|parent| parent as usize) else { continue };
            let moves = posed[at] || posed.get(parent).copied().unwrap_or(false);
            if moves == pass
                && lines.len() < LINES
                && let (Some(from), Some(to)) = (place(parent), place(at))
            {
                lines.push((from, to, moves));
            }
        }
    }
    let ends = || lines.iter().flat_map(|&(from, to, _)| [from, to]);
    let low = ends().fold(Vec2::INFINITY, Vec2::min);
    let high = ends().fold(Vec2::NEG_INFINITY, Vec2::max);
    let size = (high - low).max_element();
    if !(size.is_finite() && size > 1e-9) {
        return Vec::new();
    }
    let fitted = |at: Vec2| ((at - (low + high) / 2.0) / size + Vec2::splat(0.5)).to_array();
    lines
        .into_iter()
        .map(|(from, to, posed)| StickLine { from: fitted(from), to: fitted(to), posed })
        .collect()
}

/// Returns a pose between a transform (0) and a pose (1). Parts that the pose does not give stay absent. Rotations take the shorter way.
pub fn blended_pose(from: &Transform, to: &BonePose, amount: f32) -> BonePose {
    let amount = if amount.is_finite() { amount.clamp(0.0, 1.0) } else { 0.0 };
    let vector = |from: Vec3, to: [f32; 3]| from.lerp(Vec3::from_array(to), amount).to_array();
    let rotation = |to: [f32; 4]| {
        let to = Quat::from_array(to);
        let to = if to.length_squared() > 1e-12 { to.normalize() } else { from.rotation };
        slerp(from.rotation, to, amount).to_array()
    };
    // At the ends, the values are those given, to the bit.
    if amount == 1.0 {
        return to.clone();
    }
    BonePose {
        bone: to.bone.clone(),
        translation: to.translation.map(|to| vector(from.translation, to)),
        rotation: to.rotation.map(rotation),
        scale: to.scale.map(|to| vector(from.scale, to)),
    }
}
