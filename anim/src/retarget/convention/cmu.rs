//! Motion capture of the Carnegie Mellon database and other BVH files.

use super::part::BodyPart::*;
use super::part::Convention;

pub(super) const CONVENTION: Convention = Convention {
    name: "CMU",
    rows: &[
        ("hips", Hips),
        ("lowerback", Spine),
        ("spine", Spine),
        ("spine#", Spine),
        ("chest", Spine),
        ("chest#", Spine),
        ("neck", Neck),
        ("neck#", Neck),
        ("head", Head),
        ("{side}collar", Shoulder),
        ("{side}shoulder", Shoulder),
        ("{side}arm", UpperArm),
        ("{side}forearm", LowerArm),
        ("{side}elbow", LowerArm),
        ("{side}hand", Hand),
        ("{side}wrist", Hand),
        ("{s}thumb", Thumb),
        ("{side}fingerbase", Middle),
        ("{s}fingers", Middle),
        ("{side}upleg", UpperLeg),
        ("{side}hip", UpperLeg),
        ("{side}leg", LowerLeg),
        ("{side}knee", LowerLeg),
        ("{side}foot", Foot),
        ("{side}ankle", Foot),
        ("{side}toebase", Toes),
        ("{side}toe", Toes),
    ],
};
