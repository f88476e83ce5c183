//! The bones: the rest position of each joint, in the units and axes of the model.
//!
//! Y is up, the animal faces +Z, its left side is +X, and it is about one unit long from face to tail. In the rest
//! pose it stands: feet on `y = 0`, wings spread. The rest rotation of every joint is the identity, so a pose consists
//! of rotations about the axes of the model.

use super::num::curve;
use super::wing_plan::PLANS;
use glam::Vec3;

/// One joint of the skeleton.
pub(super) struct DemoBone {
    /// Its name in the file.
    pub(super) name: String,
    /// The index of its parent; always smaller than its own.
    pub(super) parent: Option<usize>,
    /// Position of the joint in the rest pose, in model space.
    pub(super) head: Vec3,
}

pub(super) const ROOT: usize = 0;
pub(super) const THORAX: usize = 1;
pub(super) const NECK: usize = 2;
pub(super) const HEAD: usize = 3;
/// The left antenna; the right one follows it.
pub(super) const ANTENNA: usize = 4;
/// The first of the eight abdomen bones.
pub(super) const ABDOMEN: usize = 6;
const WINGS: usize = 14;
const LEGS: usize = 26;
/// Number of bones.
pub(super) const COUNT: usize = 50;

/// A side of the body: 0 is left (+X), 1 is right.
pub(super) const SIDES: [usize; 2] = [0, 1];
const SIDE_NAMES: [&str; 2] = ["left", "right"];

/// The index of a wing bone: `pair` 0 fore, 1 hind; `part` 0 at the hinge to 2 at the tip.
pub(super) fn wing(side: usize, pair: usize, part: usize) -> usize {
    WINGS + (side * 2 + pair) * 3 + part
}

/// The index of a leg bone: `pair` 0 fore to 2 hind; `part` 0 coxa, femur, tibia, 3 tarsus.
pub(super) fn leg(side: usize, pair: usize, part: usize) -> usize {
    LEGS + (side * 3 + pair) * 4 + part
}

/// The bone on the other side of the body, or itself on the middle line.
pub(super) fn mirrored(bone: usize) -> usize {
    match bone {
        ROOT..=HEAD | ABDOMEN..WINGS => bone,
        ANTENNA..ABDOMEN => ANTENNA + (1 - (bone - ANTENNA)),
        WINGS..LEGS => WINGS + (bone - WINGS + 6) % 12,
        _ => LEGS + (bone - LEGS + 12) % 24,
    }
}

/// Z of the front end of the abdomen.
pub(super) const ABDOMEN_Z: f32 = 0.100;
/// The lengths of the ten rings of the abdomen, front to back.
pub(super) const RINGS: [f32; 10] = [0.026, 0.058, 0.104, 0.102, 0.100, 0.096, 0.086, 0.054, 0.034, 0.022];
/// The abdomen's length, the sum of [`RINGS`].
pub(super) const ABDOMEN_LENGTH: f32 = 0.682;

/// The middle line of the abdomen, `along` units from its front end.
pub(super) fn abdomen_axis(along: f32) -> Vec3 {
    const ARCH: [(f32, f32); 5] =
        [(-0.02, 0.177), (0.10, 0.184), (0.28, 0.186), (0.48, 0.178), (0.70, 0.160)];
    Vec3::new(0.0, curve(&ARCH, along), ABDOMEN_Z - along)
}

/// Starts of the eight abdomen bones along the abdomen; the first bone carries rings one and two, the last one rings
/// nine and ten.
pub(super) fn abdomen_joints() -> [f32; 8] {
    let mut joints = [0.0; 8];
    let mut along = RINGS[0];
    for (joint, ring) in joints.iter_mut().skip(1).zip(&RINGS[1..]) {
        along += ring;
        *joint = along;
    }
    joints
}

/// Starts of the second and third wing bones, as fractions of the span.
pub(super) const WING_JOINTS: [f32; 2] = [0.36, 0.68];

/// The joints of the left legs: coxa, femur, tibia, tarsus, then the toe's end.
pub(super) const LEG_JOINTS: [[Vec3; 5]; 3] = [
    [
        Vec3::new(0.015, 0.134, 0.288),
        Vec3::new(0.030, 0.110, 0.300),
        Vec3::new(0.090, 0.106, 0.354),
        Vec3::new(0.116, 0.014, 0.384),
        Vec3::new(0.130, 0.003, 0.422),
    ],
    [
        Vec3::new(0.018, 0.128, 0.258),
        Vec3::new(0.038, 0.103, 0.260),
        Vec3::new(0.136, 0.117, 0.286),
        Vec3::new(0.186, 0.014, 0.296),
        Vec3::new(0.228, 0.003, 0.310),
    ],
    [
        Vec3::new(0.018, 0.126, 0.226),
        Vec3::new(0.038, 0.103, 0.218),
        Vec3::new(0.140, 0.136, 0.136),
        Vec3::new(0.186, 0.014, 0.066),
        Vec3::new(0.212, 0.003, 0.020),
    ],
];

/// The left antenna: its foot and its tip.
pub(super) const ANTENNA_ENDS: [Vec3; 2] = [Vec3::new(0.010, 0.208, 0.389), Vec3::new(0.028, 0.232, 0.424)];

/// Reflects a point of the left side to `side`.
pub(super) fn on_side(side: usize, p: Vec3) -> Vec3 {
    if side == 0 { p } else { Vec3::new(-p.x, p.y, p.z) }
}

/// Every bone, parents before children.
pub(super) fn bones() -> Vec<DemoBone> {
    let mut bones = Vec::with_capacity(COUNT);
    let mut add = |name: String, parent: Option<usize>, head: Vec3| {
        bones.push(DemoBone { name, parent, head });
    };
    add("root".into(), None, Vec3::ZERO);
    add("thorax".into(), Some(ROOT), Vec3::new(0.0, 0.185, 0.200));
    add("neck".into(), Some(THORAX), Vec3::new(0.0, 0.176, 0.300));
    add("head".into(), Some(NECK), Vec3::new(0.0, 0.178, 0.322));
    for side in SIDES {
        let name = format!("antenna_{}", SIDE_NAMES[side]);
        add(name, Some(HEAD), on_side(side, ANTENNA_ENDS[0]));
    }
    for (i, along) in abdomen_joints().into_iter().enumerate() {
        let parent = if i == 0 { THORAX } else { ABDOMEN + i - 1 };
        add(format!("abdomen_{}", i + 1), Some(parent), abdomen_axis(along));
    }
    for side in SIDES {
        for (pair, place) in ["fore", "hind"].into_iter().enumerate() {
            for (part, along) in [0.0, WING_JOINTS[0], WING_JOINTS[1]].into_iter().enumerate() {
                let parent = if part == 0 { THORAX } else { wing(side, pair, part - 1) };
                let name = format!("wing_{place}_{}_{}", SIDE_NAMES[side], part + 1);
                let head = PLANS[pair].axis(along);
                add(name, Some(parent), on_side(side, head));
            }
        }
    }
    for side in SIDES {
        for (pair, place) in ["fore", "mid", "hind"].into_iter().enumerate() {
            for (part, piece) in ["coxa", "femur", "tibia", "tarsus"].into_iter().enumerate() {
                let parent = if part == 0 { THORAX } else { leg(side, pair, part - 1) };
                let name = format!("leg_{place}_{}_{piece}", SIDE_NAMES[side]);
                add(name, Some(parent), on_side(side, LEG_JOINTS[pair][part]));
            }
        }
    }
    bones
}
