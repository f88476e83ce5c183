//! Quaternius characters: `UpperArm.L`, `Abdomen`, `Torso`.

use super::part::BodyPart::*;
use super::part::Convention;

pub(super) const CONVENTION: Convention = Convention {
    name: "Quaternius",
    rows: &[
        ("root", Root),
        ("bone", Root),
        ("hips", Hips),
        ("abdomen", Spine),
        ("torso", Spine),
        ("chest", Spine),
        ("neck", Neck),
        ("head", Head),
        ("shoulder{s}", Shoulder),
        ("upperarm{s}", UpperArm),
        ("lowerarm{s}", LowerArm),
        ("hand{s}", Hand),
        ("palm{s}", Hand),
        ("palm2{s}", Hand),
        ("thumb{s}", Thumb),
        ("thumb#{s}", Thumb),
        ("index{s}", Index),
        ("index#{s}", Index),
        ("middle#{s}", Middle),
        ("ring#{s}", Ring),
        ("pinky#{s}", Little),
        ("upperleg{s}", UpperLeg),
        ("lowerleg{s}", LowerLeg),
        ("foot{s}", Foot),
    ],
};
