//! From takes to matrices for the GPU in one call: one character, or a whole crowd.
//!
//! ```text
//! for each character:         sample each of its layers → blend
//! for a register of them, or one: to_root → final_pose of every joint
//! ```
//!
//! All steps of eight or sixteen characters run before the next ones', so poses and to-root matrices stay in the nearest cache
//! ([`Scratch`], shared by all); a character itself is only its takes, times and weights. The characters that remain
//! when a crowd is divided by that number are computed one by one; that gives the same bits.

use super::binding::SkinBinding;
use super::blend::{Blend, PoseLayer};
use super::crowd::{Crowd, CrowdFinals};
use super::mask::{LaneMask, usable};
use super::matrix::Matrix34;
use super::one_character::CharacterFinals;
use super::playable::Playable;
use super::played::{LocalPoses, PlayedPose};
use super::pose::Pose;
use super::rig::Rig;
use super::simd::{Kernel, MOST_LANES, Many, Simd, SimdLevel};
use super::still::StillPose;
use super::to_root::RootPoses;
use std::sync::Arc;

/// A take that a character plays, possibly with others.
#[derive(Debug)]
pub struct Playing<'a, T> {
    /// The take to play.
    pub take: &'a T,
    /// Seconds, inside the take: see [`crate::sample::loop_time`].
    pub time: f32,
    /// Weight relative to the character's other layers, 0 or more; the rest pose gets the remainder up to 1.
    pub weight: f32,
    /// Weight of each bone; `None`: 1 for all.
    pub mask: Option<&'a LaneMask>,
}

impl<'a, T> Playing<'a, T> {
    /// Plays all bones of `take`, at `time` seconds.
    pub fn new(take: &'a T, time: f32) -> Self {
        Self { take, time, weight: 1.0, mask: None }
    }

    /// Returns whether this layer alone determines the whole pose.
    fn is_all(&self) -> bool {
        self.weight >= 1.0 && self.mask.is_none()
    }
}

// Deriving `Clone` and `Copy` would require them of `T`.
impl<T> Clone for Playing<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Playing<'_, T> {}

/// Memory that the characters of a call use one after the other.
///
/// It keeps what does not move of the takes that were played most recently: a scratch for each character, or for
/// characters that play the same take, saves computing it anew. The results are the same.
#[derive(Clone, Debug)]
pub struct Scratch {
    sampled: Vec<PlayedPose>,
    blended: PlayedPose,
    to_parent: LocalPoses,
    to_root: RootPoses,
    crowd: Crowd,
}

/// Number of layers of one character that are blended within a [`Scratch`], without more memory. Further layers are
/// left out.
pub const MAX_LAYERS: usize = 8;

impl Scratch {
    /// Allocates memory for characters of `rig`.
    pub fn new(rig: &Rig) -> Self {
        let pose = PlayedPose::new(rig);
        Self {
            sampled: vec![pose.clone(); MAX_LAYERS],
            blended: pose,
            to_parent: LocalPoses::new(rig),
            to_root: RootPoses::new(rig),
            crowd: Crowd::new(rig),
        }
    }

    /// Returns the pose of the character that [`pose_character`] computed most recently, relative to the parents: for
    /// [`super::to_root()`] of bones to which something is attached.
    pub fn pose(&self) -> &Pose {
        self.blended.pose()
    }
}

/// Computes the final poses of a character that plays `layers`: one matrix per joint of `binding`, up to the length of
/// `out`.
///
/// Several layers are blended as by [`super::blend()`]; without any the result is the rest pose. `scratch` has to be
/// made for `rig`. Allocates nothing.
pub fn pose_character<T: Playable>(
    level: SimdLevel,
    rig: &Rig,
    binding: &SkinBinding,
    layers: &[Playing<T>],
    scratch: &mut Scratch,
    out: &mut [Matrix34],
) {
    level.run(OneCharacter { rig, binding, layers, scratch, out });
}

/// Computes the final poses of many characters of one rig: those of character `c` from `c * binding.joints()` on.
///
/// Each item of `characters` is the list of layers that one character plays. Characters past the end of `out` are left
/// out. Otherwise as [`pose_character`]. Allocates nothing.
pub fn pose_crowd<'a, T: Playable + 'a>(
    level: SimdLevel,
    rig: &Rig,
    binding: &SkinBinding,
    characters: impl IntoIterator<Item = &'a [Playing<'a, T>]>,
    scratch: &mut Scratch,
    out: &mut [Matrix34],
) {
    level.run(ManyCharacters { rig, binding, characters: &mut characters.into_iter(), scratch, out });
}

struct OneCharacter<'a, T> {
    rig: &'a Rig,
    binding: &'a SkinBinding,
    layers: &'a [Playing<'a, T>],
    scratch: &'a mut Scratch,
    out: &'a mut [Matrix34],
}

impl<T: Playable> Kernel for OneCharacter<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { rig, binding, layers, scratch, out } = self;
        character::<S, T>(rig, binding, layers, scratch, out);
    }
}

struct ManyCharacters<'a, 'p, T> {
    rig: &'a Rig,
    binding: &'a SkinBinding,
    /// Of any type: the kernel is compiled once for all of them.
    characters: &'a mut dyn Iterator<Item = &'p [Playing<'p, T>]>,
    scratch: &'a mut Scratch,
    out: &'a mut [Matrix34],
}

impl<T: Playable> Kernel for ManyCharacters<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { rig, binding, characters, scratch, out } = self;
        let joints = binding.joints().max(1);
        // The exact matrices of a sheared rest pose are put in for one character at a time. Where eight numbers need
        // more than one register, there are too few of them.
        let together = S::IS_WIDE && rig.sheared.is_empty();
        let most = S::Many::COUNT;
        for out in out.chunks_mut(most * joints) {
            let mut group: [&[Playing<T>]; MOST_LANES] = [&[]; MOST_LANES];
            let mut count = 0;
            for (slot, layers) in group.iter_mut().zip((&mut *characters).take(out.len().div_ceil(joints))) {
                *slot = layers;
                count += 1;
            }
            let is_full = count == most && out.len() == most * joints;
            if S::IS_WIDE && together && is_full && at_once::<S, T>(rig, binding, &group, scratch, out) {
                continue;
            }
            for (layers, out) in group.iter().take(count).zip(out.chunks_mut(joints)) {
                character::<S, T>(rig, binding, layers, scratch, out);
            }
        }
    }
}

/// Computes the final matrices of one character.
#[inline(always)]
fn character<S: Simd, T: Playable>(
    rig: &Rig,
    binding: &SkinBinding,
    layers: &[Playing<T>],
    scratch: &mut Scratch,
    out: &mut [Matrix34],
) {
    let Scratch { sampled, blended, to_parent, to_root, .. } = scratch;
    pose::<S, T>(rig, layers, sampled, blended);
    S::call(CharacterFinals { rig, binding, played: blended, locals: to_parent, roots: to_root, out });
}

/// Computes the final matrices of a full register of characters, and returns whether all numbers are finite; otherwise
/// the characters have to be computed one by one.
#[inline(always)]
fn at_once<S: Simd, T: Playable>(
    rig: &Rig,
    binding: &SkinBinding,
    group: &[&[Playing<T>]; MOST_LANES],
    scratch: &mut Scratch,
    out: &mut [Matrix34],
) -> bool {
    let Scratch { sampled, crowd, .. } = scratch;
    crowd.assign(&std::array::from_fn(|at| still(group[at])), S::Many::COUNT);
    for (lane, layers) in group.iter().enumerate().take(S::Many::COUNT) {
        pose::<S, T>(rig, layers, sampled, crowd.pose(lane));
    }
    S::call(CrowdFinals { crowd, rig, binding, out })
}

/// Computes the pose of one character.
#[inline(always)]
fn pose<S: Simd, T: Playable>(
    rig: &Rig,
    layers: &[Playing<T>],
    sampled: &mut [PlayedPose],
    out: &mut PlayedPose,
) {
    match layers {
        [one] if one.is_all() => out.play::<S, T>(rig, one.take, one.time),
        _ => blend_layers::<S, T>(rig, layers, sampled, out),
    }
}

/// Returns what does not move of the take that alone determines the pose; `None` for several layers.
#[inline(always)]
fn still<'a, T: Playable>(layers: &[Playing<'a, T>]) -> Option<&'a Arc<StillPose>> {
    match layers {
        [one] if one.is_all() => Some(one.take.still()),
        _ => None,
    }
}

/// Samples and blends `layers`.
#[inline(always)]
fn blend_layers<S: Simd, T: Playable>(
    rig: &Rig,
    layers: &[Playing<T>],
    sampled: &mut [PlayedPose],
    blended: &mut PlayedPose,
) {
    let mut count = 0;
    for (layer, pose) in layers.iter().zip(&mut *sampled) {
        if usable(layer.weight) > 0.0 {
            pose.play::<S, T>(rig, layer.take, layer.time);
        }
        count += 1;
    }
    let nothing = PoseLayer { pose: &[], weight: 0.0, mask: None };
    let mut list = [nothing; MAX_LAYERS];
    for ((out, layer), pose) in list.iter_mut().zip(layers).zip(&*sampled) {
        *out = PoseLayer { pose: pose.blocks(), weight: layer.weight, mask: layer.mask };
    }
    let (base, layers, out) = (rig.rest().blocks(), &list[..count], blended.blocks_mut());
    S::call(Blend { base, layers, out, normalized: false });
}
