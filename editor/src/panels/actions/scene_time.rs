//! The playhead of a scene: from begin to end of actions, in sight of the timeline. The frame rate of its texts.

use super::playback;
use super::scene_text::{change_project, change_text};
use crate::panels::request::Effect;
use crate::panels::scene::ScriptChange;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::script::ScriptTree;
use dragonfly_anim::stage::splice::{TextSplices, set_attribute};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::edit::ScriptLabel;
use std::sync::Arc;

/// Moves the playhead to the next begin or end of an action, or to the one before: of the selected things, or of all where none is selected.
pub(in crate::panels) fn step_edge(workspace: &mut Workspace, forward: bool) {
    let panels = workspace.read();
    let editing = panels.scene_editing;
    let now = panels.scene_time();
    let is_meant = |name: &str| editing.things().is_empty() || editing.is_selected(name);
    let edges = editing.lanes().list.iter().filter(|lane| is_meant(&lane.name)).flat_map(|lane| &lane.bars);
    let of_bar = |bar: &SceneBar| [Some(bar.begin), (!bar.is_passive).then_some(bar.end)];
    let edges = edges.flat_map(of_bar).flatten();
    // The playhead at a time between two numbers of it is a little after that time.
    let is_before = |edge: &StageTime| *edge < now && panels.playhead_at(*edge) < panels.time();
    let found = match forward {
        true => edges.filter(|edge| *edge > now).min(),
        false => edges.filter(is_before).max(),
    };
    match found.map(|edge| panels.playhead_at(edge)) {
        Some(time) => playback::stop_at(workspace, time),
        None => workspace.say(MessageSeverity::Info, "No action begins or ends on that side"),
    }
}

/// Scrolls the timeline of the scene so that the playhead is in it, if it is paused and out of sight.
pub(super) fn bring_into_sight(workspace: &mut Workspace) {
    let moved = workspace.scene.window().showing(f64::from(workspace.player.time()));
    if moved.is_some() && !workspace.player.is_playing() {
        workspace.scene.set_window(moved);
    }
}

/// Sets the frame rate where the scene states it: in its script, otherwise in its project; in the script where neither does.
pub(super) fn set_rate(workspace: &mut Workspace, rate: u32) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let script = scene.script.as_ref()?;
    let states =
        |tree: &ScriptTree| tree.elements().first().is_some_and(|root| root.attribute("fps").is_some());
    let project = scene.project.as_ref().map(|project| project.tree());
    let of_project = project.filter(|project| states(project) && !states(script.tree()));
    let newest = match of_project {
        Some(_) => workspace.scene.project_text(&scene)?,
        None => workspace.scene.text(&scene),
    };
    let tree = of_project.unwrap_or(script.tree());
    let from = Arc::clone(tree.text());
    if *newest != from {
        workspace.say(MessageSeverity::Info, "The text has errors: correct it first");
        return None;
    }
    let splices: TextSplices = set_attribute(tree, 0, "fps", &rate.to_string())?;
    let text = splices.apply(&from);
    let change = ScriptChange {
        from,
        text,
        also: Vec::new(),
        label: ScriptLabel::ChangeFrameRate,
        gesture: None,
        things: Arc::default(),
    };
    match of_project {
        Some(_) => change_project(workspace, &change),
        None => change_text(workspace, &change),
    }
}
