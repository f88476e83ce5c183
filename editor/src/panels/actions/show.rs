//! The start of a frame, and a newer view of the document.

use super::reopened::BeforeReload;
use super::{
    drags, framing, keys, layers, left_scene, playback, scene, scene_around, scene_camera, scene_lines,
    scope, tools, undo,
};
use crate::panels::change_summary;
use crate::panels::compared::CompareWith;
use crate::panels::difference_text::ShownScale;
use crate::panels::marks::{BoneMarks, RecalledMarks};
use crate::panels::workspace::Workspace;
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::View;
use dragonfly_document::edit::{BonePose, BoneRef};
use dragonfly_picture::ThroughCamera;
use std::sync::Arc;
use std::time::Instant;

/// Starts a frame: computes what the panels read.
pub(in crate::panels) fn begin_frame(workspace: &mut Workspace, now: Instant) {
    workspace.player.set_now(now);
    workspace.status.begin_frame(now);
    workspace.player.stop_at_end();
    drags::settle_keys(workspace);
    if let Some(take) = workspace.read().shared_take().cloned() {
        workspace.keys.reserve_margin(&take, workspace.player.time());
    }
    workspace.keys.deselect_unlisted(workspace.bones.selection());
    undo::follow_selection(workspace);
    let playback = workspace.player.playback();
    workspace.posed.set_running(playback.moves(now));
    let keys = workspace.read().shown_keys();
    workspace.model.update_digest(keys, workspace.bones.active());
    let (view, rate) = (workspace.model.view(), workspace.frame_rate.get());
    workspace.contacts.update(view, playback.take, rate, workspace.unit.meters());
    workspace.compared_file.update(view.map(|view| &view.loaded.model.animation.skeleton));
    if let Some(view) = workspace.model.view() {
        workspace.posed.hold_still(workspace.keys.flags(), view);
        workspace.tools.path_mut().hold_still(workspace.keys.flags(), view);
        if workspace.bones.active().is_some() {
            workspace.posed.update(view, playback.take, workspace.player.time());
        }
    }
    scene_camera::update(workspace);
    tools::sync_gizmo(workspace);
    tools::update_path(workspace);
    let scene = workspace.model.view().and_then(|view| view.scene.clone());
    let of = scene_lines::place_of_selected(workspace);
    workspace.scene.update_lines(scene.as_deref(), workspace.dragging.is_open(), of);
    tools::show_points(workspace);
}

/// Shows a newer view of the document. If it is of another model, plays the first take that moves from its start.
pub(in crate::panels) fn show(workspace: &mut Workspace, view: View) {
    let (answered, done) = (view.answered, view.history.done);
    let view = workspace.model.receive(view, &mut workspace.dragging.echo);
    if workspace.model.is_replaced_by(&view) {
        note_marks(workspace);
        let before = BeforeReload::of(workspace, &view);
        workspace.camera.activate(false);
        let left = left_scene::leave(workspace).or(workspace.left_scene.take());
        workspace.stage.reset();
        workspace.probe.clear();
        workspace.tools.controls_mut().line_mut().choose(None);
        workspace.camera.set_through(ThroughCamera::Free);
        workspace.camera.set_second(None);
        workspace.model.replace(view);
        workspace.selections.open(done);
        workspace.trail.clear();
        workspace.compared = CompareWith::Nothing;
        workspace.scene.reset();
        show_model(workspace);
        before.into_iter().for_each(|before| before.restore(workspace));
        scene::opened(workspace);
        match left {
            Some(left) if left_scene::is_shown(&left, workspace) => left_scene::restore(left, workspace),
            left => workspace.left_scene = left,
        }
        scene_around::entered(workspace);
        return;
    }
    let before = workspace.model.replace(view);
    scene::follow(workspace, answered);
    follow_bones(workspace, before.as_ref(), answered);
    playback::follow_take(workspace, before.as_ref());
    keys::keep_markers(workspace, before.as_ref());
    layers::follow_layers(workspace, before.as_ref());
    if let Some((old, new)) = before.as_ref().zip(workspace.model.view()) {
        if !change_summary::same_steps(&old.history, &new.history) {
            let kept = old.history.done.min(new.history.done.saturating_sub(1));
            workspace.trail.forget_after(kept);
            workspace.scene.forget_hiding_after(kept);
        }
        let scale =
            ShownScale { frame_rate: workspace.frame_rate.get(), millimeters: workspace.unit.millimeters() };
        let status = &mut workspace.status;
        match change_summary::describe_change(old, new, scale) {
            Some(summary) => workspace.remark.say(old, summary, status),
            None if !workspace.dragging.is_open() => workspace.remark.update(new, scale, status),
            None => {}
        }
    }
    drags::settle_keys(workspace);
    playback::keep_take(workspace);
    if let Some(selection) = workspace.selections.receive(answered, done) {
        workspace.restore_selection(&selection);
    }
}

/// Follows the bones to the skeleton that is shown now, where an edit added root bones or was undone.
fn follow_bones(workspace: &mut Workspace, before: Option<&View>, answered: u64) {
    let (Some(before), Some(view)) = (before, workspace.model.view()) else { return };
    let shift = view.bones_since(&before.opened, &before.loaded);
    let Some(shift) = shift.filter(|shift| !shift.is_identity()) else { return };
    let count = view.loaded.model.animation.skeleton.len();
    workspace.tools.drop_drag();
    workspace.tools.set_pole(workspace.tools.ik().pole.and_then(|pole| shift.bone(pole)));
    workspace.bones.shift(shift, count);
    workspace.keys.shift(shift);
    workspace.sets.shift(shift);
    workspace.given.shift(shift);
    workspace.selections.shift_sent(shift, answered);
    workspace.copied_pose = workspace.copied_pose.take().map(|poses| {
        poses
            .iter()
            .filter_map(|pose| Some(BonePose { bone: shifted(&pose.bone, shift)?, ..pose.clone() }))
            .collect()
    });
}

fn shifted(bone: &BoneRef, shift: BoneShift) -> Option<BoneRef> {
    match bone {
        BoneRef::Index(bone) => shift.bone(*bone).map(BoneRef::Index),
        BoneRef::Name(_) => Some(bone.clone()),
    }
}

/// Shows a model that was just opened.
fn show_model(workspace: &mut Workspace) {
    scope::reset(workspace);
    workspace.tools.drop_drag();
    workspace.bones.reset(workspace.model.bones());
    workspace.tools.set_pole(None);
    workspace.sets.replace(Vec::new());
    workspace.reference.set(Default::default());
    workspace.sound.set(Default::default());
    if let Some(view) = workspace.model.view() {
        workspace.keys.open(view.file.key());
        workspace.unit.guess(&view.loaded.model.animation.skeleton);
    }
    guess_frame_rate(workspace);
    recall_marks(workspace);
    let takes = workspace.model.takes();
    // Some programs write a single pose before the takes that move.
    let moving = takes.iter().position(|take| take.length > 0.0);
    let first = moving.or((!takes.is_empty()).then_some(0));
    playback::show_take(workspace, first);
    // Restored work stays at the time where it was edited.
    let restored = workspace.model.view().is_some_and(|view| !view.history.steps.is_empty());
    let plays = moving.is_some() && !restored && workspace.prompts.question().is_none();
    workspace.player.set_playing(plays, workspace.settings.speed, workspace.settings.repeat);
    framing::frame_model(workspace);
}

fn marks(workspace: &Workspace) -> BoneMarks<'_> {
    BoneMarks {
        flags: workspace.keys.flags(),
        pins: workspace.bones.pins(),
        pole: workspace.tools.ik().pole,
        frame_rate: workspace.frame_rate.chosen(),
        meters_per_unit: workspace.unit.chosen(),
        sets: &workspace.sets,
        reference: &workspace.reference,
        sound: &workspace.sound,
        things: workspace.read().scene().is_some().then(|| workspace.scene.marks()),
    }
}

/// Notes the marks of the model that is open, if they changed.
pub(in crate::panels) fn note_marks(workspace: &mut Workspace) {
    let mut remembered = std::mem::take(&mut workspace.marks);
    if let Some(view) = workspace.model.view() {
        remembered.note(view, marks(workspace));
    }
    workspace.marks = remembered;
}

/// Gives the model that was just opened the marks that its file had.
fn recall_marks(workspace: &mut Workspace) {
    let mut remembered = std::mem::take(&mut workspace.marks);
    let recalled = workspace.model.view().and_then(|view| remembered.recall(view));
    if let Some(recalled) = recalled {
        let RecalledMarks {
            flags,
            pins,
            pole,
            frame_rate,
            meters_per_unit,
            sets,
            reference,
            sound,
            hidden_things,
            locked_things,
        } = recalled;
        workspace.scene.recall_marks(hidden_things, locked_things);
        for (flag, bone) in flags {
            workspace.keys.set_flag(flag, bone, true);
        }
        workspace.bones.set_pins(pins);
        workspace.sets.replace(sets);
        workspace.reference.set(reference.unwrap_or_default());
        workspace.sound.set(sound.unwrap_or_default());
        workspace.tools.set_pole(pole);
        if let Some(rate) = frame_rate {
            workspace.frame_rate.choose(rate);
        }
        workspace.unit.choose(meters_per_unit);
        if let Some(view) = workspace.model.view() {
            remembered.recalled(view, marks(workspace));
        }
    }
    workspace.marks = remembered;
}

/// Sets the lowest usual frame rate that the keys of the model fit.
fn guess_frame_rate(workspace: &mut Workspace) {
    // Without layers, which have keys between frames where they are merged into what is seen.
    let takes: Vec<_> = workspace.model.slots().iter().map(|slot| Arc::clone(&slot.result)).collect();
    workspace.frame_rate.guess(&takes);
}
