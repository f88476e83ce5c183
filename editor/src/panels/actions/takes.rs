//! Commands for takes: edits of the take that is shown.

use super::edit;
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::edit::{
    BoneRef, CloseLoop, CreateTake, DeleteTake, Edit, MirrorTake, MoveTake, ReverseTake, SplitTake, TakeRef,
    TrimTake,
};

/// Creates an empty take.
pub(in crate::panels) fn create(workspace: &mut Workspace) -> Option<Effect> {
    let name = unused_name(workspace, "New take", 1);
    Some(create_as(workspace, name, None))
}

/// Creates a copy of the take that is shown.
pub(in crate::panels) fn duplicate(workspace: &mut Workspace) -> Option<Effect> {
    let (take, name) = shown(workspace)?;
    let name = unused_name(workspace, &format!("{} copy", without_copy(&name)), 1);
    Some(create_as(workspace, name, Some(take)))
}

fn create_as(workspace: &mut Workspace, name: String, copy: Option<TakeRef>) -> Effect {
    workspace.takes.show_next_new();
    edit(Edit::CreateTake(CreateTake { name, copy, at: None }))
}

/// Starts to rename a take, or ends it.
pub(super) fn rename(workspace: &mut Workspace, index: Option<usize>) {
    let id = index.and_then(|index| Some(workspace.model.slots().get(index)?.id));
    workspace.takes.rename(id);
}

/// Starts to rename the take that is shown.
pub(in crate::panels) fn rename_shown(workspace: &mut Workspace) {
    let index = workspace.player.take();
    rename(workspace, index);
}

/// Puts the cursor into the fields for start and length.
pub(in crate::panels) fn ask_times(workspace: &mut Workspace) {
    workspace.takes.ask_times();
}

/// Deletes the take that is shown.
pub(in crate::panels) fn delete(workspace: &mut Workspace) -> Option<Effect> {
    let (take, _) = shown(workspace)?;
    Some(edit(Edit::DeleteTake(DeleteTake { take })))
}

/// Moves the take that is shown in the list.
pub(in crate::panels) fn move_in_list(workspace: &mut Workspace, by: isize) -> Option<Effect> {
    let (take, _) = shown(workspace)?;
    let to = workspace.player.take()?.saturating_add_signed(by);
    Some(edit(Edit::MoveTake(MoveTake { take, to })))
}

/// Splits the take that is shown in two at the time shown.
pub(in crate::panels) fn split(workspace: &mut Workspace) -> Option<Effect> {
    let (take, name) = shown(workspace)?;
    let name = unused_name(workspace, without_number(&name), 2);
    Some(edit(Edit::SplitTake(SplitTake { take, time: workspace.player.time(), name })))
}

/// Deletes all keys outside the play range.
pub(in crate::panels) fn trim(workspace: &mut Workspace) -> Option<Effect> {
    let (take, _) = shown(workspace)?;
    let ([from, to], (start, length)) = (workspace.read().trim_range(), workspace.read().take_bounds());
    if from <= start && to >= start + length {
        workspace.say(MessageSeverity::Info, "Nothing to trim: set a play range first");
        return None;
    }
    Some(edit(Edit::TrimTake(TrimTake { take, from, to, to_start: true })))
}

/// Reverses the take that is shown.
pub(in crate::panels) fn reverse(workspace: &mut Workspace) -> Option<Effect> {
    let (take, _) = shown(workspace)?;
    Some(edit(Edit::ReverseTake(ReverseTake { take })))
}

/// Mirrors the take that is shown, or the play range of it; with `of_bones` only the motion of the selected bones.
pub(in crate::panels) fn mirror(workspace: &mut Workspace, of_bones: bool) -> Option<Effect> {
    let (take, _) = shown(workspace)?;
    let selected = workspace.bones.bones().iter().filter(|_| of_bones);
    let bones = selected.map(|&bone| BoneRef::Index(bone)).collect();
    let range = workspace.keys.range();
    let (from, to) = (range.map(|[from, _]| from), range.map(|[_, to]| to));
    Some(edit(Edit::MirrorTake(MirrorTake { take, bones, side: None, pairs: Vec::new(), from, to })))
}

/// Closes the loop of the take that is shown: what follows the playhead leads into the start.
pub(in crate::panels) fn close_loop(workspace: &mut Workspace) -> Option<Effect> {
    let (take, _) = shown(workspace)?;
    let panels = workspace.read();
    let (start, length) = panels.take_bounds();
    let frames = ((start + length - panels.time()) / panels.frame_seconds()).round();
    if frames < 1.0 {
        let text = "Move the playhead to where the take begins to lead into its start, before its end";
        workspace.say(MessageSeverity::Info, text);
        return None;
    }
    let (rate, frames) = (Some(panels.frame_rate as f32), frames as u32);
    Some(edit(Edit::CloseLoop(CloseLoop { take, frames, travel: None, contacts: Vec::new(), rate })))
}

/// Returns the take that is shown and its name.
fn shown(workspace: &Workspace) -> Option<(TakeRef, String)> {
    let panels = workspace.read();
    Some((panels.shown_take_ref()?, panels.shown_take()?.name.clone()))
}

/// Returns `base`, with the first number from `first` on that makes it a name that no take has; 1 is not written.
fn unused_name(workspace: &Workspace, base: &str, first: usize) -> String {
    let takes = workspace.model.takes();
    let numbered = |number| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
    let unused = |name: &String| !takes.iter().any(|take| take.name == *name);
    (first..first + takes.len() + 1).map(numbered).find(unused).unwrap_or_else(|| base.to_owned())
}

/// Returns the name without ` copy` and its number: `Walk copy 2` and `Walk copy` are copies of `Walk`.
fn without_copy(name: &str) -> &str {
    let bare = without_number(name);
    bare.strip_suffix(" copy").or(name.strip_suffix(" copy")).filter(|bare| !bare.is_empty()).unwrap_or(name)
}

/// Returns the name without a number at its end.
fn without_number(name: &str) -> &str {
    match name.rsplit_once(' ') {
        Some((bare, number)) if !bare.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit()) => {
            bare
        }
        Some(_) | None => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_suffix_of_copies_and_numbers_is_removed_from_a_name() {
        assert_eq!(without_copy("Walk"), "Walk");
        assert_eq!(without_copy("Walk copy"), "Walk");
        assert_eq!(without_copy("Walk copy 12"), "Walk");
        assert_eq!(without_copy(" copy"), " copy");
        assert_eq!(without_copy("Take 001"), "Take 001");
        assert_eq!(without_number("Walk 2"), "Walk");
        assert_eq!(without_number("42"), "42");
    }
}
