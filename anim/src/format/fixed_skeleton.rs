//! Takes for a file whose skeleton a save cannot change.

use super::edited::DifferentBones;
use super::losses::Losses;
use super::{EditedTake, ExportError};
use crate::data::Skeleton;
use crate::root_bone::BoneShift;
use std::sync::Arc;

/// Code of a loss: a root bone that the user added, and its keys.
const BONE_NOT_STORED: &str = "BONE_NOT_STORED";

/// Returns takes of `skeleton` for the bones of the file, `opened`. Root bones that only `skeleton` has are lost, with their
/// keys.
pub(super) fn takes_of_file(
    opened: &Skeleton,
    skeleton: &Skeleton,
    takes: &[EditedTake],
    losses: &mut Losses,
) -> Result<Vec<EditedTake>, ExportError> {
    let shift = BoneShift::between(skeleton, opened).ok_or_else(|| ExportError::new(DifferentBones))?;
    if shift.is_identity() {
        return Ok(takes.to_vec());
    }
    for (index, bone) in skeleton.bones.iter().take(shift.removed()).enumerate() {
        let text = format!("the root bone \"{}\": a save adds no bone to a file of this format", bone.name);
        losses.add(format!("/animation/skeleton/bones/{index}"), BONE_NOT_STORED, text);
    }
    let take =
        |edited: &EditedTake| EditedTake { take: Arc::new(shift.take(&edited.take)), ..edited.clone() };
    Ok(takes.iter().map(take).collect())
}
