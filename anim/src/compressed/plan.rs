//! Analysis of a take: which channels are constant and which move, and how far an error of a bone reaches.

use super::frames::SampledFrames;
use super::grid::{FLOATS, MOST_BITS};
use super::settings::Exactness;
use super::stored::{RoundingGrid, StoredChannel, constant};
use crate::data::{Skeleton, Transform};
use glam::{Quat, Vec3, Vec4};

/// Share of the tolerance allowed for treating small movements as constant.
const STILL: f32 = 0.1;
/// Share of the tolerance allowed for rounding constants.
const ROUNDING: f32 = 0.05;

/// The bones of a take, with their tolerances.
#[derive(Debug)]
pub(super) struct TrackPlan {
    pub(super) exactness: Vec<Exactness>,
    pub(super) parents: Vec<Option<usize>>,
    pub(super) children: Vec<Vec<usize>>,
    /// The smallest tolerance of a bone and its descendants.
    pub(super) tolerance: Vec<f32>,
    /// Number of bones from the root to a bone, and to the farthest below it.
    pub(super) depth: Vec<(f32, f32)>,
    /// Constant channels, rounded; [`StoredChannel::Whole`] without values for the channels that move.
    pub(super) parts: Vec<[StoredChannel; 3]>,
    pub(super) grid: RoundingGrid,
}

impl TrackPlan {
    pub(super) fn new(frames: &SampledFrames, skeleton: &Skeleton, exactness: Vec<Exactness>) -> Self {
        let count = skeleton.len();
        let earlier = |bone: usize| skeleton.bones[bone].parent.map(|at| at as usize).filter(|&at| at < bone);
        let parents: Vec<Option<usize>> = (0..count).map(earlier).collect();
        let mut children = vec![Vec::new(); count];
        let mut depth = vec![(1.0_f32, 1.0_f32); count];
        for bone in 0..count {
            if let Some(parent) = parents[bone] {
                children[parent].push(bone);
                depth[bone] = (depth[parent].0 + 1.0, depth[parent].0 + 1.0);
            }
        }
        let mut tolerance: Vec<f32> = exactness.iter().map(|of| of.tolerance).collect();
        for bone in (0..count).rev() {
            if let Some(parent) = parents[bone] {
                tolerance[parent] = tolerance[parent].min(tolerance[bone]);
                depth[parent].1 = depth[parent].1.max(depth[bone].1);
            }
        }
        let (parts, mut grid) = still(frames, &exactness, &tolerance, &children);
        if skeleton.bones.iter().any(|bone| bone.rest_matrix.is_some()) {
            // A sheared rest matrix is used only while the pose is the rest pose, bit for bit.
            (grid.rotation_bits, grid.translation_bits) = (FLOATS, FLOATS);
        }
        let mut plan = Self { exactness, parents, children, tolerance, depth, parts, grid };
        plan.round();
        plan
    }

    /// Returns whether every channel of `bone` is constant.
    pub(super) fn is_rigid(&self, bone: usize) -> bool {
        self.parts[bone].iter().all(|part| !matches!(part, StoredChannel::Whole(_)))
    }

    /// Returns the pose of a rigid bone.
    pub(super) fn still_pose(&self, bone: usize) -> Transform {
        constant(&self.parts[bone])
    }

    /// Rounds the constants, and drops those that are the default.
    fn round(&mut self) {
        for parts in &mut self.parts {
            if let StoredChannel::Constant(value) = &mut parts[0] {
                *value = self.grid.rotation(Quat::from_array(*value)).to_array();
            }
            if let StoredChannel::Constant(value) = &mut parts[1] {
                *value = value.map(|component| self.grid.component(component));
            }
            for (part, default) in
                parts.iter_mut().zip([[0.0, 0.0, 0.0, 1.0], [0.0; 4], [1.0, 1.0, 1.0, 0.0]])
            {
                if matches!(part, StoredChannel::Constant(value) if *value == default) {
                    *part = StoredChannel::Default;
                }
            }
        }
    }
}

/// Returns the constant channels, and how they are to be rounded.
fn still(
    frames: &SampledFrames,
    exactness: &[Exactness],
    tolerance: &[f32],
    children: &[Vec<usize>],
) -> (Vec<[StoredChannel; 3]>, RoundingGrid) {
    let count = frames.bones;
    let moves = || {
        [StoredChannel::Whole(Vec::new()), StoredChannel::Whole(Vec::new()), StoredChannel::Whole(Vec::new())]
    };
    let mut parts: Vec<[StoredChannel; 3]> = (0..count).map(|_| moves()).collect();
    // Distance from the bone's origin of the points that it alone must correct.
    let mut reach: Vec<f32> = exactness.iter().map(|of| of.shell).collect();
    let (mut finest_turn, mut finest_step, mut farthest) = (f32::MAX, f32::MAX, 0.0_f32);
    for bone in (0..count).rev() {
        let pose = |frame: usize| frames.pose(frame, bone);
        for &child in &children[bone] {
            let away = (0..frames.count()).map(|frame| frames.pose(frame, child).translation.length());
            let hangs = parts[child].iter().all(|part| !matches!(part, StoredChannel::Whole(_)));
            reach[bone] = reach[bone].max(away.fold(0.0, f32::max) + if hangs { reach[child] } else { 0.0 });
        }
        let largest =
            (0..frames.count()).map(|frame| pose(frame).scale.abs().max_element()).fold(1.0, f32::max);
        let allowed = tolerance[bone] * STILL;
        if let Some(scale) = middle(frames.count(), |frame| pose(frame).scale, allowed / reach[bone]) {
            parts[bone][2] =
                StoredChannel::Constant(rounded_scale(scale, allowed / reach[bone]).extend(0.0).to_array());
        }
        reach[bone] *= largest;
        if let Some(translation) = middle(frames.count(), |frame| pose(frame).translation, allowed) {
            parts[bone][1] = StoredChannel::Constant(translation.extend(0.0).to_array());
            finest_step = finest_step.min(tolerance[bone] * ROUNDING);
            farthest = farthest.max(translation.abs().max_element());
        }
        if let Some(rotation) =
            middle_turn(frames.count(), |frame| pose(frame).rotation, allowed / reach[bone])
        {
            parts[bone][0] = StoredChannel::Constant(rotation.to_array());
            finest_turn = finest_turn.min(tolerance[bone] * ROUNDING / reach[bone]);
        }
    }
    (parts, grid(finest_turn, finest_step, farthest))
}

/// Returns the bits for rotations exact to `turn` radians, and for translations to `step` up to `farthest`.
fn grid(turn: f32, step: f32, farthest: f32) -> RoundingGrid {
    let bits = |numbers: f32| {
        let bits = libm::log2f(numbers).ceil();
        if bits <= MOST_BITS as f32 { (bits as u32).max(4) } else { FLOATS }
    };
    let translation_bits = if farthest > 0.0 { bits(2.0 * farthest / step + 4.0) } else { 4 };
    RoundingGrid {
        // Each of three components is off by up to half a step, and a rotation turns by twice the distance between the
        // quaternions.
        rotation_bits: bits(2.5 / turn + 2.0),
        step: if step.is_normal() && step < 1e18 { step } else { 1.0 },
        translation_bits: if step.is_normal() { translation_bits } else { FLOATS },
    }
}

/// Returns the middle of a vector's values if none is farther than `allowed` from it.
fn middle(count: usize, value: impl Fn(usize) -> Vec3, allowed: f32) -> Option<Vec3> {
    let first = value(0);
    let (low, high) =
        (1..count).map(&value).fold((first, first), |(low, high), value| (low.min(value), high.max(value)));
    let middle = if low == high { first } else { low * 0.5 + high * 0.5 };
    (low == high || (high - low).length() * 0.5 <= allowed).then_some(middle)
}

/// Returns the middle of a bone's rotations if none turns farther than `allowed` radians from it.
fn middle_turn(count: usize, rotation: impl Fn(usize) -> Quat, allowed: f32) -> Option<Quat> {
    let first = rotation(0);
    if (1..count).all(|frame| rotation(frame) == first) {
        return Some(first);
    }
    let middle = mean((0..count).map(&rotation));
    let farthest = (0..count).map(|frame| chord(rotation(frame), middle)).fold(0.0, f32::max);
    // Also fails where the middle is NaN.
    (farthest * 2.0 <= allowed).then_some(middle)
}

/// Returns the distance of two rotations as quaternions: about half the angle between them.
fn chord(a: Quat, b: Quat) -> f32 {
    (a - b).length().min((a + b).length())
}

/// Returns the middle rotation, whatever signs the quaternions have.
pub(super) fn mean(rotations: impl Iterator<Item = Quat>) -> Quat {
    let sum = rotations.fold(Vec4::ZERO, |sum, rotation| {
        let rotation = Vec4::from(rotation);
        sum + if sum.dot(rotation) < 0.0 { -rotation } else { rotation }
    });
    if sum.length_squared() > 0.0 { Quat::from_vec4(sum.normalize()) } else { Quat::IDENTITY }
}

/// Rounds factors invisibly close to 1 or -1 to 1 or -1: those cost nothing.
fn rounded_scale(scale: Vec3, allowed: f32) -> Vec3 {
    let round = |factor: f32| if (factor.abs() - 1.0).abs() <= allowed { factor.signum() } else { factor };
    Vec3::new(round(scale.x), round(scale.y), round(scale.z))
}
