//! Hips that do not carry the legs.
//!
//! Some rigs have a bone for the whole body below which hips and legs are siblings (Quaternius: `Body`, with `Hips`, `UpperLeg.L` and
//! `UpperLeg.R`). The hips of another figure carry its legs; bound to the bone called hips, they would carry the trunk alone, and the
//! figure would be torn apart at the waist. The role then belongs to the closest bone above hips and legs, provided that it is where
//! hips are: nearer to the hips than a thigh is long. The bone called hips has no role any more and keeps its rest pose on it.

use super::part::{BodyPart, BoneRole};
use crate::animation::to_root;
use crate::data::{BoneIndex, Skeleton};
use glam::{Mat4, Vec3};

/// Moves the role of the hips to the bone that carries the legs, too, where the hips do not.
pub(super) fn carry_legs(of: &mut [Option<BoneRole>], skeleton: &Skeleton) {
    let find = |part, side| of.iter().position(|role| *role == Some(BoneRole { part, side }));
    let legs: Vec<usize> = [1, 2].into_iter().filter_map(|side| find(BodyPart::UpperLeg, side)).collect();
    let Some(hips) = find(BodyPart::Hips, 0).filter(|_| !legs.is_empty()) else { return };
    let carries = |bone: usize| legs.iter().all(|&leg| path_up(skeleton, leg).any(|above| above == bone));
    let Some(carrier) = path_up(skeleton, hips).find(|&bone| carries(bone)) else { return };
    if carrier == hips {
        return;
    }
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &[], &mut matrices);
    let place = |bone: usize| -> Vec3 { matrices[bone].w_axis.truncate() };
    let thigh = [1, 2].into_iter().filter_map(|side| {
        let (upper, lower) = (find(BodyPart::UpperLeg, side)?, find(BodyPart::LowerLeg, side)?);
        Some(place(upper).distance(place(lower)))
    });
    if place(carrier).distance(place(hips)) < thigh.fold(0.0, f32::max) {
        of[carrier] = of[hips].take();
    }
}

/// Returns a bone and all bones above it, from the bone up.
fn path_up(skeleton: &Skeleton, bone: usize) -> impl Iterator<Item = usize> {
    std::iter::once(bone).chain(skeleton.ancestors(bone as BoneIndex).map(|above| above as usize))
}
