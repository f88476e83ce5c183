//! The figure of a written VRM animation: the humanoid bones in a T-pose, looking along +Z, without rotations at rest.

use crate::animation::to_root;
use crate::data::{Bone, BoneIndex, Channel, HumanBone, Skeleton, Take, Track, Transform};
use glam::{Mat4, Quat, Vec3};
use std::borrow::Cow;

/// Cosine of the angle to the x axis below which the left side counts as being along it (11°).
const ALONG: f32 = 0.98;

/// A figure, and the skeleton that it is made from.
pub(super) struct VrmaFigure<'a> {
    /// The humanoid bones of the model, in the order of the bones of the figure.
    pub(super) humans: &'a [HumanBone],
    /// The bones of the figure, one for each humanoid bone.
    pub(super) skeleton: Skeleton,
    source: &'a Skeleton,
    /// Rotation about y that makes the model look along +Z.
    turn: Quat,
}

impl<'a> VrmaFigure<'a> {
    /// Returns the figure of a skeleton; `humans` are in the order of its bones.
    pub(super) fn of(source: &'a Skeleton, humans: &'a [HumanBone]) -> Self {
        let mut matrices = vec![Mat4::IDENTITY; source.len()];
        to_root(source, &[], &mut matrices);
        let origin =
            |bone: BoneIndex| matrices.get(bone as usize).map_or(Vec3::ZERO, |it| it.w_axis.truncate());
        let turn = turn_to_front(humans, origin);
        let parents: Vec<Option<u32>> =
            humans.iter().map(|human| parent(source, humans, human.bone)).collect();
        let mut bones = Vec::with_capacity(humans.len());
        for (human, &parent) in humans.iter().zip(&parents) {
            let above = parent.and_then(|parent| humans.get(parent as usize));
            let offset = turn * (origin(human.bone) - above.map_or(Vec3::ZERO, |above| origin(above.bone)));
            let translation = match (side(&human.name), above) {
                (Some((side, part)), Some(_)) if ["LowerArm", "Hand"].contains(&part) => {
                    side * offset.length()
                }
                (Some((_, "LowerLeg" | "Foot")), Some(_)) => Vec3::NEG_Y * offset.length(),
                (Some((side, part)), Some(_)) if is_finger(part) => {
                    let at =
                        |name: &str| humans.iter().find(|human| human.name == name).map(|it| origin(it.bone));
                    let word = human.name.strip_suffix(part).unwrap_or_default();
                    let arm = at(&format!("{word}Hand")).zip(at(&format!("{word}LowerArm")));
                    let arm = arm.and_then(|(hand, elbow)| (turn * (hand - elbow)).try_normalize());
                    arm.map_or(offset, |arm| Quat::from_rotation_arc(arm, side) * offset)
                }
                _ => offset,
            };
            let rest = Transform { translation, ..Transform::IDENTITY };
            bones.push(Bone {
                name: human.name.clone(),
                parent,
                rest,
                rest_matrix: None,
                offset: Mat4::IDENTITY,
                node: None,
            });
        }
        Self { humans, skeleton: Skeleton { bones }, source, turn }
    }

    /// Returns the skeleton of the model and a take of it, turned to look along +Z.
    pub(super) fn turned<'t>(&self, take: &'t Take) -> (Cow<'a, Skeleton>, Cow<'t, Take>) {
        if self.turn == Quat::IDENTITY {
            return (Cow::Borrowed(self.source), Cow::Borrowed(take));
        }
        let mut skeleton = self.source.clone();
        let is_root: Vec<bool> = skeleton.bones.iter().map(|bone| bone.parent.is_none()).collect();
        for bone in skeleton.bones.iter_mut().filter(|bone| bone.parent.is_none()) {
            bone.rest.translation = self.turn * bone.rest.translation;
            bone.rest.rotation = self.turn * bone.rest.rotation;
            bone.rest_matrix = bone.rest_matrix.map(|matrix| Mat4::from_quat(self.turn) * matrix);
        }
        let mut take = take.clone();
        for track in take.tracks.iter_mut().filter(|it| is_root.get(it.bone as usize) == Some(&true)) {
            let Track { translation, rotation, .. } = track;
            *translation = mapped(translation, |value| self.turn * value);
            *rotation = mapped(rotation, |value| self.turn * value);
        }
        (Cow::Owned(skeleton), Cow::Owned(take))
    }
}

fn mapped<T: Copy>(channel: &Channel<T>, map: impl Fn(T) -> T) -> Channel<T> {
    Channel { values: channel.values.iter().map(|&value| map(value)).collect(), ..channel.clone() }
}

/// Returns the nearest humanoid bone above a bone, by its place in `humans`.
fn parent(skeleton: &Skeleton, humans: &[HumanBone], bone: BoneIndex) -> Option<u32> {
    let place = |bone| humans.iter().position(|human| human.bone == bone).map(|place| place as u32);
    skeleton.ancestors(bone).find_map(place)
}

/// Returns the direction of a side in a T-pose that looks along +Z, and the name without the side.
fn side(name: &str) -> Option<(Vec3, &str)> {
    match (name.strip_prefix("left"), name.strip_prefix("right")) {
        (Some(part), _) => Some((Vec3::X, part)),
        (_, Some(part)) => Some((Vec3::NEG_X, part)),
        _ => None,
    }
}

fn is_finger(part: &str) -> bool {
    ["Thumb", "Index", "Middle", "Ring", "Little"].iter().any(|finger| part.starts_with(finger))
}

/// Returns the rotation about y after which the left side is along +X.
fn turn_to_front(humans: &[HumanBone], origin: impl Fn(BoneIndex) -> Vec3) -> Quat {
    let mut to_left = Vec3::ZERO;
    for human in humans {
        if let Some((side, "UpperArm" | "UpperLeg")) = side(&human.name) {
            to_left += origin(human.bone) * side.x;
        }
    }
    let Some(to_left) = to_left.with_y(0.0).try_normalize() else { return Quat::IDENTITY };
    if to_left.x > ALONG {
        return Quat::IDENTITY;
    }
    if to_left.x < -ALONG {
        return Quat::from_xyzw(0.0, 1.0, 0.0, 0.0);
    }
    let cosine = ((1.0 + to_left.x) / 2.0).sqrt();
    Quat::from_xyzw(0.0, to_left.z / (2.0 * cosine), 0.0, cosine).normalize()
}
