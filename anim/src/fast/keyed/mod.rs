//! A take with its original keys, in a layout that is sampled eight bones at once.
//!
//! ```text
//! keys of rotations, tracks that share their times:   key 0: block, block, …   key 1: block, block, …
//! a block: the same eight bones as in the pose, x of all eight, then y, z, w
//! ```
//!
//! The two keys around a time are two neighboring ranges of memory. Eight bones that are keyed at different times get
//! the union of their times; the inserted keys are the values of the open path there, so nothing moves. Constant
//! channels have no track but are in the take's [`StillPose`]. Numbers are not packed: that is for compressed takes.
//!
//! Linear channels are played this way. Those of another interpolation, and ones whose times do not ascend, are played
//! by the open path itself, one by one ([`KeyedTake::fallback_channels`] returns their number).

mod build;
mod tracks;

use super::playable::Playable;
use super::pose::PoseBlock;
use super::simd::{Float8, LANES, Simd};
use super::slerp::FastSlerp;
use super::still::StillPose;
use crate::data::{Channel, Skeleton, Take, Transform};
use crate::sample::sample_channel;
use glam::{Quat, Vec3};
use std::sync::Arc;
use tracks::Tracks;

/// A take for the fast path, its keys unchanged. See the top of its module for the layout.
#[derive(Clone, Debug)]
pub struct KeyedTake {
    start: f32,
    length: f32,
    bones: usize,
    still: Arc<StillPose>,
    rotations: Vec<Tracks<4>>,
    translations: Vec<Tracks<3>>,
    scales: Vec<Tracks<3>>,
    fallback: Vec<FallbackChannel>,
}

/// A channel that the open path plays.
#[derive(Clone, Debug)]
enum FallbackChannel {
    Rotation(usize, Channel<Quat>, Quat),
    Translation(usize, Channel<Vec3>, Vec3),
    Scale(usize, Channel<Vec3>, Vec3),
}

impl KeyedTake {
    /// Converts `take` for the bones of `skeleton`. Bones without a track keep their rest pose.
    ///
    /// Takes about the memory of the take's own keys where all bones of a block are keyed at the same times, at most
    /// about six times it where each is keyed alone, and at most six times that where every rotation is wide enough to
    /// be cut into steps (more than 35° from key to key).
    pub fn new(skeleton: &Skeleton, take: &Take) -> Self {
        build::build(skeleton, take)
    }

    /// Returns the number of channels that the open path plays, because their interpolation is not linear or their
    /// times do not ascend.
    pub fn fallback_channels(&self) -> usize {
        self.fallback.len()
    }

    /// Returns the size of the keys in bytes.
    pub fn key_bytes(&self) -> usize {
        let rotations = self.rotations.iter().map(Tracks::key_bytes).sum::<usize>();
        let vectors = self.translations.iter().chain(&self.scales).map(Tracks::key_bytes).sum::<usize>();
        rotations + vectors
    }

    /// Samples the channels that the open path plays.
    #[cold]
    fn sample_fallback(&self, time: f32, out: &mut [PoseBlock]) {
        for fallback in &self.fallback {
            let (FallbackChannel::Rotation(bone, ..)
            | FallbackChannel::Translation(bone, ..)
            | FallbackChannel::Scale(bone, ..)) = fallback;
            let Some(block) = out.get_mut(bone / LANES) else { continue };
            let pose = block.get(*bone);
            let pose = match fallback {
                FallbackChannel::Rotation(_, channel, rest) => {
                    Transform { rotation: sample_channel(channel, *rest, time), ..pose }
                }
                FallbackChannel::Translation(_, channel, rest) => {
                    Transform { translation: sample_channel(channel, *rest, time), ..pose }
                }
                FallbackChannel::Scale(_, channel, rest) => {
                    Transform { scale: sample_channel(channel, *rest, time), ..pose }
                }
            };
            block.set(*bone, pose);
        }
    }
}

impl Playable for KeyedTake {
    fn bones(&self) -> usize {
        self.bones
    }

    fn start(&self) -> f32 {
        self.start
    }

    fn length(&self) -> f32 {
        self.length
    }

    fn still(&self) -> &Arc<StillPose> {
        &self.still
    }

    #[inline(always)]
    fn sample_moving_with<S: Simd>(&self, time: f32, out: &mut [PoseBlock]) {
        for tracks in &self.rotations {
            let (slerp, keys) = tracks.around::<S>(time);
            for (block, before, after) in keys {
                let Some(out) = out.get_mut(block as usize) else { continue };
                let turned = slerp.turn(S::F8::load_four(before), S::F8::load_four(after));
                S::F8::store_four(turned, &mut out.rotation);
            }
        }
        for tracks in &self.translations {
            let (slerp, keys) = tracks.around::<S>(time);
            for (block, before, after) in keys {
                let Some(out) = out.get_mut(block as usize) else { continue };
                straight::<S>(&slerp, before, after, &mut out.translation);
            }
        }
        for tracks in &self.scales {
            let (slerp, keys) = tracks.around::<S>(time);
            for (block, before, after) in keys {
                let Some(out) = out.get_mut(block as usize) else { continue };
                straight::<S>(&slerp, before, after, &mut out.scale);
            }
        }
        if !self.fallback.is_empty() {
            self.sample_fallback(time, out);
        }
    }
}

#[inline(always)]
fn straight<S: Simd>(
    slerp: &FastSlerp<S>,
    before: &[[f32; LANES]; 3],
    after: &[[f32; LANES]; 3],
    out: &mut [[f32; LANES]; 3],
) {
    for ((out, before), after) in out.iter_mut().zip(before).zip(after) {
        slerp.straight(S::F8::load(before), S::F8::load(after)).store(out);
    }
}
