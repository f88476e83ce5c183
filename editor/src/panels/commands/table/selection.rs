//! Selected and hidden bones.

use super::*;
use crate::panels::actions::bones;
use crate::panels::actions::keys;
use crate::panels::actions::sets;
use crate::panels::keys::BoneFlag;
use crate::panels::selected_bones::SelectionCommand;
use crate::panels::selection_sets::SetAction;

commands! {
    ClearSelection => When::Always, "Deselect all", [key(NONE, Key::Escape)], "Clears the selection", keys::cancel_or_deselect;
    SelectParent => When::Model, "Select parent bone", [key(NONE, Key::OpenBracket)], "Selects the parent of the selected bone", |w| { bones::select_parent(w); None }, repeats;
    SelectChild => When::Model, "Select child bone", [key(NONE, Key::CloseBracket)], "Selects the first child of the selected bone", |w| { bones::select_child(w); None }, repeats;
    SelectAll => When::Model, "Select all bones", [key(CTRL, Key::A)], "Selects all visible bones", |w| { bones::command(w, SelectionCommand::All); None };
    InvertSelection => When::Model, "Invert selection", [key(CTRL, Key::I)], "Inverts the selection of visible bones", |w| { bones::command(w, SelectionCommand::Invert); None };
    ExtendParent => When::Bone, "Add parents to selection", [key(SHIFT, Key::OpenBracket), key(SHIFT, Key::OpenCurlyBracket)], "Adds the parent of each selected bone to the selection", |w| { bones::command(w, SelectionCommand::ExtendParent); None };
    ExtendChild => When::Bone, "Add children to selection", [key(SHIFT, Key::CloseBracket), key(SHIFT, Key::CloseCurlyBracket)], "Adds the children of the selected bones to the selection", |w| { bones::command(w, SelectionCommand::ExtendChild); None };
    SelectBranch => When::Bone, "Select whole branch", [key(CTRL, Key::CloseBracket)], "Adds all bones below the selected ones to the selection", |w| { bones::command(w, SelectionCommand::Branch); None };
    GrowSelection => When::Bone, "Grow selection", [], "Adds the neighbors of the selected bones to the selection", |w| { bones::command(w, SelectionCommand::Grow); None };
    ShrinkSelection => When::Bone, "Shrink selection", [], "Deselects the bones at the edge of the selection: those with a parent or child that is not selected", |w| { bones::command(w, SelectionCommand::Shrink); None };
    SelectMirror => When::Bone, "Select mirrored bones", [key(SHIFT, Key::M)], "Selects the bones on the other side of the body, found by their names", |w| { bones::select_mirror(w, false); None };
    ExtendMirror => When::Bone, "Add mirrored bones to selection", [], "Adds the bones on the other side of the body to the selection", |w| { bones::select_mirror(w, true); None };
    SaveSelectionSet => When::Bone, "Save selection as set", [], "Saves the selected bones as a selection set, which is listed above the skeleton and kept with the file", |w| { sets::perform(w, &SetAction::Save); None };
    NextSelectionSet => When::Model, "Select next set", [], "Selects the bones of the next selection set", |w| { sets::select_next(w, true); None }, repeats;
    PreviousSelectionSet => When::Model, "Select previous set", [], "Selects the bones of the previous selection set", |w| { sets::select_next(w, false); None }, repeats;
    AddToSelectionSet => When::Bone, "Add bones to set", [], "Adds the selected bones to the selection set that was selected last", |w| { sets::change_last(w, SetAction::AddBones); None };
    RemoveFromSelectionSet => When::Bone, "Remove bones from set", [], "Removes the selected bones from the selection set that was selected last", |w| { sets::change_last(w, SetAction::RemoveBones); None };
    HideSelected => When::Bone, "Hide bones", [key(NONE, Key::H)], "Hides the selected bones", |w| { bones::command(w, SelectionCommand::Hide); None };
    HideOthers => When::Bone, "Hide other bones", [key(SHIFT, Key::H)], "Hides all bones except the selected ones", |w| { bones::command(w, SelectionCommand::HideOthers); None };
    ShowAll => When::Model, "Show all bones", [key(ALT, Key::H)], "Shows and selects all hidden bones", |w| { bones::command(w, SelectionCommand::ShowAll); None };
    MuteBones => When::Bone, "Mute bones", [], "Mutes or unmutes the animation of the selected bones in the viewport; their keys are unchanged", |w| { bones::toggle_flag(w, BoneFlag::Mute); None };
    SoloBones => When::Bone, "Solo bones", [], "Mutes or unmutes the animation of all other bones in the viewport", |w| { bones::toggle_flag(w, BoneFlag::Solo); None };
    LockBones => When::Bone, "Lock bones", [], "Locks or unlocks the selected bones against editing", |w| { bones::toggle_flag(w, BoneFlag::Lock); None };
    Find => When::Model, "Find a bone", [key(CTRL, Key::F)], "Focuses the search field of the hierarchy, of the list of things in a scene, or of the script while that is typed in", |w| { w.prompts.set_find(true); None };
}
