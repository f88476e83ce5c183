//! The state of a drag: the pose at its start, the pinned bones, and whether chains of bones follow (inverse
//! kinematics).

use super::reach::{ChainSolver, Reaching, row};
use crate::edit::{BonePose, BoneRef};
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_anim::ik::ChainScratch;
use dragonfly_anim::joint::JointLimits;
use glam::{Mat4, Quat, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Maximum length of a chain of bones.
pub const LONGEST_CHAIN: u32 = 255;

/// Inverse kinematics: whether the bones above follow when a bone is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IkMode {
    /// Whether it is on; if not, only the bone itself moves.
    pub on: bool,
    /// Number of bones above the moved one that rotate; 1 to [`LONGEST_CHAIN`]. Two are an arm or a leg.
    pub length: u32,
    /// The bone towards which elbows and knees bend; without one they bend as they are.
    pub pole: Option<BoneIndex>,
}

impl Default for IkMode {
    fn default() -> Self {
        Self { on: false, length: 2, pole: None }
    }
}

/// A target position of a bone, reached by rotating the bones above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The bone.
    pub bone: BoneIndex,
    /// Position in scene space.
    pub place: Vec3,
}

/// Position and rotation of a bone in the scene at the start of the drag.
#[derive(Clone, Copy, Debug)]
struct PinnedPose {
    bone: BoneIndex,
    place: Vec3,
    rotation: Quat,
}

/// The state of a drag from its start to its end. It allocates nothing per bone during the drag.
#[derive(Debug)]
pub struct PoseDragState {
    skeleton: Arc<Skeleton>,
    limits: Option<JointLimits>,
    mode: IkMode,
    begun: Vec<Transform>,
    begun_to_root: Vec<Mat4>,
    pins: Vec<PinnedPose>,
    /// Bones that no chain rotates, with the rotations that they keep.
    fixed: BTreeMap<BoneIndex, Quat>,
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
    scratch: ChainScratch,
}

impl PoseDragState {
    /// Captures the start of a drag: `poses` relative to the parents, one per bone (missing or non-finite ones are
    /// replaced by the rest pose), and the pinned bones. Chains respect the joint limits.
    pub fn new(
        skeleton: Arc<Skeleton>,
        poses: &[Transform],
        pins: &[BoneIndex],
        mode: IkMode,
        limits: Option<JointLimits>,
    ) -> Self {
        let bones = skeleton.len();
        let begun: Vec<Transform> = (0..bones)
            .map(|bone| match poses.get(bone) {
                Some(pose) if is_finite(pose) => *pose,
                _ => dragonfly_anim::sample::rest_pose(&skeleton.bones[bone]),
            })
            .collect();
        let mut to_root = vec![Mat4::IDENTITY; bones];
        dragonfly_anim::animation::to_root(&skeleton, &begun, &mut to_root);
        let mode = IkMode { length: mode.length.clamp(1, LONGEST_CHAIN), ..mode };
        let stood = |&bone: &BoneIndex| {
            let (_, rotation, place) = to_root.get(bone as usize)?.to_scale_rotation_translation();
            (place.is_finite() && rotation.is_finite()).then_some(PinnedPose { bone, place, rotation })
        };
        let pins: BTreeSet<BoneIndex> = pins.iter().copied().collect();
        // Bones nearer to the root first: the others depend on them.
        let pins = pins.iter().filter_map(stood).collect();
        Self {
            skeleton,
            limits,
            mode,
            poses: begun.clone(),
            begun_to_root: to_root.clone(),
            begun,
            pins,
            fixed: BTreeMap::new(),
            to_root,
            scratch: ChainScratch::default(),
        }
    }

    /// Adds bones that keep their pose relative to their parents: locked bones, and bones that are shown at rest. The
    /// other bones of a chain still reach, with these as stiff joints.
    #[must_use]
    pub fn with_fixed(mut self, bones: &[BoneIndex]) -> Self {
        let rotation = |&bone: &BoneIndex| Some((bone, self.begun.get(bone as usize)?.rotation));
        self.fixed = bones.iter().filter_map(rotation).collect();
        self
    }

    /// Replaces the pins by those of `other`, with their positions and rotations: to hold them in other poses of the
    /// same skeleton.
    #[must_use]
    pub fn with_pins_of(mut self, other: &Self) -> Self {
        self.pins.clone_from(&other.pins);
        self
    }

    /// Returns a position of the scene in the space of a bone's parent at the start of the drag; `None` where that
    /// space has no volume.
    pub fn in_parent(&self, bone: BoneIndex, place: Vec3) -> Option<Vec3> {
        let parent = self.skeleton.parent(bone).and_then(|parent| self.begun_to_root.get(parent as usize));
        let parent = parent.copied().unwrap_or(Mat4::IDENTITY).as_dmat4();
        let place = parent.inverse().transform_point3(place.as_dvec3()).as_vec3();
        place.is_finite().then_some(place)
    }

    /// Returns whether moving this bone rotates those above it.
    pub fn moves_by_chain(&self, bone: BoneIndex) -> bool {
        self.mode.on && self.skeleton.parent(bone).is_some()
    }

    /// Returns the position of a bone at the start of the drag, scene space.
    pub fn place(&self, bone: BoneIndex) -> Option<Vec3> {
        self.begun_to_root.get(bone as usize).map(|matrix| matrix.w_axis.truncate())
    }

    fn is_below(&self, bone: BoneIndex, above: &BTreeSet<BoneIndex>) -> bool {
        self.skeleton.with_ancestors(bone).any(|bone| above.contains(&bone))
    }

    /// Returns the position of the pole bone at the start of the drag, towards which the chain bends.
    fn pole(&self, end: BoneIndex) -> Option<Vec3> {
        let pole = self.mode.pole.filter(|&pole| pole != end)?;
        // A pole that is part of the chain, or below it, is ignored: it moves with the chain.
        let above: BTreeSet<BoneIndex> = row(&self.skeleton, end, self.mode.length).collect();
        let place = self.place(pole).filter(|place| place.is_finite());
        place.filter(|_| !self.is_below(pole, &above))
    }
}

/// Returns the poses (relative to the parents) of all bones that change when a drag sets `poses` and moves other bones
/// to `goals` by the bones above them, while pinned bones keep their positions and rotations.
///
/// Calls with the same bones return the same bones, so that each edit of a drag replaces the one before. They have the
/// given channels, and the rotations of all bones that follow. A goal out of reach is approached with the chain
/// stretched towards it. Non-finite numbers are ignored, and none is returned.
pub fn poses_of_drag(hold: &mut PoseDragState, poses: &[BonePose], goals: &[Goal]) -> Vec<BonePose> {
    let bones = hold.skeleton.len();
    hold.poses.copy_from_slice(&hold.begun);
    hold.to_root.copy_from_slice(&hold.begun_to_root);
    for (&bone, rotation) in &mut hold.fixed {
        *rotation = hold.begun[bone as usize].rotation;
    }
    let mut moved: BTreeSet<BoneIndex> = BTreeSet::new();
    let mut turned: BTreeSet<BoneIndex> = BTreeSet::new();
    let mut given: Vec<(BoneIndex, &BonePose)> = Vec::new();
    for pose in poses {
        let bone = match &pose.bone {
            BoneRef::Index(bone) => Some(*bone),
            BoneRef::Name(name) => hold.skeleton.find(name),
        };
        let Some(bone) = bone.filter(|&bone| (bone as usize) < bones) else { continue };
        apply_given(&mut hold.poses[bone as usize], pose);
        if let Some(rotation) = hold.fixed.get_mut(&bone) {
            *rotation = hold.poses[bone as usize].rotation;
        }
        given.push((bone, pose));
        moved.insert(bone);
    }
    let mut rows: Vec<Reaching> = Vec::new();
    for goal in goals.iter().filter(|goal| (goal.bone as usize) < bones) {
        let length = hold.mode.length;
        if hold.skeleton.parent(goal.bone).is_none() {
            continue;
        }
        let row: Vec<BoneIndex> = row(&hold.skeleton, goal.bone, length).collect();
        moved.extend(&row);
        moved.insert(goal.bone);
        turned.extend(row.iter().filter(|bone| !hold.fixed.contains_key(bone)));
        turned.insert(goal.bone);
        if goal.place.is_finite() && goal.place.abs().max_element() < 1e15 {
            let rotation = hold.begun_to_root[goal.bone as usize].to_scale_rotation_translation().1;
            let (rotation, pole) =
                (Some(rotation).filter(|rotation| rotation.is_finite()), hold.pole(goal.bone));
            rows.push(Reaching { end: goal.bone, length, place: goal.place, rotation, pole });
        }
    }
    let held: Vec<PinnedPose> = hold
        .pins
        .iter()
        .filter(|pin| {
            // Bones that are dragged are not held, and bones with nothing moved above them need not be.
            let parent = hold.skeleton.parent(pin.bone);
            let is_goal = goals.iter().any(|goal| goal.bone == pin.bone);
            let is_given = given.iter().any(|(bone, _)| *bone == pin.bone);
            !is_goal && !is_given && parent.is_some_and(|parent| hold.is_below(parent, &moved))
        })
        .copied()
        .collect();
    for pin in &held {
        let row: Vec<BoneIndex> = row(&hold.skeleton, pin.bone, hold.mode.length).collect();
        moved.extend(&row);
        turned.extend(row.into_iter().chain([pin.bone]).filter(|bone| !hold.fixed.contains_key(bone)));
    }
    solve(hold, &rows, &held);
    results(hold, &given, &turned)
}

/// Returns the poses (relative to the parents) of the chains that bring all pins back to their positions and
/// rotations, although nothing is dragged: for pins of another time. A bone without a parent cannot be held. A pin out
/// of reach is approached.
pub fn poses_of_pins(hold: &mut PoseDragState) -> Vec<BonePose> {
    hold.poses.copy_from_slice(&hold.begun);
    hold.to_root.copy_from_slice(&hold.begun_to_root);
    let hangs = |pin: &&PinnedPose| hold.skeleton.parent(pin.bone).is_some();
    let held: Vec<PinnedPose> = hold.pins.iter().filter(hangs).copied().collect();
    let mut turned: BTreeSet<BoneIndex> = BTreeSet::new();
    for pin in &held {
        let bones = row(&hold.skeleton, pin.bone, hold.mode.length).chain([pin.bone]);
        turned.extend(bones.filter(|bone| !hold.fixed.contains_key(bone)));
    }
    solve(hold, &[], &held);
    results(hold, &[], &turned)
}

/// Solves the chains of goals, then those of pins: twice, because one may move the base of another.
fn solve(hold: &mut PoseDragState, rows: &[Reaching], held: &[PinnedPose]) {
    let poles: Vec<Option<Vec3>> = held.iter().map(|pin| hold.pole(pin.bone)).collect();
    let mut work = ChainSolver {
        skeleton: &hold.skeleton,
        limits: hold.limits.as_ref(),
        fixed: &hold.fixed,
        poses: &mut hold.poses,
        to_root: &mut hold.to_root,
        scratch: &mut hold.scratch,
    };
    work.chain_poses();
    for reaching in rows {
        work.reach(reaching);
    }
    let rounds = if held.len() > 1 { 2 } else { 1 };
    for _ in 0..rounds {
        for (pin, &pole) in held.iter().zip(&poles) {
            work.reach(&Reaching {
                end: pin.bone,
                length: hold.mode.length,
                place: pin.place,
                rotation: Some(pin.rotation).filter(|_| !hold.fixed.contains_key(&pin.bone)),
                pole,
            });
        }
    }
}

fn results(
    hold: &PoseDragState,
    given: &[(BoneIndex, &BonePose)],
    turned: &BTreeSet<BoneIndex>,
) -> Vec<BonePose> {
    let finite = |bone: BoneIndex| {
        let pose = &hold.poses[bone as usize];
        if is_finite(pose) { *pose } else { hold.begun[bone as usize] }
    };
    let mut found: Vec<BonePose> = Vec::with_capacity(given.len() + turned.len());
    for &(bone, pose) in given {
        let now = finite(bone);
        let turns = pose.rotation.is_some() || turned.contains(&bone);
        found.push(BonePose {
            bone: BoneRef::Index(bone),
            translation: pose.translation.map(|_| now.translation.to_array()),
            rotation: turns.then(|| now.rotation.to_array()),
            scale: pose.scale.map(|_| now.scale.to_array()),
        });
    }
    for &bone in turned.iter().filter(|bone| given.iter().all(|(other, _)| other != *bone)) {
        let rotation = Some(finite(bone).rotation.to_array());
        found.push(BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None });
    }
    found
}

/// Applies the finite parts of a given pose.
fn apply_given(pose: &mut Transform, given: &BonePose) {
    if let Some(translation) = given.translation.map(Vec3::from).filter(|given| given.is_finite()) {
        pose.translation = translation;
    }
    let rotation = given.rotation.map(Quat::from_array);
    let usable = |given: &Quat| given.is_finite() && given.length() > 1e-6 && given.length().is_finite();
    if let Some(rotation) = rotation.filter(usable) {
        pose.rotation = rotation.normalize();
    }
    if let Some(scale) = given.scale.map(Vec3::from).filter(|given| given.is_finite()) {
        pose.scale = scale;
    }
}

fn is_finite(pose: &Transform) -> bool {
    pose.translation.is_finite() && pose.rotation.is_finite() && pose.scale.is_finite()
}
