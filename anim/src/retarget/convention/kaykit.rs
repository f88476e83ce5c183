//! KayKit characters: `upperarm.l`, `lowerleg.r`.

use super::part::BodyPart::*;
use super::part::Convention;

pub(super) const CONVENTION: Convention = Convention {
    name: "KayKit",
    rows: &[
        ("root", Root),
        ("hips", Hips),
        ("spine", Spine),
        ("chest", Spine),
        ("head", Head),
        ("upperarm{s}", UpperArm),
        ("lowerarm{s}", LowerArm),
        ("wrist{s}", Hand),
        ("upperleg{s}", UpperLeg),
        ("lowerleg{s}", LowerLeg),
        ("foot{s}", Foot),
        ("toes{s}", Toes),
    ],
};
