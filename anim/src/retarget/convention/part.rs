//! Parts of the body, and a table of names for them.

/// A part of the body. Chains are several bones with the same part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BodyPart {
    /// The bone above the hips that carries the whole figure.
    Root,
    /// Hips or pelvis.
    Hips,
    /// The chain from above the hips to the chest.
    Spine,
    /// The chain from the chest to the head.
    Neck,
    /// Head.
    Head,
    /// Eye.
    Eye,
    /// Jaw.
    Jaw,
    /// Collar bone.
    Shoulder,
    /// Upper arm.
    UpperArm,
    /// Forearm.
    LowerArm,
    /// Hand.
    Hand,
    /// The chain of the thumb.
    Thumb,
    /// The chain of the index finger.
    Index,
    /// The chain of the middle finger.
    Middle,
    /// The chain of the ring finger.
    Ring,
    /// The chain of the little finger.
    Little,
    /// Thigh.
    UpperLeg,
    /// Shin.
    LowerLeg,
    /// Foot.
    Foot,
    /// Toes.
    Toes,
}

/// A part of the body and its side: 0 for the middle, 1 for left, 2 for right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BoneRole {
    /// The part.
    pub part: BodyPart,
    /// 0 for the middle, 1 for left, 2 for right.
    pub side: u8,
}

/// A naming convention.
#[derive(Clone, Copy, Debug)]
pub(super) struct Convention {
    /// Its name in lists.
    pub(super) name: &'static str,
    /// Names and parts.
    pub(super) rows: &'static [(&'static str, BodyPart)],
}
