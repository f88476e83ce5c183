//! Keys: selecting, deleting, moving by a command, markers, the play range.

use super::drags::{cancel_keys, drag_keys, release_keys};
use super::{edit, locks, playback, scene};
use crate::panels::keys::intervals::WHOLE;
use crate::panels::keys::{ButtonlessKind, ChannelId, KeyDragOp, MarkerAction, TimeWindow, channel};
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{
    BoneRef, DeleteKeys, Edit, KeyInterpolation, KeyTangents, Property, RippleKeys, SAME_TIME,
    SetInterpolation, ShapeTangents,
};
use dragonfly_document::{Change, View};
use std::collections::BTreeMap;

/// Selects the keys of channels between two times, except those of locked bones.
pub(super) fn select(
    workspace: &mut Workspace,
    channels: &[ChannelId],
    shapes: bool,
    stretch: [f32; 2],
    choice: Choice,
) {
    let Some(take) = workspace.read().shared_take().cloned() else { return workspace.keys.gain_focus() };
    if let Some(locked) = workspace.keys.select(&take, channels, shapes, stretch, choice) {
        locks::say_locked(workspace, locked);
    }
}

/// Selects all keys that are listed, except those of locked bones.
pub(in crate::panels) fn select_all(workspace: &mut Workspace) {
    let (channels, shapes) = (listed_channels(workspace), lists_shapes(workspace));
    select(workspace, &channels, shapes, WHOLE, Choice::Replace);
}

fn listed_channels(workspace: &Workspace) -> Vec<ChannelId> {
    let panels = workspace.read();
    let Some(take) = panels.take() else { return Vec::new() };
    panels.listed_bones().into_iter().flat_map(|bone| channel::channels(take, bone)).collect()
}

/// Returns whether the timeline has a row for the keys of shape keys.
fn lists_shapes(workspace: &Workspace) -> bool {
    workspace.read().lists_shapes()
}

/// Deselects all keys.
pub(in crate::panels) fn deselect(workspace: &mut Workspace) {
    workspace.keys.deselect();
}

/// Selects the keys that are listed and not selected, and deselects the others.
pub(in crate::panels) fn invert(workspace: &mut Workspace) {
    let (channels, shapes) = (listed_channels(workspace), lists_shapes(workspace));
    select(workspace, &channels, shapes, WHOLE, Choice::Toggle);
}

/// Begins to drag the selected keys from where the pointer is, without a button.
pub(in crate::panels) fn drag_now(workspace: &mut Workspace, kind: ButtonlessKind) {
    let time = workspace.player.time();
    playback::stop_at(workspace, time);
    workspace.keys.begin_buttonless(kind);
}

/// Cancels a drag of keys, or closes the overlay, or deselects bones and keys.
pub(in crate::panels) fn cancel_or_deselect(workspace: &mut Workspace) -> Option<Effect> {
    if workspace.keys.aim().is_some() {
        workspace.keys.set_aim(None);
        return None;
    }
    if workspace.keys.drag().is_some() || workspace.keys.buttonless().is_some() {
        return cancel_keys(workspace);
    }
    if !workspace.prompts.close_overlay() {
        if workspace.read().scene().is_some() {
            workspace.scene.select_things(&[], Choice::Replace);
            workspace.scene.select_action(None);
        }
        if scene::is_waiting(workspace)
            && workspace.bones.bones().is_empty()
            && workspace.keys.selection().is_empty()
        {
            return scene::show_scene(workspace);
        }
        workspace.bones.clear();
        // Keys are deselected, too, so that Delete only deletes keys that are visibly selected.
        workspace.keys.deselect();
    }
    None
}

/// Lists only bones whose keys are not those of the file, or all again. Keys that are not listed any more are deselected.
pub(in crate::panels) fn toggle_only_changed(workspace: &mut Workspace) {
    workspace.keys.toggle_only_changed();
    let listed = workspace.read().listed_bones();
    workspace.keys.deselect_all_but(&listed);
}

/// Deletes the selected keys.
pub(in crate::panels) fn delete(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let (selection, shown) = (panels.keys.selection(), panels.take()?);
    let (keys, shapes) = (selection.key_sets(shown), selection.finite_shapes(shown));
    Some(edit(Edit::DeleteKeys(DeleteKeys { take: panels.take_ref()?, keys, shapes })))
}

/// Applies an operation to the selected keys, as a drag that ends at once.
fn drag_at_once(workspace: &mut Workspace, op: KeyDragOp) -> Option<Effect> {
    if workspace.keys.drag().is_some() {
        return None;
    }
    // The first edit of a drag is always sent at once; releasing sends only the end.
    let first = drag_keys(workspace, op);
    let last = release_keys(workspace);
    let mut changes: Vec<Change> = Vec::new();
    for effect in [first, last].into_iter().flatten() {
        if let Effect::Change(change) = effect {
            changes.push(change);
        } else if let Effect::Changes(more) = effect {
            changes.extend(more);
        }
    }
    (!changes.is_empty()).then_some(Effect::Changes(changes))
}

/// Copies the selected keys to the time shown; one frame after the last one if the first one is at that time.
pub(in crate::panels) fn duplicate(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let [first, last] = panels.keys.selection().extent(panels.take()?)?;
    let by = panels.time() - first;
    let after = last - first + panels.frame_seconds();
    drag_at_once(workspace, KeyDragOp::Duplicate(if by.abs() > SAME_TIME { by } else { after }))
}

/// Scales the distances of the selected keys to the time shown.
pub(in crate::panels) fn scale(workspace: &mut Workspace, factor: f32) -> Option<Effect> {
    let about = workspace.player.time();
    drag_at_once(workspace, KeyDragOp::Scale { about, factor })
}

/// Moves the selected keys by a number of frames.
pub(in crate::panels) fn nudge(workspace: &mut Workspace, frames: f32) -> Option<Effect> {
    let by = frames * workspace.read().frame_seconds();
    drag_at_once(workspace, KeyDragOp::Move(by))
}

/// Moves the selected keys to whole frames.
pub(in crate::panels) fn snap(workspace: &mut Workspace) -> Option<Effect> {
    let rate = workspace.frame_rate.get() as f32;
    drag_at_once(workspace, KeyDragOp::Snap(rate))
}

/// Inserts a number of frames at the time shown, or removes them.
pub(in crate::panels) fn ripple(workspace: &mut Workspace, frames: f32) -> Option<Effect> {
    let panels = workspace.read();
    let (take, from) = (panels.take_ref()?, panels.time());
    let step = frames * panels.frame_seconds();
    // To remove frames, the keys after them move; keys inside the removed frames are deleted.
    let from = if frames < 0.0 { from - step } else { from };
    // If there is no key to move, the document refuses the edit and returns the reason.
    drag_at_once(workspace, KeyDragOp::Ripple { from, by: step })
        .or_else(|| Some(edit(Edit::RippleKeys(RippleKeys { take, from, by: step }))))
}

/// Sets the interpolation of the channels with selected keys. Channels of different kinds become separate steps.
pub(in crate::panels) fn interpolate(workspace: &mut Workspace, between: KeyInterpolation) -> Option<Effect> {
    let panels = workspace.read();
    let take = panels.take_ref()?;
    let mut masks: BTreeMap<BoneIndex, u8> = BTreeMap::new();
    for ((bone, property), _) in panels.keys.selection().channels() {
        *masks.entry(bone).or_default() |= 1 << property as u8;
    }
    if masks.is_empty() && !panels.keys.selection().shapes().is_empty() {
        let text = "Shape keys keep their interpolation, which is one for all shape keys of a mesh";
        workspace.say(MessageSeverity::Info, text);
        return None;
    }
    let mut groups: BTreeMap<u8, Vec<BoneRef>> = BTreeMap::new();
    for (bone, mask) in masks {
        groups.entry(mask).or_default().push(BoneRef::Index(bone));
    }
    let properties = |mask: u8| Property::ALL.into_iter().filter(move |&one| mask & (1 << one as u8) != 0);
    let edits = groups.into_iter().map(|(mask, bones)| {
        Edit::SetInterpolation(SetInterpolation {
            take: take.clone(),
            bones,
            properties: properties(mask).collect(),
            interpolation: between,
        })
    });
    Some(Effect::Changes(edits.map(|edit| Change::Edit(edit, None)).collect()))
}

/// Computes the tangents of the selected keys.
pub(in crate::panels) fn shape_tangents(workspace: &mut Workspace, kind: KeyTangents) -> Option<Effect> {
    let panels = workspace.read();
    let keys = panels.keys.selection().key_sets(panels.take()?);
    if keys.is_empty() {
        workspace.say(
            MessageSeverity::Info,
            "Tangents of shape keys are dragged in the curves, where their keys are cubic splines",
        );
        return None;
    }
    Some(edit(Edit::ShapeTangents(ShapeTangents { take: panels.take_ref()?, keys, kind })))
}

/// Adapts the markers to a newer view of the same model, which may have another path and other takes.
pub(super) fn keep_markers(workspace: &mut Workspace, before: Option<&View>) {
    let Some(view) = workspace.model.view() else { return };
    if before.is_none_or(|before| before.file != view.file) {
        workspace.keys.markers_mut().rename(view.file.key());
    }
    if let Some(before) = before.filter(|before| before.slots.len() < view.slots.len()) {
        workspace.keys.markers_mut().take_along(&before.slots, &view.slots);
    }
}

/// Changes the markers of the take that is shown.
pub(super) fn change_markers(workspace: &mut Workspace, action: MarkerAction) {
    if let Some(id) = workspace.read().slot().map(|slot| slot.id) {
        workspace.keys.markers_mut().change(id, action);
    }
}

/// Adds a marker at the time shown.
pub(in crate::panels) fn add_marker(workspace: &mut Workspace) {
    let time = workspace.player.time();
    change_markers(workspace, MarkerAction::Add(time));
    let added = workspace.read().markers().iter().find(|marker| (marker.time - time).abs() < 1e-4);
    if let Some(text) =
        added.map(|marker| format!("{} at {time:.3} s: double click its flag to name it", marker.name))
    {
        workspace.say(MessageSeverity::Info, text);
    }
}

/// Sets the play range.
pub(super) fn set_range(workspace: &mut Workspace, range: Option<[f32; 2]>) {
    let bounds = workspace.read().take_bounds();
    workspace.keys.set_range(range, bounds);
}

/// Plays the whole take.
pub(in crate::panels) fn clear_range(workspace: &mut Workspace) {
    set_range(workspace, None);
}

/// Sets the play range to the selected keys, or to the visible time if none is selected.
pub(in crate::panels) fn range_of_keys(workspace: &mut Workspace) {
    let panels = workspace.read();
    let Some(take) = panels.take() else { return };
    let window = panels.keys.window(take);
    let shown = [window.start as f32, (window.start + window.length) as f32];
    let of_keys = panels.keys.selection().extent(take).filter(|[from, to]| to > from);
    set_range(workspace, Some(of_keys.unwrap_or(shown)));
}

/// Plays from the time shown on.
pub(in crate::panels) fn range_from_here(workspace: &mut Workspace) {
    let ([_, to], now) = (range_or_take(workspace), workspace.player.time());
    set_range(workspace, Some([now, to.max(now)]));
}

/// Plays up to the time shown.
pub(in crate::panels) fn range_to_here(workspace: &mut Workspace) {
    let ([from, _], now) = (range_or_take(workspace), workspace.player.time());
    set_range(workspace, Some([from.min(now), now]));
}

fn range_or_take(workspace: &Workspace) -> [f32; 2] {
    let (start, length) = workspace.read().take_bounds();
    workspace.keys.range().unwrap_or([start, start + length])
}

/// Shows this part of time, or the whole take.
pub(super) fn show_window(workspace: &mut Workspace, window: Option<TimeWindow>) {
    if let Some(take) = workspace.read().shared_take().cloned() {
        workspace.keys.show_window(window, &take, workspace.player.time());
    }
}

/// Shows the selected keys in the timeline, or the whole take.
pub(in crate::panels) fn fit_window(workspace: &mut Workspace) {
    let panels = workspace.read();
    let Some(take) = panels.take() else { return };
    let [from, to] = panels.keys.selection().extent(take).unwrap_or([take.start, take.end()]);
    let (from, length) = (f64::from(from), f64::from(to - from));
    let whole = from <= f64::from(take.start) && f64::from(to) >= f64::from(take.end());
    let margin = (length * 0.05).max(f64::from(panels.frame_seconds()) * 2.0);
    let window = TimeWindow { start: from - margin, length: length + 2.0 * margin };
    workspace.keys.fit_window((!whole).then_some(window));
}
