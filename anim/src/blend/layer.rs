//! Any number of layers, each with a weight and optionally a mask.
//!
//! Formulas and reasons are in the docs of [`blend`].

use super::{Mask, usable, weight_or_zero};
use crate::data::Transform;
use crate::sample::healthy;
use glam::{Quat, Vec3};
use std::cmp::Ordering;

/// Sum of weights from which a bone counts as fully weighted: the remainder is rounding (0.7 + 0.2 + 0.1 is less than 1
/// in `f32`).
const WHOLE: f64 = 1.0 - 1e-6;

/// One animation among several: poses and their weight.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    /// One pose per bone, relative to the parent.
    pub poses: &'a [Transform],
    /// Weight relative to the other layers' weights, 0 or more (no percentage); negative and NaN count as 0.
    pub weight: f32,
    /// Weight of each bone; `None`: 1 for all.
    pub mask: Option<&'a Mask>,
}

impl<'a> Layer<'a> {
    /// Creates a layer of all bones.
    pub fn new(poses: &'a [Transform], weight: f32) -> Self {
        Self { poses, weight, mask: None }
    }

    /// Returns the layer restricted to the bones of `mask`.
    pub fn masked(self, mask: &'a Mask) -> Self {
        Self { mask: Some(mask), ..self }
    }

    /// Returns the layer's weight for one bone; 0 where it has no pose for it.
    fn weight_of(&self, bone: usize) -> f64 {
        let mask = self.mask.map_or(1.0, |mask| mask.weight(bone));
        let known = bone < self.poses.len();
        if known { f64::from(weight_or_zero(self.weight)) * f64::from(mask) } else { 0.0 }
    }
}

/// Blends `layers`; where the weights of a bone sum to less than 1, `base` gets the remainder.
///
/// For each bone, over all layers that contribute to it (weight × mask above 0):
///
/// ```text
/// w_i         = weight of layer i * its mask at this bone
/// W           = Σ w_i
/// share_i     = w_i / max(W, 1)        share of the base = 1 - Σ share_i      (blend)
/// share_i     = w_i / W                the base only where W = 0              (blend_normalized)
/// translation = Σ share_i * translation_i
/// scale       = Σ share_i * scale_i
/// rotation    = Σ share_i * ±rotation_i, divided by its length
/// ```
///
/// `base` is usually the rest pose. Where W is above 1, the weights are divided by W, so multiplying all of them by one
/// factor changes nothing as long as W stays above 1; a bone with no weight at all is the base, bit for bit.
///
/// * A bone whose layers (and the base, where it has a share) all have the same value gets that value bit for bit: a
///   blend of a pose with itself is that pose. Translation, rotation and scale are compared one by one.
/// * A bone with a single layer, of weight 1 or more, is that layer bit for bit; so masks of 0 and 1 select.
/// * Sums within a millionth of 1 count as 1.
///
/// Rules for lengths and non-finite numbers: see [`super`]. O(bones × layers); allocates nothing (thesis §2.1.4.1).
///
/// # Rotations
///
/// `q` and `-q` are the same rotation, so before the sum each rotation is moved to the hemisphere (of the
/// four-dimensional unit ball) of one of them, the one with the largest share. Between equal shares the values of the
/// rotations decide, so the order of the layers never matters. The sum then cannot vanish: along the rotation with the
/// largest share it is at least as long as that share. Two rotations exactly 180° apart are on the border of the
/// hemispheres and are used as they are stored.
///
/// The normalized sum (nlerp of many) is the mean that minimizes the weighted squares of the distances `|q - q_i|`. It
/// has no order, needs one division, and follows the same path as slerp, only not at quite the same speed: for two
/// rotations an angle apart it is off by at most
///
/// | apart | 30° | 60° | 90° | 120° | 180° |
/// |---|---|---|---|---|---|
/// | nlerp − slerp | 0.034° | 0.27° | 0.92° | 2.3° | 8.2° |
///
/// and by nothing at 0, ½ and 1. Where that is too much for two layers, use [`super::blend_two`]. A slerp of three or
/// more would depend on the order.
pub fn blend(base: &[Transform], layers: &[Layer], out: &mut [Transform]) {
    blend_each(base, layers, out, |sum| if sum >= WHOLE { 0.0 } else { 1.0 - sum });
}

/// Blends `layers` with their weights divided by their sum, however small; `base` is used only where a bone has no
/// weight at all.
///
/// So all weights may be multiplied by one factor without changing anything. Otherwise as [`blend`].
pub fn blend_normalized(base: &[Transform], layers: &[Layer], out: &mut [Transform]) {
    blend_each(base, layers, out, |sum| if sum > 0.0 { 0.0 } else { 1.0 });
}

/// Blends with the base's weight computed from the sum of the layers' weights.
fn blend_each(base: &[Transform], layers: &[Layer], out: &mut [Transform], base_weight: impl Fn(f64) -> f64) {
    for (bone, out) in out.iter_mut().enumerate() {
        let base = usable(base.get(bone).copied().unwrap_or_default());
        let sum: f64 = layers.iter().map(|layer| layer.weight_of(bone)).sum();
        let base_weight = base_weight(sum);
        let total = base_weight + sum;
        let layers = layers.iter().filter_map(move |layer| {
            let weight = layer.weight_of(bone);
            (weight > 0.0).then(|| (weight, healthy(layer.poses[bone], base)))
        });
        let base = (base_weight > 0.0).then_some((base_weight, base));
        let shares =
            base.into_iter().chain(layers).map(|(weight, pose)| Share { of: (weight / total) as f32, pose });
        if let Some(blended) = blend_shares(shares) {
            *out = blended;
        }
    }
}

/// A pose and its share of the blend.
#[derive(Clone, Copy)]
struct Share {
    /// Fraction of the blend, 0..=1; all shares sum to 1.
    of: f32,
    pose: Transform,
}

/// Computes the sums in the formulas of [`blend`]; `None` without any share.
fn blend_shares(shares: impl Iterator<Item = Share> + Clone) -> Option<Transform> {
    let leading = shares.clone().reduce(|a, b| if leads(&b, &a) { b } else { a })?.pose;
    let (mut translation, mut rotation, mut scale) =
        (Vec3::ZERO, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), Vec3::ZERO);
    let mut same = (true, true, true);
    for Share { of, pose } in shares {
        translation += pose.translation * of;
        scale += pose.scale * of;
        let turned = if pose.rotation.dot(leading.rotation) < 0.0 { -pose.rotation } else { pose.rotation };
        rotation += turned * of;
        same.0 &= pose.translation == leading.translation;
        same.1 &= turned == leading.rotation;
        same.2 &= pose.scale == leading.scale;
    }
    // A sum of finite numbers can still leave the range of f32.
    let vector = |same: bool, sum: Vec3, leading: Vec3| if same || !sum.is_finite() { leading } else { sum };
    Some(Transform {
        translation: vector(same.0, translation, leading.translation),
        rotation: if same.1 { leading.rotation } else { rotation.normalize() },
        scale: vector(same.2, scale, leading.scale),
    })
}

/// Returns whether the hemisphere of `a` is preferred to that of `b`: the one with the larger share; if the shares are
/// equal, the one whose rotation, in the form with `w ≥ 0`, has the larger numbers. Any criterion would do that does
/// not depend on the order of the layers.
fn leads(a: &Share, b: &Share) -> bool {
    let upper = |rotation: Quat| if rotation.w < 0.0 { -rotation } else { rotation };
    let numbers = |share: &Share| {
        let [x, y, z, w] = upper(share.pose.rotation).to_array();
        [share.of, w, x, y, z]
    };
    let order = numbers(a).into_iter().zip(numbers(b)).map(|(a, b)| a.total_cmp(&b));
    order.into_iter().find(|order| order.is_ne()) == Some(Ordering::Greater)
}
