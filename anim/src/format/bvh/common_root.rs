//! One joint above several root bones: most programs read only the first `ROOT` of a file, or refuse the others.

use super::check as code;
use super::hierarchy::JointTable;
use super::motion::MotionRows;
use crate::data::Skeleton;
use crate::format::losses::{Losses, count};
use glam::DVec3;

/// Name of the joint. No bone gets this name in a written file, so that a reader can tell the joint from a bone.
pub(super) const NAME: &str = "dragonfly_common_root";

/// The lines of the joint, up to its first child.
pub(super) const LINES: &str = "ROOT dragonfly_common_root\n{\n\tOFFSET 0.000000 0.000000 0.000000\n\
    \tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";

/// The numbers of the joint at the start of each row.
pub(super) const ROW: &str = "0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 ";

/// Returns whether a skeleton needs the joint, and lists it.
pub(super) fn is_needed(skeleton: &Skeleton, losses: &mut Losses) -> bool {
    let roots = skeleton.children(None).count();
    if roots > 1 {
        let text = format!(
            "the {} are below one more joint, \"{NAME}\", which is no bone when Dragonfly reads the file again",
            count(roots, "root bone")
        );
        losses.add("/animation/skeleton/bones".to_owned(), code::COMMON_ROOT_ADDED, text);
    }
    roots > 1
}

/// Removes the joint from what was read. A joint of this name that was moved, or that is not above several others, is a bone.
pub(super) fn remove(hierarchy: &mut JointTable, rows: &MotionRows) {
    let Some(root) = hierarchy.joints.first() else { return };
    let channels = root.channels.len();
    let is_still = |row: &[f64]| row.iter().take(channels).all(|&number| number == 0.0);
    let is_common = root.name == NAME
        && root.offset == DVec3::ZERO
        && hierarchy.joints.iter().filter(|joint| joint.parent.is_none()).count() == 1
        && hierarchy.joints.iter().filter(|joint| joint.parent == Some(0)).count() > 1
        && (channels == 0 || rows.numbers.chunks_exact(hierarchy.channels).all(is_still));
    if is_common {
        hierarchy.joints.remove(0);
        for joint in &mut hierarchy.joints {
            joint.parent = joint.parent.and_then(|parent| parent.checked_sub(1));
        }
    }
}
