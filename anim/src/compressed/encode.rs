//! Encodes frames, bone after bone from the root, each relative to its parent as it will be decoded.

use super::frames::SampledFrames;
use super::grid::{WHOLE_BITS, rotation_from, rotation_numbers};
use super::plan::{TrackPlan, mean};
use super::points::{RigidPoint, aimed, shell};
use super::stored::{PackedChannel, Reference, StoredChannel, StoredTake, ValueRange, rotation_of};
use super::track::{Coded, Wanted, code};
use crate::animation::to_parent;
use crate::data::{Skeleton, Transform};
use glam::{Affine3A, Quat, Vec3, Vec3Swizzles};

/// Parameters that the compressor may choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EncodeChoice {
    /// A segment has `1 << shift` keys.
    pub(super) shift: u32,
    /// Shares of the tolerance allowed for the first and the last joint of a chain.
    pub(super) shares: [f32; 2],
    /// Whether channels that move are stored as exactly as possible.
    pub(super) whole: bool,
}

/// Share of the tolerance allowed for the shell of a bone.
const SHELL: f32 = 0.985;
/// Share of a joint's tolerance allowed for its translation, where that moves.
const MOVED: f32 = 0.5;
/// Share of a bone's tolerance allowed for its scale, where that moves.
const SCALED: f32 = 0.3;
/// The first step tried, in units of the step that would just suffice for one point.
const COARSE: f32 = 4.0;
/// A track is stored whole if, at any key, the w of its rotation relative to the middle rotation is below this.
const SMALLEST_W: f32 = 0.3;

/// Everything needed to encode a bone.
pub(super) struct Encoder<'a> {
    pub(super) frames: &'a SampledFrames,
    pub(super) skeleton: &'a Skeleton,
    pub(super) plan: &'a TrackPlan,
    pub(super) choice: EncodeChoice,
    /// `to_root` of every bone as it will be decoded, frame after frame: bone space → scene space.
    to_root: Vec<Affine3A>,
}

impl<'a> Encoder<'a> {
    pub(super) fn new(
        frames: &'a SampledFrames,
        skeleton: &'a Skeleton,
        plan: &'a TrackPlan,
        choice: EncodeChoice,
    ) -> Self {
        Self { frames, skeleton, plan, choice, to_root: vec![Affine3A::IDENTITY; frames.to_root.len()] }
    }

    /// Encodes every bone.
    pub(super) fn run(mut self, name: &str) -> StoredTake {
        let bones = (0..self.frames.bones).map(|bone| self.bone(bone)).collect();
        StoredTake {
            name: name.to_owned(),
            clock: self.frames.clock,
            shift: self.choice.shift,
            grid: self.plan.grid,
            bones,
        }
    }

    fn parent(&self, frame: usize, bone: usize) -> Affine3A {
        let parent = self.plan.parents[bone];
        parent.map_or(Affine3A::IDENTITY, |parent| self.to_root[frame * self.frames.bones + parent])
    }

    /// Returns the distance by which the origin of `bone` may be off.
    fn joint_limit(&self, bone: usize) -> f32 {
        let (depth, deepest) = self.plan.depth[bone];
        let [first, last] = self.choice.shares;
        let share = first + (last - first) * (depth - 1.0) / deepest;
        self.plan.tolerance[bone] * share
    }

    fn bone(&mut self, bone: usize) -> [StoredChannel; 3] {
        let count = self.frames.count();
        let mut parts = self.plan.parts[bone].clone();
        let mut poses = vec![self.plan.still_pose(bone); count];
        if matches!(parts[2], StoredChannel::Whole(_)) {
            parts[2] = self.scale(bone, &mut poses);
        }
        if matches!(parts[1], StoredChannel::Whole(_)) {
            parts[1] = self.translation(bone, &mut poses);
        }
        if matches!(parts[0], StoredChannel::Whole(_)) {
            parts[0] = self.rotation(bone, &mut poses);
        }
        let rules = &self.skeleton.bones[bone];
        for (frame, &pose) in poses.iter().enumerate() {
            let to_parent = Affine3A::from_mat4(to_parent(rules, pose));
            let to_root = self.parent(frame, bone) * to_parent;
            let index = frame * self.frames.bones + bone;
            self.to_root[index] = if to_root.is_finite() { to_root } else { self.parent(frame, bone) };
        }
        parts
    }

    fn scale(&self, bone: usize, poses: &mut [Transform]) -> StoredChannel {
        let wanted: Vec<Vec3> = (0..poses.len()).map(|frame| self.frames.pose(frame, bone).scale).collect();
        let points = self.points(bone);
        let limit = self.plan.tolerance[bone] * SCALED;
        let reach = points.iter().map(|point| point.local.length()).fold(f32::MIN_POSITIVE, f32::max);
        let largest = |frame: usize| self.frames.to_root(frame, bone).matrix3;
        let error = |frame: usize, scale: Vec3| {
            // Measured from the raw pose, so that only the error of this scale counts, not the errors of the parents.
            let unscaled = wanted[frame];
            let ratio = Vec3::select(
                unscaled.abs().cmpgt(Vec3::splat(1e-3)),
                (scale - unscaled) / unscaled,
                scale - unscaled,
            );
            let far = |point: &RigidPoint| (largest(frame) * (ratio * point.local)).length();
            points.iter().map(far).fold(0.0, f32::max) / limit
        };
        self.vector(&wanted, Vec3::splat(COARSE * limit / reach), error, |frame, scale| {
            poses[frame].scale = scale
        })
    }

    fn translation(&self, bone: usize, poses: &mut [Transform]) -> StoredChannel {
        let limit = self.joint_limit(bone) * MOVED;
        let parents: Vec<Affine3A> = (0..poses.len()).map(|frame| self.parent(frame, bone)).collect();
        let raw: Vec<Vec3> =
            (0..poses.len()).map(|frame| self.frames.to_root(frame, bone).translation.into()).collect();
        let wanted: Vec<Vec3> = (0..poses.len())
            .map(|frame| {
                let back = parents[frame].inverse().transform_point3(raw[frame]);
                if !self.choice.whole && well(&parents[frame]) && back.is_finite() {
                    back
                } else {
                    self.frames.pose(frame, bone).translation
                }
            })
            .collect();
        let error = |frame: usize, translation: Vec3| {
            parents[frame].transform_point3(translation).distance(raw[frame]) / limit
        };
        let put = |frame: usize, translation| poses[frame].translation = translation;
        self.vector(&wanted, Vec3::splat(COARSE * limit), error, put)
    }

    /// Encodes a vector that moves.
    fn vector(
        &self,
        values: &[Vec3],
        step: Vec3,
        error: impl FnMut(usize, Vec3) -> f32,
        mut put: impl FnMut(usize, Vec3),
    ) -> StoredChannel {
        let range = vector_range(values).filter(|_| !self.choice.whole);
        let coded =
            range.and_then(|range| code(&Wanted { values, range, shift: self.choice.shift, step }, error));
        let Some(Coded { range, segments, values: decoded }) = coded else {
            values.iter().enumerate().for_each(|(frame, &value)| put(frame, value));
            return StoredChannel::Whole(values.iter().map(|value| value.extend(0.0).to_array()).collect());
        };
        decoded.iter().enumerate().for_each(|(frame, &value)| put(frame, value));
        StoredChannel::PackedChannel(PackedChannel { reference: Reference::NONE, range, segments })
    }

    fn rotation(&self, bone: usize, poses: &mut [Transform]) -> StoredChannel {
        let points = self.points(bone);
        let count = poses.len();
        let parents: Vec<Affine3A> = (0..count).map(|frame| self.parent(frame, bone)).collect();
        let raw: Vec<Vec3> = (0..count)
            .flat_map(|frame| points.iter().map(move |point| point.raw(self.frames, frame)))
            .collect();
        let raw_of = |frame: usize| &raw[frame * points.len()..(frame + 1) * points.len()];
        let wanted: Vec<Quat> = (0..count)
            .map(|frame| self.aim(bone, frame, &points, raw_of(frame), &parents[frame], &poses[frame]))
            .collect();
        if !self.choice.whole {
            let share = |frame: usize, rotation: Quat| {
                let pose = Transform { rotation, ..poses[frame] };
                RigidPoint::share(&points, raw_of(frame), &(parents[frame] * pose.to_affine()))
            };
            // If the parents left a larger error than a rotation can correct, no number of bits would suffice.
            let reachable: Vec<f32> = wanted
                .iter()
                .enumerate()
                .map(|(frame, &best)| (share(frame, best) * 1.02 + 0.05).max(1.0))
                .collect();
            let error = |frame: usize, rotation: Quat| share(frame, rotation) / reachable[frame];
            if let Some((packed, decoded)) = self.pack_rotation(&wanted, self.turn_step(bone, &points), error)
            {
                poses.iter_mut().zip(decoded).for_each(|(pose, rotation)| pose.rotation = rotation);
                return StoredChannel::PackedChannel(packed);
            }
        }
        let whole = |rotation: Quat| {
            let (dropped, numbers) = rotation_numbers(rotation, WHOLE_BITS);
            rotation_from(dropped, numbers, WHOLE_BITS)
        };
        poses.iter_mut().zip(&wanted).for_each(|(pose, &rotation)| pose.rotation = whole(rotation));
        StoredChannel::Whole(wanted.iter().map(|rotation| rotation.to_array()).collect())
    }

    /// Returns the rotation that best corrects the error of the parents.
    fn aim(
        &self,
        bone: usize,
        frame: usize,
        points: &[RigidPoint],
        raw: &[Vec3],
        parent: &Affine3A,
        pose: &Transform,
    ) -> Quat {
        let rotation = self.frames.pose(frame, bone).rotation;
        if self.choice.whole || !well(parent) {
            return rotation;
        }
        let back = parent.inverse();
        aimed(
            rotation,
            points.iter().zip(raw).map(|(point, &raw)| {
                (pose.scale * point.local, back.transform_point3(raw) - pose.translation, point.limit)
            }),
        )
    }

    /// Returns a step for each component of a rotation that is too coarse for its points.
    fn turn_step(&self, bone: usize, points: &[RigidPoint]) -> Vec3 {
        let scale = self.frames.pose(0, bone).scale;
        let mut step = Vec3::splat(1.0);
        for point in points {
            let arm = scale * point.local;
            let around = Vec3::new(arm.yz().length(), arm.xz().length(), arm.xy().length());
            step = step.min(COARSE * point.limit / around.max(Vec3::splat(f32::MIN_POSITIVE)));
        }
        step
    }

    fn pack_rotation(
        &self,
        wanted: &[Quat],
        step: Vec3,
        mut error: impl FnMut(usize, Quat) -> f32,
    ) -> Option<(PackedChannel, Vec<Quat>)> {
        let reference = Reference::near(mean(wanted.iter().copied()));
        let middle = reference.rotation();
        let back = middle.conjugate();
        let relative = |rotation: &Quat| {
            let relative = back * *rotation;
            (relative.w.abs() >= SMALLEST_W).then(|| relative.xyz() * relative.w.signum())
        };
        let values: Vec<Vec3> = wanted.iter().map(relative).collect::<Option<_>>()?;
        let range = turn_range(&values);
        let wanted = Wanted { values: &values, range, shift: self.choice.shift, step };
        let coded = code(&wanted, |frame, xyz| {
            // Outside the unit ball no w makes a unit quaternion of it.
            if xyz.length_squared() <= 1.0 { error(frame, rotation_of(middle, xyz)) } else { f32::INFINITY }
        })?;
        let decoded = coded.values.iter().map(|&xyz| rotation_of(middle, xyz)).collect();
        Some((PackedChannel { reference, range: coded.range, segments: coded.segments }, decoded))
    }

    /// Returns the points that only `bone` can correct: its shell, the joints that move on it, and everything rigidly
    /// attached to it.
    fn points(&self, bone: usize) -> Vec<RigidPoint> {
        let mut points = Vec::new();
        let mut open = vec![(bone, Affine3A::IDENTITY)];
        while let Some((owner, to_bone)) = open.pop() {
            let exactness = &self.plan.exactness[owner];
            points.extend(shell(exactness).map(|of_owner| RigidPoint {
                local: to_bone.transform_point3(of_owner),
                owner,
                of_owner,
                limit: exactness.tolerance * SHELL,
            }));
            for &child in &self.plan.children[owner] {
                let still = self.plan.still_pose(child);
                if self.plan.is_rigid(child) {
                    open.push((child, to_bone * still.to_affine()));
                } else if !matches!(self.plan.parts[child][1], StoredChannel::Whole(_)) {
                    points.push(RigidPoint {
                        local: to_bone.transform_point3(still.translation),
                        owner: child,
                        of_owner: Vec3::ZERO,
                        limit: self.joint_limit(child),
                    });
                }
            }
        }
        points
    }
}

/// Returns whether the space of a bone can be inverted accurately.
fn well(to_root: &Affine3A) -> bool {
    let lengths =
        [to_root.matrix3.x_axis, to_root.matrix3.y_axis, to_root.matrix3.z_axis].map(|axis| axis.length());
    let (least, most) =
        lengths.iter().fold((f32::MAX, 0.0_f32), |(least, most), &at| (least.min(at), most.max(at)));
    // Inversion amplifies errors by the ratio of the axes; then the raw pose is the better aim.
    let volume = to_root.matrix3.determinant().abs() / (lengths[0] * lengths[1] * lengths[2]);
    most.is_finite() && least > 0.3 * most && volume > 0.3
}

/// Margin on both sides, so that the position of a segment can be rounded.
const MARGIN: f32 = 0.006;

/// Returns the range of vectors; `None` where that leaves the range of numbers.
fn vector_range(values: &[Vec3]) -> Option<ValueRange> {
    let (low, high) = ends(values);
    let extent = high - low;
    let range = ValueRange { low: low - extent * MARGIN, extent: extent * (1.0 + 2.0 * MARGIN) };
    (range.low.is_finite() && range.extent.is_finite() && range.extent.max_element() < 1e18).then_some(range)
}

/// Unit of the range of a rotation.
pub(super) const TURN_UNIT: f32 = 1.0 / 16_384.0;

/// Returns the range of components of rotations, in whole [`TURN_UNIT`]s.
fn turn_range(values: &[Vec3]) -> ValueRange {
    let (low, high) = ends(values);
    let extent = high - low;
    let low = ((low - extent * MARGIN) / TURN_UNIT).floor();
    let high = ((high + extent * MARGIN) / TURN_UNIT).ceil();
    ValueRange { low: low * TURN_UNIT, extent: (high - low) * TURN_UNIT }
}

fn ends(values: &[Vec3]) -> (Vec3, Vec3) {
    let first = values.first().copied().unwrap_or(Vec3::ZERO);
    values.iter().fold((first, first), |(low, high), &value| (low.min(value), high.max(value)))
}
