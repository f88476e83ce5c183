//! Blending with masks: every bone has its own shares, and its own leading layer.
//!
//! Layers without weight are left out, before anything is computed, and in each block of eight bones the base where it
//! has no share. The weights of a block are computed once, and stay in registers for up to four layers.

use super::blend::{MOST, PoseLayer, WHOLE};
use super::mask::{LaneMask, MaskBlock, usable};
use super::pose::PoseBlock;
use super::simd::{Arithmetic, Float8, RowPair, Simd};

/// Sum of weights up to which a bone's shares need no division: more is not rounding.
const MORE: f32 = 2.0 - WHOLE;

/// Blends `layers`, of which some have masks.
#[inline(always)]
pub(super) fn with_masks<S: Simd>(
    base: &[PoseBlock],
    layers: &[PoseLayer],
    out: &mut [PoseBlock],
    normalized: bool,
) {
    let mut parts = [MaskedPose { pose: base, mask: None, weight: 0.0 }; MOST];
    let mut count = 0;
    for layer in layers {
        // NaN fails the comparison.
        if layer.weight > 0.0 {
            let Some(part) = parts.get_mut(count) else {
                return one_by_one::<S>(base, layers, out, normalized);
            };
            let mask = layer.mask.map(LaneMask::blocks);
            *part = MaskedPose { pose: layer.pose, mask, weight: usable(layer.weight) };
            count += 1;
        }
    }
    let (parts, blocks) = (&parts[..count], base.len().min(out.len()));
    let mut block = 0;
    while block < blocks {
        block = match *parts {
            [a] => dense::<S, 1>(base, [a], block, out, normalized),
            [a, b] => dense::<S, 2>(base, [a, b], block, out, normalized),
            [a, b, c] => dense::<S, 3>(base, [a, b, c], block, out, normalized),
            [a, b, c, d] => dense::<S, 4>(base, [a, b, c, d], block, out, normalized),
            _ => block,
        };
        if let (Some(base), Some(out)) = (base.get(block), out.get_mut(block)) {
            sparse::<S>(base, parts, block, out, normalized);
        }
        block += 1;
    }
}

/// A layer whose weight is not 0.
#[derive(Clone, Copy)]
struct MaskedPose<'a> {
    pose: &'a [PoseBlock],
    mask: Option<&'a [MaskBlock]>,
    weight: f32,
}

impl<'a> MaskedPose<'a> {
    /// Returns the pose and the mask of a block; `None` where the layer has no weight.
    #[inline(always)]
    fn block(&self, block: usize) -> Option<(&'a PoseBlock, &'a MaskBlock, f32)> {
        let mask = match self.mask {
            Some(mask) => mask.get(block)?,
            None => &MaskBlock::WHOLE,
        };
        let pose = self.pose.get(block)?;
        (!mask.is_zero).then_some((pose, mask, self.weight))
    }
}

/// Blends the blocks from `first` on in which every layer has weight, and returns the number of the next one.
#[inline(always)]
fn dense<S: Simd, const N: usize>(
    base: &[PoseBlock],
    parts: [MaskedPose; N],
    first: usize,
    out: &mut [PoseBlock],
    normalized: bool,
) -> usize {
    for (block, (out, base)) in out.iter_mut().zip(base).enumerate().skip(first) {
        let mut here = [(base, &MaskBlock::ZERO, 0.0); N];
        for (to, part) in here.iter_mut().zip(&parts) {
            let Some(of_part) = part.block(block) else { return block };
            *to = of_part;
        }
        masked::<S, N>(base, here, out, normalized);
    }
    out.len()
}

/// Blends the layers that have weight in a block.
#[inline(always)]
fn sparse<S: Simd>(
    base: &PoseBlock,
    parts: &[MaskedPose],
    block: usize,
    out: &mut PoseBlock,
    normalized: bool,
) {
    let (mut here, mut count) = ([(base, &MaskBlock::ZERO, 0.0); MOST], 0);
    for part in parts {
        if let (Some(of_part), Some(to)) = (part.block(block), here.get_mut(count)) {
            *to = of_part;
            count += 1;
        }
    }
    let [a, b, c, d] = here;
    match count {
        0 => *out = *base,
        1 => masked::<S, 1>(base, [a], out, normalized),
        2 => masked::<S, 2>(base, [a, b], out, normalized),
        3 => masked::<S, 3>(base, [a, b, c], out, normalized),
        _ => masked::<S, 4>(base, [a, b, c, d], out, normalized),
    }
}

/// Blends eight bones of layers that each have weight at some of them.
#[inline(always)]
fn masked<S: Simd, const N: usize>(
    base: &PoseBlock,
    parts: [(&PoseBlock, &MaskBlock, f32); N],
    out: &mut PoseBlock,
    normalized: bool,
) {
    let zero = S::F8::splat(0.0);
    let (mut weights, mut sum) = ([zero; N], zero);
    for (weight, (_, mask, whole)) in weights.iter_mut().zip(&parts) {
        *weight = S::F8::load(&mask.lanes) * S::F8::splat(*whole);
        sum = sum + *weight;
    }
    let BaseShare { short, weight: mut base_weight } = base_share::<S>(sum, normalized);
    if normalized || S::F8::splat(MORE).less(sum).any() {
        let total = S::F8::splat(1.0) / (base_weight + sum);
        base_weight = base_weight * total;
        for weight in &mut weights {
            *weight = *weight * total;
        }
    }
    let (mut leader, mut most) = (turn::<S>(base), base_weight);
    for (weight, (pose, ..)) in weights.iter().zip(&parts) {
        let leads = most.less(*weight);
        let ([xy, zw], [ab, cd]) = (turn::<S>(pose), leader);
        leader = [S::Pair::chosen(leads, xy, ab), S::Pair::chosen(leads, zw, cd)];
        most = weight.max(most);
    }
    let has_base = short.any();
    // One pass for rotations and one for vectors: both at once would need more registers than AVX2 has.
    let nothing = [S::Pair::all(0.0); 2];
    let mut rotation = if has_base { turned::<S>(base, base_weight, leader, nothing) } else { nothing };
    for (weight, (pose, ..)) in weights.iter().zip(&parts) {
        rotation = turned::<S>(pose, *weight, leader, rotation);
    }
    store_unit::<S>(rotation, out);
    let nothing = [S::Pair::all(0.0); 3];
    let mut vectors = if has_base { straight::<S>(base, base_weight, nothing) } else { nothing };
    for (weight, (pose, ..)) in weights.iter().zip(&parts) {
        vectors = straight::<S>(pose, *weight, vectors);
    }
    store_vectors::<S>(vectors, out);
}

/// Returns the rotations of eight bones: x and y, then z and w.
#[inline(always)]
fn turn<S: Simd>(pose: &PoseBlock) -> [S::Pair; 2] {
    let [x, y, z, w] = &pose.rotation;
    [S::Pair::from_rows(x, y), S::Pair::from_rows(z, w)]
}

/// Adds the rotations of `pose` to `sum`, in the hemisphere of `leader`.
#[inline(always)]
fn turned<S: Simd>(
    pose: &PoseBlock,
    share: S::F8,
    [ab, cd]: [S::Pair; 2],
    sum: [S::Pair; 2],
) -> [S::Pair; 2] {
    let [xy, zw] = turn::<S>(pose);
    let cosine = zw.times_plus(cd, xy * ab).sum();
    let share = S::Pair::both(share.flipped_by(cosine.sign()));
    [xy.times_plus(share, sum[0]), zw.times_plus(share, sum[1])]
}

/// Stores rotations, divided by their length.
#[inline(always)]
fn store_unit<S: Simd>([xy, zw]: [S::Pair; 2], out: &mut PoseBlock) {
    let square = zw.times_plus(zw, xy * xy).sum();
    let shrink = S::Pair::both(S::F8::splat(1.0) / square.sqrt());
    let [x, y, z, w] = &mut out.rotation;
    (xy * shrink).store_rows(x, y);
    (zw * shrink).store_rows(z, w);
}

/// Adds the translations and scales of `pose` to `sum`, two coordinates at a time.
#[inline(always)]
fn straight<S: Simd>(pose: &PoseBlock, share: S::F8, sum: [S::Pair; 3]) -> [S::Pair; 3] {
    let share = S::Pair::both(share);
    let ([x, y, z], [a, b, c]) = (&pose.translation, &pose.scale);
    let [xy, za, bc] = [S::Pair::from_rows(x, y), S::Pair::from_rows(z, a), S::Pair::from_rows(b, c)];
    [xy.times_plus(share, sum[0]), za.times_plus(share, sum[1]), bc.times_plus(share, sum[2])]
}

/// Stores translations and scales.
#[inline(always)]
fn store_vectors<S: Simd>([xy, za, bc]: [S::Pair; 3], out: &mut PoseBlock) {
    let ([x, y, z], [a, b, c]) = (&mut out.translation, &mut out.scale);
    xy.store_rows(x, y);
    za.store_rows(z, a);
    bc.store_rows(b, c);
}

/// Weight of the base, if the layers' weights do not reach 1.
struct BaseShare<S: Simd> {
    /// Mask of the bones at which it is not 0.
    short: S::F8,
    weight: S::F8,
}

#[inline(always)]
fn base_share<S: Simd>(sum: S::F8, normalized: bool) -> BaseShare<S> {
    let (zero, one) = (S::F8::splat(0.0), S::F8::splat(1.0));
    let (short, missing) = if normalized {
        (sum.less(S::F8::splat(f32::MIN_POSITIVE)), one)
    } else {
        (sum.less(S::F8::splat(WHOLE)), one - sum)
    };
    BaseShare { short, weight: short.select(missing, zero) }
}

/// Blends any number of layers.
#[inline(always)]
fn one_by_one<S: Simd>(base: &[PoseBlock], layers: &[PoseLayer], out: &mut [PoseBlock], normalized: bool) {
    let zero = S::F8::splat(0.0);
    for (block, (out, base)) in out.iter_mut().zip(base).enumerate() {
        let mut sum = zero;
        for layer in layers {
            sum = sum + weights::<S>(layer, block);
        }
        let BaseShare { short, weight: base_weight } = base_share::<S>(sum, normalized);
        let total = S::F8::splat(1.0) / (base_weight + sum);
        let mut leader = turn::<S>(base);
        let mut most = base_weight;
        for layer in layers {
            let Some(pose) = layer.pose.get(block) else { continue };
            let weight = weights::<S>(layer, block);
            let leads = most.less(weight);
            let ([xy, zw], [ab, cd]) = (turn::<S>(pose), leader);
            leader = [S::Pair::chosen(leads, xy, ab), S::Pair::chosen(leads, zw, cd)];
            most = weight.max(most);
        }
        let start = if short.any() { base_weight * total } else { zero };
        let mut rotation = turned::<S>(base, start, leader, [S::Pair::all(0.0); 2]);
        let mut vectors = straight::<S>(base, start, [S::Pair::all(0.0); 3]);
        for layer in layers {
            if let Some(pose) = layer.pose.get(block) {
                let share = weights::<S>(layer, block) * total;
                rotation = turned::<S>(pose, share, leader, rotation);
                vectors = straight::<S>(pose, share, vectors);
            }
        }
        store_unit::<S>(rotation, out);
        store_vectors::<S>(vectors, out);
    }
}

/// Returns the weights of `layer` in a block; 0 where it has none.
#[inline(always)]
fn weights<S: Simd>(layer: &PoseLayer, block: usize) -> S::F8 {
    let weight = if block < layer.pose.len() { usable(layer.weight) } else { 0.0 };
    match layer.mask {
        Some(mask) => S::F8::load(mask.block(block)) * S::F8::splat(weight),
        None => S::F8::splat(weight),
    }
}
