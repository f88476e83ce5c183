//! Commands of scenes that have the keys of commands for models.

use super::id::Id;

/// Commands for models and the ones with the same meaning, and the same keys, while a scene is open. Where other programs have a key for the
/// command of a scene, it is there: markers are where cameras change in Blender, K splits strips, page up and down go from strip to strip.
const COUNTERPARTS: &[(Id, Id)] = &[
    (Id::DeleteKeys, Id::SceneDelete),
    (Id::DuplicateKeys, Id::SceneDuplicate),
    (Id::SelectAllKeys, Id::SelectAllActions),
    (Id::SelectAll, Id::SelectAllActions),
    (Id::Copy, Id::CopyActions),
    (Id::CopyKeys, Id::CopyActions),
    (Id::CutKeys, Id::CutActions),
    (Id::PastePose, Id::PasteActions),
    (Id::RenameTake, Id::SceneRename),
    (Id::KeysEarlier, Id::ClipEarlier),
    (Id::KeysLater, Id::ClipLater),
    (Id::FitKeys, Id::FitScene),
    (Id::Key, Id::CutHere),
    (Id::SplitTake, Id::CutHere),
    (Id::AddMarker, Id::CutToCamera),
    (Id::PreviousKey, Id::PreviousEdge),
    (Id::NextKey, Id::NextEdge),
    (Id::PreviousMarker, Id::PreviousShot),
    (Id::NextMarker, Id::NextShot),
    (Id::PreviousTake, Id::PreviousAction),
    (Id::NextTake, Id::NextAction),
    (Id::RangeFromHere, Id::ClipStartToPlayhead),
    (Id::RangeToHere, Id::ClipEndToPlayhead),
    (Id::RangeOfKeys, Id::LoopActions),
    (Id::RangeWhole, Id::LoopWhole),
    (Id::HideSelected, Id::HideThings),
    (Id::HideOthers, Id::HideOtherThings),
    (Id::ShowAll, Id::ShowAllThings),
    (Id::LockBones, Id::LockThings),
    (Id::RestTranslation, Id::DropToGround),
    (Id::RestPose, Id::LookThroughShot),
];

/// Returns the command that is run in place of a command for models while a scene is open.
pub(in crate::panels) fn in_scenes(id: Id) -> Option<Id> {
    COUNTERPARTS.iter().find(|(own, _)| *own == id).map(|(_, other)| *other)
}

/// Returns the commands for models whose keys run a command of scenes.
pub(super) fn for_models(id: Id) -> impl Iterator<Item = Id> {
    COUNTERPARTS.iter().filter(move |(_, other)| *other == id).map(|(own, _)| *own)
}
