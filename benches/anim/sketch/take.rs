//! Takes of the sketch: keys at a uniform rate, three numbers of 16 bits per rotation and per translation.

use super::flushed;
use dragonfly_anim::data::{Skeleton, Take, Transform};
use dragonfly_anim::fast::simd::{Float8, Simd};
use dragonfly_anim::fast::{Pose, PoseBlock};
use dragonfly_anim::sample::sample_take;
use glam::Quat;

/// Sets tiny numbers to zero.
fn flush(pose: &mut Transform) {
    pose.translation = pose.translation.to_array().map(flushed).into();
    pose.rotation = Quat::from_array(pose.rotation.to_array().map(flushed));
}

type PackedKey = [[u16; 8]; 3];

/// Range of the numbers of eight bones: the smallest, the size of a step, and the component that is left out.
#[derive(Clone, Default)]
struct BlockRange {
    least: [[f32; 8]; 3],
    step: [[f32; 8]; 3],
    /// Masks of the lanes whose left-out component is at most 0, at most 1, and at most 2.
    left_out: [[f32; 8]; 3],
}

/// The blocks that move, with their ranges and their keys, frame by frame.
#[derive(Default)]
struct MovingBlocks {
    blocks: Vec<usize>,
    ranges: Vec<BlockRange>,
    keys: Vec<PackedKey>,
}

pub(super) struct SketchTake {
    start: f32,
    rate: f32,
    frames: usize,
    rotations: MovingBlocks,
    translations: MovingBlocks,
    base: Pose,
}

impl SketchTake {
    pub(super) fn new(skeleton: &Skeleton, take: &Take) -> Self {
        let frames = ((take.length * 30.0).round() as usize + 1).max(2);
        let rate = if take.length > 0.0 { (frames - 1) as f32 / take.length } else { 1.0 };
        let mut poses = vec![vec![Transform::IDENTITY; skeleton.len()]; frames];
        for (frame, poses) in poses.iter_mut().enumerate() {
            sample_take(Some(take), skeleton, take.start + frame as f32 / rate, poses);
            poses.iter_mut().for_each(flush);
        }
        let base = Pose::from_transforms(&poses[0]);
        let mut new = Self {
            start: take.start,
            rate,
            frames,
            rotations: MovingBlocks::default(),
            translations: MovingBlocks::default(),
            base,
        };
        new.pack(&poses);
        new
    }

    fn pack(&mut self, poses: &[Vec<Transform>]) {
        let bones = poses[0].len();
        let mut rotations = Vec::new();
        for bone in 0..bones {
            rotations.push(three_of_four(
                &poses.iter().map(|pose| pose[bone].rotation.to_array()).collect::<Vec<_>>(),
            ));
        }
        for block in 0..bones.div_ceil(8) {
            let here = block * 8..(block * 8 + 8).min(bones);
            let turned: Vec<Vec<[f32; 3]>> = here.clone().map(|bone| rotations[bone].1.clone()).collect();
            let moved: Vec<Vec<[f32; 3]>> = here
                .clone()
                .map(|bone| poses.iter().map(|pose| pose[bone].translation.to_array()).collect())
                .collect();
            let left_out: Vec<usize> = here.map(|bone| rotations[bone].0).collect();
            self.rotations.add(block, &turned, &left_out);
            self.translations.add(block, &moved, &[]);
        }
        self.rotations.by_frame(self.frames);
        self.translations.by_frame(self.frames);
    }

    #[inline(always)]
    pub(super) fn sample<S: Simd>(&self, time: f32, pose: &mut [PoseBlock]) {
        let at = ((time - self.start) * self.rate).clamp(0.0, (self.frames - 1) as f32);
        let frame = (at as usize).min(self.frames - 2);
        let mix = S::F8::splat(at - frame as f32);
        pose.copy_from_slice(self.base.blocks());
        for (block, range, before, after) in self.rotations.around(frame) {
            let (before, after) = (unpack::<S>(before, range), unpack::<S>(after, range));
            let a = (after[0] - before[0]).mul_add(mix, before[0]);
            let b = (after[1] - before[1]).mul_add(mix, before[1]);
            let c = (after[2] - before[2]).mul_add(mix, before[2]);
            let d = (after[3] - before[3]).mul_add(mix, before[3]);
            let length = d.mul_add(d, c.mul_add(c, b.mul_add(b, a * a)));
            let shrink = S::F8::splat(1.0) / length.sqrt();
            let (a, b, c, d) = (a * shrink, b * shrink, c * shrink, d * shrink);
            let [first, second, third] = S::F8::load_three(&range.left_out);
            let out = &mut pose[block].rotation;
            first.select(d, a).store(&mut out[0]);
            second.select(first.select(a, d), b).store(&mut out[1]);
            third.select(second.select(b, d), c).store(&mut out[2]);
            third.select(c, d).store(&mut out[3]);
        }
        for (block, range, before, after) in self.translations.around(frame) {
            for at in 0..3 {
                let (before, after) = (S::F8::from_u16(&before[at]), S::F8::from_u16(&after[at]));
                let mixed = (after - before).mul_add(mix, before);
                let (step, least) = (S::F8::load(&range.step[at]), S::F8::load(&range.least[at]));
                mixed.mul_add(step, least).store(&mut pose[block].translation[at]);
            }
        }
    }
}

/// Returns the three stored numbers, and the fourth from the length of 1.
#[inline(always)]
fn unpack<S: Simd>(key: &PackedKey, range: &BlockRange) -> [S::F8; 4] {
    let (step, least) = (S::F8::load_three(&range.step), S::F8::load_three(&range.least));
    let a = S::F8::from_u16(&key[0]).mul_add(step[0], least[0]);
    let b = S::F8::from_u16(&key[1]).mul_add(step[1], least[1]);
    let c = S::F8::from_u16(&key[2]).mul_add(step[2], least[2]);
    let rest = c.neg_mul_add(c, b.neg_mul_add(b, a.neg_mul_add(a, S::F8::splat(1.0))));
    [a, b, c, rest.max(S::F8::splat(0.0)).sqrt()]
}

impl MovingBlocks {
    /// Adds a block if anything in it moves.
    fn add(&mut self, block: usize, bones: &[Vec<[f32; 3]>], left_out: &[usize]) {
        let mut range = BlockRange::default();
        let mut moves = false;
        for (lane, keys) in bones.iter().enumerate() {
            for at in 0..3 {
                let numbers = || keys.iter().map(|key| key[at]);
                let (least, most) = (numbers().fold(f32::MAX, f32::min), numbers().fold(f32::MIN, f32::max));
                (range.least[at][lane], range.step[at][lane]) = (least, (most - least) / 65_535.0);
                moves |= most - least > 1e-5;
                let is = left_out.get(lane).is_some_and(|&component| component <= at);
                range.left_out[at][lane] = f32::from_bits(if is { u32::MAX } else { 0 });
            }
        }
        if !moves {
            return;
        }
        for frame in 0..bones[0].len() {
            let mut key = [[0; 8]; 3];
            for (lane, keys) in bones.iter().enumerate() {
                for at in 0..3 {
                    let step = range.step[at][lane];
                    let steps =
                        if step > 0.0 { (keys[frame][at] - range.least[at][lane]) / step } else { 0.0 };
                    key[at][lane] = (steps + 0.5) as u16;
                }
            }
            self.keys.push(key);
        }
        self.blocks.push(block);
        self.ranges.push(range);
    }

    /// Reorders the keys from block by block to frame by frame.
    fn by_frame(&mut self, frames: usize) {
        let blocks = self.blocks.len();
        self.keys = (0..frames)
            .flat_map(|frame| (0..blocks).map(move |block| block * frames + frame))
            .map(|at| self.keys[at])
            .collect();
    }

    #[inline(always)]
    fn around(&self, frame: usize) -> impl Iterator<Item = (usize, &BlockRange, &PackedKey, &PackedKey)> {
        let count = self.blocks.len();
        let (before, after) = self.keys[frame * count..(frame + 2) * count].split_at(count);
        let keys = self.blocks.iter().zip(&self.ranges).zip(before).zip(after);
        keys.map(|(((&block, range), before), after)| (block, range, before, after))
    }
}

/// Returns the index of the component to leave out, and the other three at every key, with signs for which the left-out
/// one is positive.
fn three_of_four(keys: &[[f32; 4]]) -> (usize, Vec<[f32; 3]>) {
    let least = |component: usize| keys.iter().map(|key| key[component].abs()).fold(f32::MAX, f32::min);
    let left_out = (0..4).max_by(|&a, &b| least(a).total_cmp(&least(b))).unwrap_or(3);
    let three = |key: &[f32; 4]| {
        let sign = key[left_out].signum();
        let mut others =
            (0..4).filter(|&component| component != left_out).map(|component| key[component] * sign);
        [(); 3].map(|()| others.next().unwrap_or_default())
    };
    (left_out, keys.iter().map(three).collect())
}
