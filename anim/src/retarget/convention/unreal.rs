//! The mannequins of Unreal: `upperarm_l`, `calf_r`.

use super::part::BodyPart::*;
use super::part::Convention;

pub(super) const CONVENTION: Convention = Convention {
    name: "Unreal mannequin",
    rows: &[
        ("root", Root),
        ("pelvis", Hips),
        ("spine#", Spine),
        ("neck#", Neck),
        ("head", Head),
        ("clavicle{s}", Shoulder),
        ("upperarm{s}", UpperArm),
        ("lowerarm{s}", LowerArm),
        ("hand{s}", Hand),
        ("thumb#{s}", Thumb),
        ("index#{s}", Index),
        ("middle#{s}", Middle),
        ("ring#{s}", Ring),
        ("pinky#{s}", Little),
        ("thigh{s}", UpperLeg),
        ("calf{s}", LowerLeg),
        ("foot{s}", Foot),
        ("ball{s}", Toes),
    ],
};
