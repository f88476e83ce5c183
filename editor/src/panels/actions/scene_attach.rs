//! Things attached to bones and other things, and detached.

use super::scene_gizmo::joined;
use super::scene_probe::{pointer, surface_at};
use super::scene_text::gesture;
use crate::panels::request::Effect;
use crate::panels::scene::ChangedThings;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{
    GestureRefusal, HeldGrip, attach_splices, detach_splices, spliced_text,
};
use dragonfly_anim::stage::{RigidPlace, ThingHold};
use dragonfly_document::edit::ScriptLabel;

/// Attaches the selected things to the bone under the pointer from the playhead on; while the pointer is elsewhere, to the thing that was selected last.
/// They stay where they are.
pub(in crate::panels) fn attach(workspace: &mut Workspace) -> Option<Effect> {
    let mut things = unlocked(workspace);
    let selected = workspace.scene.things().to_vec();
    let under = pointer(workspace).and_then(|at| surface_at(workspace, at, &selected));
    let holder = match under {
        Some(surface) => surface.name(),
        None if selected.len() > 1 => {
            let holder = selected.last()?.clone();
            things.retain(|id| *id != holder);
            holder.into()
        }
        None => {
            let text = "Point at the bone or thing that is to hold the selection, or select that last";
            workspace.say(MessageSeverity::Info, text);
            return None;
        }
    };
    let at = workspace.read().scene_time();
    let effect = gesture(workspace, ScriptLabel::Attach, ChangedThings::Things(&things), |base| {
        let mut state = base.plan.new_scene();
        base.plan.scene_at(at, &mut state);
        let by = base.plan.place_of_name(&holder, &state);
        let by = by.ok_or_else(|| GestureRefusal(format!("There is no {holder} to hold it")))?;
        let attached = |id: &str| {
            let thing = base.plan.thing_called(id).and_then(|thing| state.things.get(thing));
            let place = thing.map(|thing| RigidPlace {
                position: thing.transform.translation.as_dvec3(),
                rotation: thing.transform.rotation.as_dquat().normalize(),
            });
            let grip = place.map(|place| HeldGrip::keeping(&by, &place));
            attach_splices(&base.scene(), id, &holder, at, grip.as_ref())
        };
        let parts: Result<Vec<_>, GestureRefusal> = things.iter().map(|id| attached(id)).collect();
        spliced_text(&base.script, joined(parts?)?)
    });
    if effect.is_some() {
        workspace.say(
            MessageSeverity::Info,
            format!("Attached to {holder}: it stays where it is, and moves along"),
        );
    }
    effect
}

/// Detaches the selected things from what holds them at the playhead. They stay where they are.
pub(in crate::panels) fn detach(workspace: &mut Workspace) -> Option<Effect> {
    let (things, at) = (unlocked(workspace), workspace.read().scene_time());
    gesture(workspace, ScriptLabel::Detach, ChangedThings::Things(&things), |base| {
        let mut state = base.plan.new_scene();
        base.plan.scene_at(at, &mut state);
        let is_held = |id: &str| {
            let hold = base.plan.thing_called(id).and_then(|thing| base.plan.hold_of(thing, &state));
            matches!(hold, Some(ThingHold::Attached { .. }))
        };
        let held: Vec<&str> = things.iter().map(|id| &**id).filter(|id| is_held(id)).collect();
        if held.is_empty() {
            return Err(GestureRefusal("Nothing that is selected is held at this time".to_owned()));
        }
        let parts: Result<Vec<_>, GestureRefusal> =
            held.into_iter().map(|id| detach_splices(&base.scene(), id, at)).collect();
        spliced_text(&base.script, joined(parts?)?)
    })
}

fn unlocked(workspace: &Workspace) -> Vec<Box<str>> {
    workspace.scene.things().iter().filter(|id| !workspace.scene.is_locked(id)).cloned().collect()
}
