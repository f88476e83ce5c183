//! Mixamo and other rigs with the names of HumanIK: `mixamorig:LeftUpLeg`.

use super::part::BodyPart::*;
use super::part::Convention;

pub(super) const CONVENTION: Convention = Convention {
    name: "Mixamo",
    rows: &[
        ("root", Root),
        ("reference", Root),
        ("hips", Hips),
        ("spine", Spine),
        ("spine#", Spine),
        ("neck", Neck),
        ("neck#", Neck),
        ("head", Head),
        ("{side}eye", Eye),
        ("jaw", Jaw),
        ("{side}shoulder", Shoulder),
        ("{side}arm", UpperArm),
        ("{side}forearm", LowerArm),
        ("{side}hand", Hand),
        ("{side}handthumb#", Thumb),
        ("{side}handindex#", Index),
        ("{side}handmiddle#", Middle),
        ("{side}handring#", Ring),
        ("{side}handpinky#", Little),
        ("{side}upleg", UpperLeg),
        ("{side}leg", LowerLeg),
        ("{side}foot", Foot),
        ("{side}toebase", Toes),
    ],
};
