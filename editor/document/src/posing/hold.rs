//! What a hand holds while it drags: how everything stood, which bones are pinned, whether rows of bones follow.

use super::reach::{Reaching, Work, parent_of, row};
use crate::edit::{BonePose, BoneRef};
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_anim::ik::ChainScratch;
use dragonfly_anim::joint::JointLimits;
use glam::{Mat4, Quat, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Most bones that follow a hand.
pub const LONGEST_CHAIN: u32 = 255;

/// Do the bones above follow when one is moved?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IkMode {
    /// Else the bone alone moves.
    pub on: bool,
    /// How many bones above the one that is moved turn; 1 to [`LONGEST_CHAIN`]. Two are an arm or a leg.
    pub length: u32,
    /// The bone towards which elbows and knees bend; none: as they are bent.
    pub pole: Option<BoneIndex>,
}

impl Default for IkMode {
    fn default() -> Self {
        Self { on: false, length: 2, pole: None }
    }
}

/// Where a bone is to come by the bones above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Which bone.
    pub bone: BoneIndex,
    /// Scene space.
    pub place: Vec3,
}

/// How a bone stood in the scene.
#[derive(Clone, Copy, Debug)]
struct Stood {
    bone: BoneIndex,
    place: Vec3,
    rotation: Quat,
}

/// What is kept from the begin of a drag to its end; nothing is allocated for the bones of the model while it lasts.
#[derive(Debug)]
pub struct Hold {
    skeleton: Arc<Skeleton>,
    limits: Option<JointLimits>,
    mode: IkMode,
    begun: Vec<Transform>,
    begun_to_root: Vec<Mat4>,
    pins: Vec<Stood>,
    /// Bones that no row turns, with the rotations that they keep.
    fixed: BTreeMap<BoneIndex, Quat>,
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
    scratch: ChainScratch,
}

impl Hold {
    /// Everything as it stands: `poses` relative to the parents, one a bone (what is missing or not finite rests), and
    /// the bones that are pinned there. Limits are honoured by the rows of bones that have any.
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
            (place.is_finite() && rotation.is_finite()).then_some(Stood { bone, place, rotation })
        };
        let pins: BTreeSet<BoneIndex> = pins.iter().copied().collect();
        // Those nearer to the root first: the others hang on them.
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

    /// The same with bones that stay as they are relative to their parents, whatever follows: those that are locked or seen
    /// at rest. The others of a row go on to reach, with these as stiff joints.
    #[must_use]
    pub fn with_fixed(mut self, bones: &[BoneIndex]) -> Self {
        let rotation = |&bone: &BoneIndex| Some((bone, self.begun.get(bone as usize)?.rotation));
        self.fixed = bones.iter().filter_map(rotation).collect();
        self
    }

    /// The same with the pins of `other`, where and how they stood there: to hold them in other poses of the same skeleton.
    #[must_use]
    pub fn with_pins_of(mut self, other: &Self) -> Self {
        self.pins.clone_from(&other.pins);
        self
    }

    /// Where a place of the scene lies in the space of a bone's parent, as that stood when the drag began; `None` where it
    /// has no volume.
    pub fn in_parent(&self, bone: BoneIndex, place: Vec3) -> Option<Vec3> {
        let parent =
            parent_of(&self.skeleton, bone).and_then(|parent| self.begun_to_root.get(parent as usize));
        let parent = parent.copied().unwrap_or(Mat4::IDENTITY).as_dmat4();
        let place = parent.inverse().transform_point3(place.as_dvec3()).as_vec3();
        place.is_finite().then_some(place)
    }

    /// Does this bone, when it is moved, take those above it along?
    pub fn moves_by_chain(&self, bone: BoneIndex) -> bool {
        self.mode.on && parent_of(&self.skeleton, bone).is_some()
    }

    /// Where a bone stood when the drag began, scene space.
    pub fn place(&self, bone: BoneIndex) -> Option<Vec3> {
        self.begun_to_root.get(bone as usize).map(|matrix| matrix.w_axis.truncate())
    }

    fn is_below(&self, bone: BoneIndex, above: &BTreeSet<BoneIndex>) -> bool {
        let parent = |bone: &BoneIndex| parent_of(&self.skeleton, *bone);
        std::iter::successors(Some(bone), parent).any(|bone| above.contains(&bone))
    }

    /// How far it bends: a row by itself, or the pole bone where it stood.
    fn pole(&self, end: BoneIndex) -> Option<Vec3> {
        let pole = self.mode.pole.filter(|&pole| pole != end)?;
        // A bone of the row, or one below it, says nothing: it moves along.
        let above: BTreeSet<BoneIndex> = row(&self.skeleton, end, self.mode.length).collect();
        let place = self.place(pole).filter(|place| place.is_finite());
        place.filter(|_| !self.is_below(pole, &above))
    }
}

/// The poses (relative to the parents) of all bones that change when a hand gives bones `poses` and brings others to
/// `goals` by the bones above them, and pinned bones stay where and how they were.
///
/// The same bones come out in every call with the same bones named, so that a drag is one edit in ever newer form; of the
/// channels those that the hand gave, and the rotations of all that followed. What cannot be reached is come near to, with
/// the row stretched towards it. Numbers that are not finite are as if they were not given; none comes out.
pub fn poses_of_drag(hold: &mut Hold, poses: &[BonePose], goals: &[Goal]) -> Vec<BonePose> {
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
        give(&mut hold.poses[bone as usize], pose);
        if let Some(rotation) = hold.fixed.get_mut(&bone) {
            *rotation = hold.poses[bone as usize].rotation;
        }
        given.push((bone, pose));
        moved.insert(bone);
    }
    let mut rows: Vec<Reaching> = Vec::new();
    for goal in goals.iter().filter(|goal| (goal.bone as usize) < bones) {
        let length = hold.mode.length;
        if parent_of(&hold.skeleton, goal.bone).is_none() {
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
    let held: Vec<Stood> = hold
        .pins
        .iter()
        .filter(|pin| {
            // What the hand itself moves is not held; what nothing above moves need not be.
            let parent = parent_of(&hold.skeleton, pin.bone);
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

/// The poses (relative to the parents) of the rows of bones that bring all pins to where and how they stood, though nothing
/// is moved: for pins of another time. What hangs on nothing cannot be held. What cannot be reached is come near to.
pub fn poses_of_pins(hold: &mut Hold) -> Vec<BonePose> {
    hold.poses.copy_from_slice(&hold.begun);
    hold.to_root.copy_from_slice(&hold.begun_to_root);
    let hangs = |pin: &&Stood| parent_of(&hold.skeleton, pin.bone).is_some();
    let held: Vec<Stood> = hold.pins.iter().filter(hangs).copied().collect();
    let mut turned: BTreeSet<BoneIndex> = BTreeSet::new();
    for pin in &held {
        let bones = row(&hold.skeleton, pin.bone, hold.mode.length).chain([pin.bone]);
        turned.extend(bones.filter(|bone| !hold.fixed.contains_key(bone)));
    }
    solve(hold, &[], &held);
    results(hold, &[], &turned)
}

/// The rows that reach, then those that hold: twice, as one may move what another stands on.
fn solve(hold: &mut Hold, rows: &[Reaching], held: &[Stood]) {
    let poles: Vec<Option<Vec3>> = held.iter().map(|pin| hold.pole(pin.bone)).collect();
    let mut work = Work {
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

fn results(hold: &Hold, given: &[(BoneIndex, &BonePose)], turned: &BTreeSet<BoneIndex>) -> Vec<BonePose> {
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

/// Puts what the hand gives over a pose, where it is finite.
fn give(pose: &mut Transform, given: &BonePose) {
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
