//! Blending with masks: every bone has its own shares, and its own leading layer.
//!
//! Layers without weight are left out, before anything is computed, and in each block of eight bones the base where it
//! has no share. The weights of a block are computed once, and stay in registers for up to four layers.

use super::blend::{MOST, PoseLayer, WHOLE};
use super::mask::{LaneMask, MaskBlock, usable};
use super::pose::PoseBlock;
use super::simd::{Float8, LANES, Simd};
use super::slerp::{dot, unit};

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
    for (block, (out, base)) in out.iter_mut().zip(base).enumerate() {
        let (mut here, mut count_here) = ([(base, &MaskBlock::ZERO, 0.0); MOST], 0);
        for part in &parts[..count] {
            let mask = part.mask.map_or(Some(&MaskBlock::WHOLE), |mask| mask.get(block));
            if let (Some(pose), Some(mask)) = (part.pose.get(block), mask)
                && !mask.is_zero
                && let Some(to) = here.get_mut(count_here)
            {
                *to = (pose, mask, part.weight);
                count_here += 1;
            }
        }
        let [a, b, c, d] = here;
        match count_here {
            0 => *out = *base,
            1 => masked::<S, 1>(base, [a], out, normalized),
            2 => masked::<S, 2>(base, [a, b], out, normalized),
            3 => masked::<S, 3>(base, [a, b, c], out, normalized),
            _ => masked::<S, 4>(base, [a, b, c, d], out, normalized),
        }
    }
}

/// A layer whose weight is not 0.
#[derive(Clone, Copy)]
struct MaskedPose<'a> {
    pose: &'a [PoseBlock],
    mask: Option<&'a [MaskBlock]>,
    weight: f32,
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
    let (mut leader, mut most) = (S::F8::load_four(&base.rotation), base_weight);
    for (weight, (pose, ..)) in weights.iter().zip(&parts) {
        let leads = most.less(*weight);
        let [x, y, z, w] = S::F8::load_four(&pose.rotation);
        let [a, b, c, d] = leader;
        leader = [leads.select(x, a), leads.select(y, b), leads.select(z, c), leads.select(w, d)];
        most = weight.max(most);
    }
    let has_base = short.any();
    // One pass for rotations and one for vectors: both at once would need more registers than AVX2 has.
    let mut rotation = if has_base { turned::<S>(base, base_weight, leader, [zero; 4]) } else { [zero; 4] };
    for (weight, (pose, ..)) in weights.iter().zip(&parts) {
        rotation = turned::<S>(pose, *weight, leader, rotation);
    }
    S::F8::store_four(unit::<S>(rotation), &mut out.rotation);
    let start = if has_base { base_weight } else { zero };
    let mut moved = straight::<S>(&base.translation, start, [zero; 3]);
    let mut scaled = straight::<S>(&base.scale, start, [zero; 3]);
    for (weight, (pose, ..)) in weights.iter().zip(&parts) {
        moved = straight::<S>(&pose.translation, *weight, moved);
        scaled = straight::<S>(&pose.scale, *weight, scaled);
    }
    S::F8::store_three(moved, &mut out.translation);
    S::F8::store_three(scaled, &mut out.scale);
}

/// Adds the rotations of `pose` to `sum`, in the hemisphere of `leader`.
#[inline(always)]
fn turned<S: Simd>(
    pose: &PoseBlock,
    share: S::F8,
    leader: [S::F8; 4],
    [a, b, c, d]: [S::F8; 4],
) -> [S::F8; 4] {
    let [x, y, z, w] = S::F8::load_four(&pose.rotation);
    let share = share.flipped_by(dot::<S>([x, y, z, w], leader).sign());
    [x.mul_add(share, a), y.mul_add(share, b), z.mul_add(share, c), w.mul_add(share, d)]
}

/// Adds vectors to `sum`.
#[inline(always)]
fn straight<S: Simd>(vectors: &[[f32; LANES]; 3], share: S::F8, [a, b, c]: [S::F8; 3]) -> [S::F8; 3] {
    let [x, y, z] = S::F8::load_three(vectors);
    [x.mul_add(share, a), y.mul_add(share, b), z.mul_add(share, c)]
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
        let mut leader = S::F8::load_four(&base.rotation);
        let mut most = base_weight;
        for layer in layers {
            let Some(pose) = layer.pose.get(block) else { continue };
            let weight = weights::<S>(layer, block);
            let leads = most.less(weight);
            let [x, y, z, w] = S::F8::load_four(&pose.rotation);
            let [a, b, c, d] = leader;
            leader = [leads.select(x, a), leads.select(y, b), leads.select(z, c), leads.select(w, d)];
            most = weight.max(most);
        }
        let start = if short.any() { base_weight * total } else { zero };
        let mut rotation = turned::<S>(base, start, leader, [zero; 4]);
        let mut moved = straight::<S>(&base.translation, start, [zero; 3]);
        let mut scaled = straight::<S>(&base.scale, start, [zero; 3]);
        for layer in layers {
            if let Some(pose) = layer.pose.get(block) {
                let share = weights::<S>(layer, block) * total;
                rotation = turned::<S>(pose, share, leader, rotation);
                moved = straight::<S>(&pose.translation, share, moved);
                scaled = straight::<S>(&pose.scale, share, scaled);
            }
        }
        S::F8::store_four(unit::<S>(rotation), &mut out.rotation);
        S::F8::store_three(moved, &mut out.translation);
        S::F8::store_three(scaled, &mut out.scale);
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
