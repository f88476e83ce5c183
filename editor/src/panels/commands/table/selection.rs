//! Selected and hidden bones.

use super::*;
use crate::panels::actions::bones;
use crate::panels::actions::keys;
use crate::panels::keys::BoneFlag;
use crate::panels::selected_bones::SelectionCommand;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ClearSelection, When::Always, "Select nothing", &[key(NONE, Key::Escape)], "Clears the selection", keys::cancel_or_deselect),
    command(Id::SelectParent, When::Model, "Parent bone", &[key(NONE, Key::OpenBracket)], "Selects the parent of the selected bone", |w| { bones::select_parent(w); None }),
    command(Id::SelectChild, When::Model, "Child bone", &[key(NONE, Key::CloseBracket)], "Selects the first child of the selected bone", |w| { bones::select_child(w); None }),
    command(Id::SelectAll, When::Model, "Select all bones", &[key(CTRL, Key::A)], "Selects every bone that is shown", |w| { bones::command(w, SelectionCommand::All); None }),
    command(Id::InvertSelection, When::Model, "Invert selection", &[key(CTRL, Key::I)], "Selects the shown bones that were not selected", |w| { bones::command(w, SelectionCommand::Invert); None }),
    command(Id::ExtendParent, When::Bone, "Parents too", &[key(SHIFT, Key::OpenBracket), key(SHIFT, Key::OpenCurlyBracket)], "Adds the parent of each selected bone to the selection", |w| { bones::command(w, SelectionCommand::ExtendParent); None }),
    command(Id::ExtendChild, When::Bone, "Children too", &[key(SHIFT, Key::CloseBracket), key(SHIFT, Key::CloseCurlyBracket)], "Adds the children of the selected bones to the selection", |w| { bones::command(w, SelectionCommand::ExtendChild); None }),
    command(Id::SelectBranch, When::Bone, "Whole branch", &[key(CTRL, Key::CloseBracket)], "Adds all bones below the selected ones to the selection", |w| { bones::command(w, SelectionCommand::Branch); None }),
    command(Id::GrowSelection, When::Bone, "Grow selection", &[], "Adds the neighbors of the selected bones to the selection", |w| { bones::command(w, SelectionCommand::Grow); None }),
    command(Id::ShrinkSelection, When::Bone, "Shrink selection", &[], "Deselects the bones whose neighbors are not selected", |w| { bones::command(w, SelectionCommand::Shrink); None }),
    command(Id::SelectMirror, When::Bone, "Other side", &[key(SHIFT, Key::M)], "Selects the bones of the other side, as their names say", |w| { bones::select_mirror(w, false); None }),
    command(Id::ExtendMirror, When::Bone, "Other side too", &[], "Adds the bones of the other side to the selection", |w| { bones::select_mirror(w, true); None }),
    command(Id::HideSelected, When::Bone, "Hide bones", &[key(NONE, Key::H)], "Selected bones are not drawn and not picked", |w| { bones::command(w, SelectionCommand::Hide); None }),
    command(Id::HideOthers, When::Bone, "Hide other bones", &[key(SHIFT, Key::H)], "All but the selected bones are not drawn and not picked", |w| { bones::command(w, SelectionCommand::HideOthers); None }),
    command(Id::ShowAll, When::Model, "Show all bones", &[key(ALT, Key::H)], "Hidden bones are shown again, and selected", |w| { bones::command(w, SelectionCommand::ShowAll); None }),
    command(Id::MuteBones, When::Bone, "Mute bones", &[], "Shows the selected bones at rest in the viewport, or moving again; their keys stay", |w| { bones::toggle_flag(w, BoneFlag::Mute); None }),
    command(Id::SoloBones, When::Bone, "Solo bones", &[], "Shows all other bones at rest in the viewport, or moving again", |w| { bones::toggle_flag(w, BoneFlag::Solo); None }),
    command(Id::LockBones, When::Bone, "Lock bones", &[], "The selected bones are not edited any more, or are again", |w| { bones::toggle_flag(w, BoneFlag::Lock); None }),
    command(Id::Find, When::Model, "Find a bone", &[key(CTRL, Key::F)], "Puts the cursor into the search field of the skeleton", |w| { w.prompts.set_find(true); None }),
];
