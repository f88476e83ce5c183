//! Commands on the selected action of a scene.

use super::scene_dependents::{RevealedUser, user_of_actions, user_of_things};
use super::scene_text::{addition, gesture, step as step_of_texts, try_step};
use super::{keys, playback, scene_lines, scene_path_points};
use crate::panels::request::Effect;
use crate::panels::scene::shots::shots_of;
use crate::panels::scene::{ChangedThings, SceneBase, move_label};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{
    Followers, GestureRefusal, SequenceOrder, add_new_action, cut_to, delete_clips, delete_things,
    duplicate_clips, duplicate_thing, in_scene_texts, move_clips, spliced_script, trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::script::{ElementOrigin, StageScript};
use dragonfly_anim::stage::table::NEW_ACTIONS;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::script_that_names;
use std::sync::Arc;

fn followers(workspace: &Workspace) -> Followers {
    if workspace.scene.ripple() { Followers::Follow } else { Followers::Stay }
}

/// Returns the selected actions, unless the thing of one of them is locked.
pub(super) fn unlocked_actions(workspace: &mut Workspace) -> Option<Vec<usize>> {
    let actions = workspace.scene.actions().to_vec();
    let script = workspace.model.view()?.scene.as_ref()?.script.as_ref()?;
    match workspace.scene.lock_refusal(&ChangedThings::Actions(&actions).ids(script)) {
        Some(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
        None => Some(actions).filter(|actions| !actions.is_empty()),
    }
}

/// Returns the active action, unless the thing of a selected one is locked.
fn unlocked_action(workspace: &mut Workspace) -> Option<usize> {
    unlocked_actions(workspace)?.pop()
}

/// Returns the time at which the first of the actions begins.
fn first_begin(base: &SceneBase, actions: &[usize]) -> StageTime {
    let times = base.plan.schedule().times();
    let begins = actions.iter().filter_map(|&action| times.get(action)).map(|times| times.begin);
    begins.min().unwrap_or_default()
}

/// Lets the first of the selected actions begin at the playhead, the others as long after it as now.
pub(in crate::panels) fn to_playhead(workspace: &mut Workspace) -> Option<Effect> {
    let (actions, at, followers) =
        (unlocked_actions(workspace)?, workspace.read().scene_time(), followers(workspace));
    let label = move_label(workspace.model.view()?.scene.as_ref()?.script.as_ref()?, &actions);
    gesture(workspace, label, ChangedThings::Actions(&actions), |base| {
        let by = at - first_begin(base, &actions);
        move_clips(&base.scene(), &actions, by, SequenceOrder::Keep, followers)
    })
}

/// Moves the selected actions by frames.
pub(in crate::panels) fn nudge(workspace: &mut Workspace, frames: i64) -> Option<Effect> {
    let (actions, followers) = (unlocked_actions(workspace)?, followers(workspace));
    let label = move_label(workspace.model.view()?.scene.as_ref()?.script.as_ref()?, &actions);
    gesture(workspace, label, ChangedThings::Actions(&actions), |base| {
        let rate = base.script.rate();
        let begin = first_begin(base, &actions);
        let frame = rate.nearest_frame(begin);
        let at_frame = rate.frame(frame) == begin;
        // An action between two frames goes to one of them first.
        let to = if at_frame { rate.frame(frame + frames) } else { rate.frame(frame) };
        move_clips(&base.scene(), &actions, to - begin, SequenceOrder::Keep, followers)
    })
}

/// Lets the selected action start at the playhead.
pub(in crate::panels) fn start_to_playhead(workspace: &mut Workspace) -> Option<Effect> {
    let (action, at) = (unlocked_action(workspace)?, workspace.read().scene_time());
    gesture(workspace, ScriptLabel::TrimStart, ChangedThings::Actions(&[action]), |base| {
        trim_start(&base.scene(), action, at)
    })
}

/// Lets the selected action end at the playhead.
pub(in crate::panels) fn end_to_playhead(workspace: &mut Workspace) -> Option<Effect> {
    let (action, at, followers) =
        (unlocked_action(workspace)?, workspace.read().scene_time(), followers(workspace));
    gesture(workspace, ScriptLabel::TrimEnd, ChangedThings::Actions(&[action]), |base| {
        trim_end(&base.scene(), action, at, followers)
    })
}

/// Lets the part of time play and loop in which the selected actions are; without them, the part that the timeline shows.
pub(in crate::panels) fn loop_selected(workspace: &mut Workspace) {
    let (editing, context) = (&workspace.scene, workspace.read());
    let lanes = editing.lanes();
    let bars = editing.actions().iter().filter_map(|&action| Some(lanes.bar_of(action)?.1));
    let of_bars =
        bars.map(|bar| [bar.begin, bar.end]).reduce(|all, bar| [all[0].min(bar[0]), all[1].max(bar[1])]);
    let window = editing.window();
    let range = match of_bars.filter(|[from, to]| to > from) {
        Some(ends) => ends.map(|time| context.playhead_at(time)),
        None => [window.start as f32, (window.start + window.length) as f32],
    };
    keys::set_range(workspace, Some(range));
}

/// Duplicates the selected actions after the last of them ends, or the selected things, or the selected line. The copies are selected.
pub(in crate::panels) fn duplicate(workspace: &mut Workspace) -> Option<Effect> {
    if workspace.scene.lines().selected().is_some() {
        return scene_lines::duplicate(workspace);
    }
    if workspace.scene.action().is_some() {
        let actions = unlocked_actions(workspace)?;
        return addition(workspace, ScriptLabel::Duplicate, ChangedThings::Actions(&actions), |base| {
            duplicate_clips(&base.scene(), &actions)
        });
    }
    let things = workspace.scene.things().to_vec();
    let mut copies = Vec::new();
    let effect = step_of_texts(workspace, |base| {
        let (script, ids) = duplicated(base, &things)?;
        copies = ids;
        Ok(base.change(&script, ScriptLabel::Duplicate, None, ChangedThings::None))
    });
    if effect.is_some() {
        // The copies are in the places of the originals: the next drag moves a copy.
        workspace.scene.await_things(copies);
    }
    effect
}

/// Deletes the selected point of a path or a line, or the selected actions, things or lines. With `lift` what follows an action stays where it is.
pub(in crate::panels) fn delete(workspace: &mut Workspace, lift: bool) -> Option<Effect> {
    if scene_path_points::is_any_selected(workspace) {
        return scene_path_points::remove(workspace);
    }
    if workspace.scene.lines().selected().is_some() {
        return scene_lines::delete(workspace);
    }
    if workspace.scene.action().is_some() {
        let actions = unlocked_actions(workspace)?;
        let followers = if lift { Followers::Stay } else { followers(workspace) };
        let effect = try_step(workspace, |base| {
            let text = delete_clips(&base.scene(), &actions, followers)?;
            Ok(base.step(text, ScriptLabel::Delete, ChangedThings::Actions(&actions)))
        });
        let effect = effect.unwrap_or_else(|refusal| {
            let user = shown_script(workspace).and_then(|script| user_of_actions(&script, &actions));
            let kept = match actions[..] {
                [action] => workspace.scene.lanes().bar_of(action).map(|(_, bar)| bar.label.to_string()),
                _ => None,
            };
            refuse_deletion(workspace, &refusal, &kept.unwrap_or_else(|| "one of them".to_owned()), user)
        });
        if effect.is_some() {
            // None of those that are left may be taken for one of them, and the same key must not delete the thing that did them.
            workspace.scene.select_action(None);
            workspace.scene.select_things(&[], Choice::Replace);
        }
        return effect;
    }
    let things: Vec<Box<str>> =
        workspace.scene.things().iter().filter(|thing| !workspace.scene.is_locked(thing)).cloned().collect();
    if things.is_empty() {
        workspace.say(MessageSeverity::Info, "What is selected is locked");
        return None;
    }
    let scene = workspace.model.view()?.scene.clone()?;
    let mut actions = 0;
    let effect = try_step(workspace, |base| {
        let mut ids: Vec<&str> = Vec::new();
        for id in &things {
            let Some(element) = base.script.thing_element(id) else { continue };
            let other = match base.script.tree().elements()[element].origin {
                ElementOrigin::Project => script_that_names(&scene, id).map_err(GestureRefusal)?,
                ElementOrigin::Text | ElementOrigin::Included(_) => None,
            };
            if let Some(other) = other {
                return Err(GestureRefusal(format!("{other} names {id}: change that first")));
            }
            ids.push(id);
        }
        let (script, deleted) = delete_things(&base.scene(), &ids)?;
        actions = deleted;
        Ok(base.change(&script, ScriptLabel::Delete, None, ChangedThings::Things(&things)))
    });
    let effect = effect.unwrap_or_else(|refusal| {
        let user = shown_script(workspace).and_then(|script| user_of_things(&script, &things));
        let kept = if let [thing] = &things[..] { &**thing } else { "one of them" };
        refuse_deletion(workspace, &refusal, kept, user)
    });
    if effect.is_some() && actions > 0 {
        let what = if actions == 1 {
            "1 action that names".to_owned()
        } else {
            format!("{actions} actions that name")
        };
        let text = format!("Deleted {} with {what} it", things.join(", "));
        workspace.say(MessageSeverity::Info, text);
    }
    effect
}

/// Returns the script that is shown.
fn shown_script(workspace: &Workspace) -> Option<Arc<StageScript>> {
    workspace.model.view()?.scene.as_ref()?.script.clone()
}

/// Warns that something called `kept` cannot be deleted, and selects what depends on it, so that it can be changed first.
fn refuse_deletion(
    workspace: &mut Workspace,
    refusal: &GestureRefusal,
    kept: &str,
    user: Option<RevealedUser>,
) -> Option<Effect> {
    let text = match &user {
        Some(user) => {
            let name = user.name(workspace.scene.lanes());
            format!(
                "Nothing was deleted: {name} depends on {kept} and is selected now. Change or delete that first"
            )
        }
        None => format!("Nothing was deleted: {refusal}"),
    };
    match user {
        Some(RevealedUser::Action(action)) => workspace.scene.select_action(Some(action)),
        Some(RevealedUser::Thing { id, .. }) => workspace.scene.select_things(&[id], Choice::Replace),
        None => {}
    }
    workspace.say(MessageSeverity::Warning, text);
    None
}

/// Returns the script with copies of things, and the ids of the copies.
fn duplicated(base: &SceneBase, things: &[Box<str>]) -> Result<(StageScript, Vec<Box<str>>), GestureRefusal> {
    for element in things.iter().filter_map(|thing| base.script.thing_element(thing)) {
        in_scene_texts(base.script.tree(), element)?;
    }
    let mut script = StageScript::clone(&base.script);
    for thing in things {
        let element = script.thing_element(thing);
        if let Some(splices) = element.and_then(|element| duplicate_thing(&script, element)) {
            script = spliced_script(&script, &splices)?;
        }
    }
    let is_new = |id: &&str| base.script.thing_called(id).is_none();
    let copies =
        script.things().filter_map(|thing| thing.value("id")).filter(is_new).map(Box::from).collect();
    Ok((script, copies))
}

/// Adds a title at the playhead, and selects it.
pub(in crate::panels) fn add_title(workspace: &mut Workspace) -> Option<Effect> {
    let at = workspace.read().scene_time();
    let row = NEW_ACTIONS.iter().find(|row| row.element == "title")?;
    addition(workspace, ScriptLabel::adding(row.element), ChangedThings::None, |base| {
        add_new_action(&base.scene(), row, None, None, at)
    })
}

/// Inserts a shot of the camera after the one that is seen at the playhead, and selects it.
pub(in crate::panels) fn cut_to_next(workspace: &mut Workspace) -> Option<Effect> {
    let at = workspace.read().scene_time();
    addition(workspace, ScriptLabel::AddShot, ChangedThings::None, |base| {
        let cameras: Vec<&str> = base
            .plan
            .things()
            .iter()
            .filter(|thing| thing.kind == "camera")
            .map(|thing| &*thing.id)
            .collect();
        let mut scene = base.plan.new_scene();
        base.plan.scene_at(at, &mut scene);
        let seen =
            scene.camera.and_then(|camera| base.plan.things().get(camera.thing)).map(|thing| &*thing.id);
        let place = seen.and_then(|seen| cameras.iter().position(|camera| *camera == seen));
        let next = place.map_or(0, |place| (place + 1) % cameras.len().max(1));
        match cameras.get(next) {
            Some(camera) => cut_to(&base.scene(), camera, at),
            None => Err(GestureRefusal("The scene has no camera: add one first".to_owned())),
        }
    })
}

/// Inserts a shot of the selected camera, and selects it.
pub(in crate::panels) fn cut_to_selected(workspace: &mut Workspace) -> Option<Effect> {
    let (at, camera) = (workspace.read().scene_time(), workspace.scene.things().last()?.clone());
    addition(workspace, ScriptLabel::AddShot, ChangedThings::None, |base| cut_to(&base.scene(), &camera, at))
}

/// Moves the playhead to the start of the next shot, or of the one before the playhead.
pub(in crate::panels) fn go_to_shot(workspace: &mut Workspace, forward: bool) {
    let panels = workspace.read();
    let (shots, now) = (shots_of(panels.scene_editing.lanes()), panels.scene_time());
    // The playhead at the start of a shot between two numbers of it is a little after that start.
    let is_before = |shot: &&SceneBar| shot.begin < now && panels.playhead_at(shot.begin) < panels.time();
    let found = match forward {
        true => shots.iter().find(|shot| shot.begin > now),
        false => shots.iter().rev().find(is_before),
    };
    match found.map(|shot| panels.playhead_at(shot.begin)) {
        Some(time) => playback::seek(workspace, time),
        None => workspace.say(MessageSeverity::Info, "There is no shot on that side"),
    }
}

/// Selects the next or the previous action that has a bar.
pub(in crate::panels) fn step(workspace: &mut Workspace, forward: bool) {
    let lanes = workspace.scene.lanes();
    let mut actions: Vec<usize> =
        lanes.list.iter().flat_map(|lane| &lane.bars).map(|bar| bar.action).collect();
    actions.sort_unstable();
    let now = workspace.scene.action();
    let next = match (now, forward) {
        (None, true) => actions.first().copied(),
        (None, false) => actions.last().copied(),
        (Some(now), true) => actions.iter().copied().find(|&action| action > now),
        (Some(now), false) => actions.iter().rev().copied().find(|&action| action < now),
    };
    match next {
        Some(next) => workspace.scene.select_action(Some(next)),
        None => workspace.say(MessageSeverity::Info, "There is no action on that side"),
    }
}
