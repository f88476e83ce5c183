//! Selection sets: saved, selected, changed.

use crate::panels::count_text::count;
use crate::panels::selection_sets::SetAction;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::bones::Choice;

/// Carries out an action with the sets.
pub(in crate::panels) fn perform(workspace: &mut Workspace, action: &SetAction) {
    let bones_of = |workspace: &Workspace, set: usize| {
        workspace.sets.list().get(set).map(|set| set.bones.clone()).unwrap_or_default()
    };
    match *action {
        SetAction::Select(set) | SetAction::Extend(set) => {
            let is_only = matches!(action, SetAction::Select(_));
            let bones = bones_of(workspace, set);
            workspace.keys.lose_focus();
            workspace.bones.choose(&bones, if is_only { Choice::Replace } else { Choice::Add });
            workspace.sets.set_last(set);
        }
        SetAction::Subtract(set) => {
            let gone = bones_of(workspace, set);
            let kept: Vec<_> =
                workspace.bones.bones().iter().copied().filter(|bone| !gone.contains(bone)).collect();
            workspace.keys.lose_focus();
            workspace.bones.choose(&kept, Choice::Replace);
        }
        SetAction::Save
        | SetAction::AddBones(_)
        | SetAction::RemoveBones(_)
        | SetAction::Rename(..)
        | SetAction::Color(..)
        | SetAction::Remove(_) => {
            let bones = workspace.bones.bones().to_vec();
            let changed = workspace.sets.change(action, &bones);
            if let (true, SetAction::Save, Some(set)) = (changed, action, workspace.sets.list().last()) {
                let text = format!("Saved {} as {}", count(set.bones.len(), "bone", "bones"), set.name);
                workspace.say(MessageSeverity::Info, text);
            }
        }
    }
}

/// Selects the next set after the one that was selected last, or the previous one.
pub(in crate::panels) fn select_next(workspace: &mut Workspace, forward: bool) {
    let sets = workspace.sets.list().len();
    if sets == 0 {
        return workspace.say(MessageSeverity::Info, "There is no selection set: save the selection as one");
    }
    let next = match workspace.sets.last() {
        None => 0,
        Some(last) if forward => (last + 1) % sets,
        Some(last) => (last + sets - 1) % sets,
    };
    perform(workspace, &SetAction::Select(next));
}

/// Adds the selected bones to the set that was selected last, or removes them from it.
pub(in crate::panels) fn change_last(workspace: &mut Workspace, action: impl FnOnce(usize) -> SetAction) {
    match workspace.sets.last() {
        Some(last) => perform(workspace, &action(last)),
        None => workspace.say(MessageSeverity::Info, "Select a selection set first"),
    }
}
