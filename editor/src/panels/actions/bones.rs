//! Commands that select, hide and flag bones, and the one that adds a root bone.

use super::edit;
use crate::panels::count_text::count;
use crate::panels::keys::BoneFlag;
use crate::panels::request::Effect;
use crate::panels::selected_bones::SelectionCommand;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{AddRootBone, Edit};
use egui::Pos2;

/// Applies a command to the selection and the hidden bones.
pub(in crate::panels) fn command(workspace: &mut Workspace, command: SelectionCommand) {
    if let Some(loaded) = workspace.model.loaded() {
        workspace.bones.command(command, &loaded.model.animation.skeleton);
    }
}

/// Selects the parent of the active bone; the first bone if none is selected.
pub(in crate::panels) fn select_parent(workspace: &mut Workspace) {
    if let Some(loaded) = workspace.model.loaded() {
        workspace.bones.select_parent(&loaded.model.animation.skeleton);
    }
}

/// Selects the first child of the active bone.
pub(in crate::panels) fn select_child(workspace: &mut Workspace) {
    if let Some(loaded) = workspace.model.loaded() {
        workspace.bones.select_child(&loaded.model.animation.skeleton);
    }
}

/// Selects the bones on the other side of the body; with `extend`, adds them to the selection.
pub(in crate::panels) fn select_mirror(workspace: &mut Workspace, extend: bool) {
    let Some(loaded) = workspace.model.loaded() else { return };
    if !workspace.bones.mirror(&loaded.model.animation.skeleton, extend) {
        workspace.say(MessageSeverity::Info, "No bone on the other side with a matching name was found");
    }
}

/// Sets a flag of the selected bones, or clears it if all of them have it.
pub(in crate::panels) fn toggle_flag(workspace: &mut Workspace, flag: BoneFlag) {
    let bones = workspace.bones.bones().to_vec();
    let on = !bones.iter().all(|&bone| workspace.keys.flags().has(flag, bone));
    for &bone in &bones {
        workspace.keys.set_flag(flag, bone, on);
    }
    let what = bones_text(workspace, &bones);
    let verb = if on { "on" } else { "off" };
    workspace.say(MessageSeverity::Info, format!("{} {verb}: {what}", flag.name()));
}

/// Returns the name of one bone, or the number of several.
pub(super) fn bones_text(workspace: &Workspace, bones: &[BoneIndex]) -> String {
    match *bones {
        [bone] => workspace.read().bone_name(bone),
        _ => count(bones.len(), "bone", "bones"),
    }
}

/// Selects one of the bones under a click, which come from the graphics thread, the nearest first.
pub(in crate::panels) fn picked(workspace: &mut Workspace, at: Pos2, bones: &[BoneIndex], choice: Choice) {
    if !bones.is_empty() || !workspace.tools.clicked_handle() {
        workspace.bones.clicked(at, bones, choice);
    }
}

/// Stores the position of the pointer over the viewport. Bones that are not drawn are not highlighted.
pub(super) fn point(workspace: &mut Workspace, pointer: Option<Pos2>) {
    let shown = workspace.read().shows_skeleton();
    workspace.bones.set_pointer(pointer.filter(|_| shown));
}

/// Adds a root bone with a name that no bone has.
pub(in crate::panels) fn add_root(workspace: &mut Workspace) -> Option<Effect> {
    let skeleton = &workspace.model.loaded()?.model.animation.skeleton;
    let numbered = |number: usize| if number == 1 { "Root".to_owned() } else { format!("Root {number}") };
    let unused = |name: &String| skeleton.find(name).is_none();
    let name = (1..=skeleton.len() + 1).map(numbered).find(unused)?;
    Some(edit(Edit::AddRootBone(AddRootBone { name })))
}
