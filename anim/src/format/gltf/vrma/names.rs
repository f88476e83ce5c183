//! Names of the parts of the body in VRM.

use crate::data::{HumanBone, ModelData};
use crate::retarget::{BodyPart, BoneRole, SkeletonRoles};

/// Parts that every figure must have.
pub(super) const REQUIRED: [&str; 15] = [
    "hips",
    "spine",
    "head",
    "leftUpperArm",
    "leftLowerArm",
    "leftHand",
    "rightUpperArm",
    "rightLowerArm",
    "rightHand",
    "leftUpperLeg",
    "leftLowerLeg",
    "leftFoot",
    "rightUpperLeg",
    "rightLowerLeg",
    "rightFoot",
];

/// Returns the humanoid bones of a model in the order of its bones: those that its file names, otherwise those of a naming
/// convention. Eyes are left out, as a VRM animation moves them by a point to look at.
pub(super) fn human_bones(model: &ModelData) -> Vec<HumanBone> {
    let skeleton = &model.animation.skeleton;
    let mut humans = model.avatar.bones.clone();
    if humans.is_empty() {
        let roles = SkeletonRoles::guess(skeleton);
        for role in roles.roles() {
            let bones = roles.bones(role);
            let names = names(role, bones.len());
            humans.extend(
                names.into_iter().filter_map(|(name, at)| Some(HumanBone { name, bone: *bones.get(at)? })),
            );
        }
    }
    humans.retain(|human| !["leftEye", "rightEye"].contains(&&*human.name));
    humans.retain(|human| (human.bone as usize) < skeleton.len());
    humans.sort_by_key(|human| human.bone);
    humans
}

/// Returns the names for `count` bones of a part, each with the place of its bone in the chain.
fn names(role: BoneRole, count: usize) -> Vec<(String, usize)> {
    let one = |name: &str| vec![(name.to_owned(), 0)];
    let side = if role.side == 1 { "left" } else { "right" };
    let sided = |name: &str| vec![(format!("{side}{name}"), 0)];
    let finger = |name: &str, joints: [&str; 3]| {
        joints.iter().enumerate().map(|(at, joint)| (format!("{side}{name}{joint}"), at)).collect()
    };
    let joints = ["Proximal", "Intermediate", "Distal"];
    match role.part {
        BodyPart::Hips => one("hips"),
        BodyPart::Spine => {
            let places = if count < 3 { [0, 1, 2] } else { [0, count / 2, count - 1] };
            ["spine", "chest", "upperChest"].map(str::to_owned).into_iter().zip(places).collect()
        }
        BodyPart::Neck => one("neck"),
        BodyPart::Head => one("head"),
        BodyPart::Jaw => one("jaw"),
        BodyPart::Root | BodyPart::Eye => Vec::new(),
        BodyPart::Shoulder => sided("Shoulder"),
        BodyPart::UpperArm => sided("UpperArm"),
        BodyPart::LowerArm => sided("LowerArm"),
        BodyPart::Hand => sided("Hand"),
        BodyPart::Thumb => finger("Thumb", ["Metacarpal", "Proximal", "Distal"]),
        BodyPart::Index => finger("Index", joints),
        BodyPart::Middle => finger("Middle", joints),
        BodyPart::Ring => finger("Ring", joints),
        BodyPart::Little => finger("Little", joints),
        BodyPart::UpperLeg => sided("UpperLeg"),
        BodyPart::LowerLeg => sided("LowerLeg"),
        BodyPart::Foot => sided("Foot"),
        BodyPart::Toes => sided("Toes"),
    }
}
