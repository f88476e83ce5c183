//! Blending of any number of poses, eight bones at once (thesis §2.1.4.1: per bone, before skinning).
//!
//! For each bone, over all layers:
//!
//! ```text
//! w_i         = weight of layer i * its mask at this bone          W = Σ w_i
//! share_i     = w_i / max(W, 1)        share of the base = 1 - Σ share_i      (blend)
//! share_i     = w_i / W                the base only where W = 0              (blend_normalized)
//! translation = Σ share_i * translation_i
//! scale       = Σ share_i * scale_i
//! rotation    = Σ share_i * ±rotation_i, divided by its length
//! ```
//!
//! `q` and `-q` are the same rotation: each rotation is moved to the hemisphere of the one with the largest share. Of
//! equal shares the first counts, and the base comes before all layers. So the sum cannot vanish.

use super::blend_masks::with_masks;
use super::mask::{LaneMask, usable};
use super::pose::PoseBlock;
use super::simd::{Float8, Kernel, Simd, SimdLevel};
use super::slerp::{dot, unit};

/// Sum of weights from which a bone counts as fully weighted: the remainder is rounding.
pub(crate) const WHOLE: f32 = 1.0 - 1e-6;

/// One of several poses to blend.
#[derive(Clone, Copy, Debug)]
pub struct PoseLayer<'a> {
    /// Blocks of the pose; every layer has the same number.
    pub pose: &'a [PoseBlock],
    /// Weight relative to the other layers' weights, 0 or more (no percentage); negative and NaN count as 0.
    pub weight: f32,
    /// Weight of each bone; `None`: 1 for all.
    pub mask: Option<&'a LaneMask>,
}

impl<'a> PoseLayer<'a> {
    /// Creates a layer of all bones.
    pub fn new(pose: &'a [PoseBlock], weight: f32) -> Self {
        Self { pose, weight, mask: None }
    }

    /// Returns the layer with weights per bone.
    pub fn masked(self, mask: &'a LaneMask) -> Self {
        Self { mask: Some(mask), ..self }
    }
}

/// Blends `layers`; where the weights of a bone sum to less than 1, `base` gets the remainder.
///
/// `base` is usually the rest pose ([`super::Rig::rest`]). Writes the blocks that `base` and `out` both have; a layer
/// that is shorter does not affect the bones it lacks. If all inputs are finite and their rotations have unit length,
/// so are and have the results. Allocates nothing.
pub fn blend(level: SimdLevel, base: &[PoseBlock], layers: &[PoseLayer], out: &mut [PoseBlock]) {
    level.run(Blend { base, layers, out, normalized: false });
}

/// Blends `layers` with their weights divided by their sum, however small; `base` is used only where a bone has no
/// weight at all. Otherwise as [`blend`].
pub fn blend_normalized(level: SimdLevel, base: &[PoseBlock], layers: &[PoseLayer], out: &mut [PoseBlock]) {
    level.run(Blend { base, layers, out, normalized: true });
}

/// The kernel of [`blend`], and of [`blend_normalized`].
pub(super) struct Blend<'a> {
    pub(super) base: &'a [PoseBlock],
    pub(super) layers: &'a [PoseLayer<'a>],
    pub(super) out: &'a mut [PoseBlock],
    pub(super) normalized: bool,
}

impl Kernel for Blend<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { base, layers, out, normalized } = self;
        let blocks = base.len().min(out.len());
        let (base, out) = (&base[..blocks], &mut out[..blocks]);
        let has_masks = layers.iter().any(|layer| layer.mask.is_some());
        if has_masks || !evenly::<S>(base, layers, out, normalized) {
            with_masks::<S>(base, layers, out, normalized);
        }
    }
}

/// Returns the base's weight when the layers' weights sum to `sum`.
#[inline(always)]
fn base_weight(sum: f32, normalized: bool) -> f32 {
    let whole = if normalized { sum > 0.0 } else { sum >= WHOLE };
    match (whole, normalized) {
        (true, _) => 0.0,
        (false, true) => 1.0,
        (false, false) => 1.0 - sum,
    }
}

/// Blends without masks: every bone has the same shares, so the poses with a share are collected, the leading one
/// first. Returns false if a layer has a mask or is too short, or there are too many.
#[inline(always)]
fn evenly<S: Simd>(
    base: &[PoseBlock],
    layers: &[PoseLayer],
    out: &mut [PoseBlock],
    normalized: bool,
) -> bool {
    // The base is the first, whether it contributes or not.
    let (mut poses, mut weights) = ([base; 1 + MOST], [0.0; 1 + MOST]);
    let (mut count, mut sum, mut most, mut leader) = (1, 0.0, 0.0, 1);
    for layer in layers {
        // NaN fails the comparison.
        if layer.weight > 0.0 {
            let (Some(pose), Some(weight)) = (poses.get_mut(count), weights.get_mut(count)) else {
                return false;
            };
            if layer.mask.is_some() || layer.pose.len() < base.len() {
                return false;
            }
            (*pose, *weight) = (layer.pose, usable(layer.weight));
            if *weight > most {
                (most, leader) = (*weight, count);
            }
            sum += *weight;
            count += 1;
        }
    }
    let base_weight = base_weight(sum, normalized);
    weights[0] = base_weight;
    let first = usize::from(base_weight <= 0.0);
    let leader = if most > base_weight { leader } else { 0 };
    if leader > first {
        poses.swap(first, leader);
        weights.swap(first, leader);
    }
    let whole = 1.0 / (base_weight + sum);
    let part = |at: usize| (poses[first + at], weights[first + at] * whole);
    match count - first {
        1 => mix::<S, 1>([part(0)], out),
        2 => mix::<S, 2>([part(0), part(1)], out),
        3 => mix::<S, 3>([part(0), part(1), part(2)], out),
        4 => mix::<S, 4>([part(0), part(1), part(2), part(3)], out),
        _ => return false,
    }
    true
}

/// A pose and its share.
type WeightedPose<'a> = (&'a [PoseBlock], f32);

/// Above this number, layers are blended one after the other.
pub(super) const MOST: usize = 4;

/// Computes the sums of the formulas above, with the same shares for all bones; the first pose leads.
#[inline(always)]
fn mix<S: Simd, const N: usize>(parts: [WeightedPose; N], out: &mut [PoseBlock]) {
    let count = parts.iter().map(|part| part.0.len()).fold(out.len(), usize::min);
    let parts = parts.map(|(pose, share)| (&pose[..count], share));
    for (block, out) in out[..count].iter_mut().enumerate() {
        let leader = &parts[0].0[block];
        let share = S::F8::splat(parts[0].1);
        let lead = S::F8::load_four(&leader.rotation);
        let [mut x, mut y, mut z, mut w] =
            [lead[0] * share, lead[1] * share, lead[2] * share, lead[3] * share];
        for (pose, share) in &parts[1..] {
            let own = S::F8::load_four(&pose[block].rotation);
            let share = S::F8::splat(*share).flipped_by(dot::<S>(own, lead).sign());
            (x, y) = (own[0].mul_add(share, x), own[1].mul_add(share, y));
            (z, w) = (own[2].mul_add(share, z), own[3].mul_add(share, w));
        }
        S::F8::store_four(unit::<S>([x, y, z, w]), &mut out.rotation);
        let [a, b, c] = S::F8::load_three(&leader.translation);
        let [d, e, f] = S::F8::load_three(&leader.scale);
        let [mut a, mut b, mut c] = [a * share, b * share, c * share];
        let [mut d, mut e, mut f] = [d * share, e * share, f * share];
        for (pose, share) in &parts[1..] {
            let share = S::F8::splat(*share);
            let [x, y, z] = S::F8::load_three(&pose[block].translation);
            (a, b, c) = (x.mul_add(share, a), y.mul_add(share, b), z.mul_add(share, c));
            let [x, y, z] = S::F8::load_three(&pose[block].scale);
            (d, e, f) = (x.mul_add(share, d), y.mul_add(share, e), z.mul_add(share, f));
        }
        S::F8::store_three([a, b, c], &mut out.translation);
        S::F8::store_three([d, e, f], &mut out.scale);
    }
}
