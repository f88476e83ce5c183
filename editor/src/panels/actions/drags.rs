//! Drags of keys, and the end of any drag that another request interrupts.

use crate::panels::change_summary;
use crate::panels::dragging::Admission;
use crate::panels::keys::drag::KeyDrag;
use crate::panels::keys::{ChannelId, KeyDragOp, KeySelection, channel};
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{Edit, OffsetKeys};
use dragonfly_document::history::Gesture;
use egui::{Context, Popup};
use std::sync::Arc;

/// Passes an effect on. If it would interrupt a drag, the change that cancels the drag is passed on first.
pub(in crate::panels) fn let_through(
    workspace: &mut Workspace,
    effect: Effect,
    pass: &mut impl FnMut(Effect),
) {
    match effect {
        Effect::Change(change) => pass_change(workspace, change, pass),
        Effect::Changes(changes) => {
            for change in changes {
                pass_change(workspace, change, pass);
            }
        }
        Effect::Cut(text, change) => {
            pass(Effect::Copy(text));
            pass_change(workspace, change, pass);
        }
        Effect::CancelDrag => cancel_drag(workspace, pass),
        Effect::ReleaseDrag => release_drag(workspace, pass),
        Effect::File(action) => {
            if !action.spares_drag() {
                cancel_drag(workspace, pass);
            }
            pass(Effect::File(action));
        }
        effect @ (Effect::Send(..)
        | Effect::OpenDialog
        | Effect::CompareDialog
        | Effect::Choose(..)
        | Effect::Copy(_)
        | Effect::PastePose { .. }
        | Effect::Pick(..)
        | Effect::Catch(..)
        | Effect::FullScreen
        | Effect::TogglePanel(_)
        | Effect::ShowPanel(_)
        | Effect::ResetLayout
        | Effect::NewScene(_)
        | Effect::DemoScene(_)
        | Effect::NewProject(_)
        | Effect::LookAtModels(_)
        | Effect::LookAtFiles(_)
        | Effect::CopyFiles(_)
        | Effect::RetryDevice) => pass(effect),
    }
}

/// Passes a change on, unless it belongs to a drag that is over.
fn pass_change(workspace: &mut Workspace, change: Change, pass: &mut impl FnMut(Effect)) {
    match workspace.dragging.admit(&change) {
        Admission::Drop => {
            workspace.scene.dropped(&change);
            if let Change::Edit(_, Some(gesture)) = change {
                workspace.keys.forget_drag(gesture);
            }
            return;
        }
        Admission::Pass => {}
        Admission::CancelDragFirst => cancel_drag(workspace, pass),
    }
    let change = match change {
        Change::Edit(Edit::OffsetKeys(edit), Some(gesture)) => {
            Change::Edit(preview(workspace, edit, gesture), Some(gesture))
        }
        Change::Release(gesture) => {
            send_held_offset(workspace, gesture, pass);
            Change::Release(gesture)
        }
        Change::Cancel(gesture) => {
            workspace.dragging.take_offset(gesture);
            Change::Cancel(gesture)
        }
        change @ (Change::Edit(..) | Change::Undo | Change::Redo | Change::GoTo(_)) => change,
    };
    send(workspace, change, pass);
}

/// Returns the edit to send now in place of an offset of many keys that is being dragged.
fn preview(workspace: &mut Workspace, edit: OffsetKeys, gesture: Gesture) -> Edit {
    let Workspace { dragging, model, player, .. } = workspace;
    let view = model.view();
    let take = view.zip(player.take()).and_then(|(view, take)| view.takes.get(take));
    let bones = edit.bones_named();
    dragging
        .preview(edit, gesture, view, |time| take.map_or([time; 2], |take| keys_around(take, &bones, time)))
}

/// Returns the last key of these bones at or before a time, and the first one at or after it.
fn keys_around(take: &Take, bones: &[BoneIndex], time: f32) -> [f32; 2] {
    let channels = bones.iter().flat_map(|&bone| channel::channels(take, bone));
    channels.fold([time; 2], |[from, to], id| {
        let times = channel::times(take, id);
        let before = times.partition_point(|&key| key <= time).checked_sub(1);
        let after = times.partition_point(|&key| key < time);
        let before = before.map_or(from, |at| times[at].min(from));
        [before, times.get(after).map_or(to, |&after| after.max(to))]
    })
}

/// Sends the offset that was held back during a drag.
fn send_held_offset(workspace: &mut Workspace, gesture: Gesture, pass: &mut impl FnMut(Effect)) {
    if let Some(edit) = workspace.dragging.take_offset(gesture) {
        send(workspace, Change::Edit(edit, Some(gesture)), pass);
    }
}

/// Assigns a number to a change, shows its result before the document answers if possible, and passes it on.
fn send(workspace: &mut Workspace, change: Change, pass: &mut impl FnMut(Effect)) {
    // Movements of a drag are not noted, and allocate nothing.
    let selection = workspace.selections.notes(&change).then(|| workspace.selection_state());
    let number = workspace.model.send(&change, &mut workspace.dragging.echo);
    workspace.scene.passed_on(number, &change);
    if let Some(selection) = selection {
        workspace.selections.send(number, &change, selection);
    } else if let Change::Cancel(gesture) = &change {
        workspace.selections.cancel(*gesture);
    }
    if let Change::Edit(_, Some(gesture)) | Change::Cancel(gesture) = change {
        workspace.keys.sent(gesture, number);
        let take = workspace.read().shared_take().cloned();
        workspace.keys.follow_drag(take.as_deref(), &workspace.dragging.echo);
    }
    pass(Effect::Send(number, change));
}

/// Cancels the drag in progress, whichever panel or tool it belongs to, as if it had never begun.
fn cancel_drag(workspace: &mut Workspace, pass: &mut impl FnMut(Effect)) {
    if workspace.read().keeps_gesture() {
        workspace.stage.end_camera();
        if let Some(gesture) = workspace.dragging.release() {
            send(workspace, Change::Release(gesture), pass);
        }
        return;
    }
    if workspace.tools.controls().edits() || workspace.stage.camera_drag().is_some() {
        workspace.tools.drop_drag();
    }
    workspace.stage.end_camera();
    workspace.stage.end_drag();
    workspace.keys.drop_held();
    if let Some(gesture) = workspace.dragging.cancel() {
        workspace.dragging.take_offset(gesture);
        send(workspace, Change::Cancel(gesture), pass);
    }
}

/// Ends a drag whose end was not reported: no button is held any more.
fn release_drag(workspace: &mut Workspace, pass: &mut impl FnMut(Effect)) {
    let now = workspace.player.now();
    let is_turning = workspace.stage.is_turning(workspace.dragging.open())
        && workspace.stage.turn_left(now).is_some_and(|left| !left.is_zero());
    if !is_turning
        && !workspace.tools.controls().is_busy()
        && workspace.keys.buttonless().is_none()
        && let Some(gesture) = workspace.dragging.release()
    {
        if workspace.stage.camera_drag() == Some(gesture) {
            workspace.stage.end_camera();
        }
        send_held_offset(workspace, gesture, pass);
        send(workspace, Change::Release(gesture), pass);
    }
}

/// Handles a window that lost the keyboard: the end of a drag may not be reported. The drag is cancelled, and the panels get
/// the Escape key and then events that release the buttons.
pub(super) fn lose_input(workspace: &mut Workspace, context: &Context, effects: &mut Vec<Effect>) {
    effects.push(Effect::CancelDrag);
    // No Escape while text is being typed, or while a question or a menu is open: it would close them.
    let escape = !context.text_edit_focused()
        && workspace.prompts.question().is_none()
        && !Popup::is_any_open(context);
    workspace.dragging.release_buttons(context, escape);
}

/// Begins or continues a drag of keys.
pub(in crate::panels) fn drag_keys(workspace: &mut Workspace, op: KeyDragOp) -> Option<Effect> {
    if !workspace.keys.may_drag() {
        return None;
    }
    if workspace.keys.drag().is_none() {
        let panels = workspace.read();
        let (take, base) = (panels.take_ref()?, Arc::clone(panels.shared_take()?));
        let moving = match op {
            KeyDragOp::Ripple { from, .. } => all_after(&base, from),
            KeyDragOp::Move(_)
            | KeyDragOp::Scale { .. }
            | KeyDragOp::Stretch { .. }
            | KeyDragOp::Duplicate(_)
            | KeyDragOp::Snap(_)
            | KeyDragOp::Edit(_) => panels.keys.selection().clone(),
        };
        if moving.is_empty() && !matches!(op, KeyDragOp::Edit(_)) {
            return None;
        }
        let gesture = workspace.dragging.new_gesture();
        workspace.keys.begin_drag(KeyDrag::begin(gesture, take, base, moving, op.clone()));
    }
    workspace.keys.continue_drag(op, &workspace.dragging.echo).map(Effect::Change)
}

/// Returns all keys of a take from a time on.
fn all_after(take: &Take, from: f32) -> KeySelection {
    let bones = take.tracks.iter().map(|track| track.bone);
    let all: Vec<ChannelId> = bones.flat_map(|bone| channel::channels(take, bone)).collect();
    let mut late = KeySelection::default();
    late.choose(take, &all, [from, f32::INFINITY], Choice::Replace);
    late
}

/// Releases a drag of keys.
pub(in crate::panels) fn release_keys(workspace: &mut Workspace) -> Option<Effect> {
    let changes = workspace.keys.release_drag(&workspace.dragging.echo)?;
    settle_keys(workspace);
    (!changes.is_empty()).then_some(Effect::Changes(changes))
}

/// Cancels a drag of keys; does nothing if there is none.
pub(in crate::panels) fn cancel_keys(workspace: &mut Workspace) -> Option<Effect> {
    workspace.keys.cancel_drag().map(Effect::Change)
}

/// Selects pasted keys once the document has them, and ends a released drag once all its edits are answered.
pub(super) fn settle_keys(workspace: &mut Workspace) {
    let Some(generation) = workspace.model.view().map(|view| view.generation) else { return };
    let take = workspace.read().shared_take().cloned();
    let place = workspace.read().key_slot().cloned();
    let pasted = place.and_then(|slot| workspace.keys.select_pasted(&slot, take.as_deref(), generation));
    let moved = workspace.keys.settle(take.as_deref(), &workspace.dragging.echo);
    for ended in [pasted, moved].into_iter().flatten() {
        let now = take.as_ref().map_or(0, |take| take.keys());
        if let Some(view) = workspace.model.view()
            && let Some(text) = change_summary::describe_replaced(view, ended.before, ended.added, now)
        {
            workspace.status.remark(text);
        }
    }
}

/// Handles an edit that the document refused: keys that were to be selected after it are not.
pub(in crate::panels) fn refused(workspace: &mut Workspace) {
    workspace.scene.refused();
    workspace.keys.refused();
    settle_keys(workspace);
}
