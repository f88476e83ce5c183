//! Scenes: things of the cast, actions of the timeline.

use super::*;
use crate::panels::actions::{
    keys, scene, scene_attach, scene_clipboard, scene_clips, scene_focus, scene_ground, scene_lines,
    scene_split, scene_text, scene_time,
};
use crate::panels::file_choice::FileChoice;
use crate::panels::scene::NewThing;

commands! {
    NewScene => When::Always, "New scene of two roles…", [], "Chooses a model, writes a project with a scene of two roles of it next to its file, and opens it (script, movie)", |w| Some(Effect::Choose(FileChoice::NewScene, w.read().model_folder()));
    DemoScene => When::Always, "New scene of two built-in figures…", [], "Chooses a folder, writes two figures and a scene with them there, and opens the scene", |w| Some(Effect::Choose(FileChoice::DemoScene, w.read().model_folder()));
    ProjectFromScene => When::Scene, "New project from this scene", [], "Writes a project (.meproj) and a file for drawn lines next to the script, and opens the project", scene_lines::project_from_scene;
    AddRole => When::Scene, "Add role…", [], "Adds a figure to the scene: a model whose takes it can play", |w| Some(Effect::Choose(FileChoice::Role, w.read().model_folder()));
    AddProp => When::Scene, "Add prop…", [], "Adds an object to the scene: a model that stands somewhere or is carried", |w| Some(Effect::Choose(FileChoice::Prop, w.read().model_folder()));
    AddSceneCamera => When::Scene, "Add camera", [], "Adds a camera to the scene", |w| scene_text::add(w, &NewThing::Camera);
    AddLight => When::Scene, "Add light", [], "Adds a sun to the scene", |w| scene_text::add(w, &NewThing::Light);
    AddEffect => When::Scene, "Add effect", [], "Adds rain to the scene; it is on from the playhead on, but effects are not drawn yet", |w| scene_text::add(w, &NewThing::Effect);
    AddPath => When::Scene, "Add path", [], "Adds a path that roles can follow", |w| scene_text::add(w, &NewThing::Path);
    AddMark => When::Scene, "Add mark", [], "Adds a place to which roles can go", |w| scene_text::add(w, &NewThing::Mark);
    AddSceneSound => When::Scene, "Add sound…", [], "Adds a sound to the scene, which begins at the playhead (audio, music)", |w| Some(Effect::Choose(FileChoice::SceneSound, w.read().model_folder()));
    AddTitle => When::Scene, "Add title", [], "Adds a title at the playhead, a text over the image", scene_clips::add_title;
    LineAsPath => When::Scene, "Use line as path", [], "Adds a path along the selected line, which roles can follow", scene_lines::use_as_path;
    WalkAlong => When::Thing, "Walk along path", [], "Lets the selected role follow the selected path from the playhead on, with its take for walking; cameras, props, lights and effects can follow it too", scene_lines::walk_along;
    DeleteLine => When::Scene, "Delete line", [], "Deletes the selected lines of the project", scene_lines::delete;
    SceneRename => When::ThingOrLine, "Rename", [], "Renames the selected thing wherever the script names it, or the selected line", |w| { scene::rename(w); None };
    HideThings => When::Thing, "Hide things", [], "Hides the selected things in the viewport; movies show them", |w| { scene::hide(w, false); None };
    HideOtherThings => When::Thing, "Hide other things", [], "Hides all things except the selected ones", |w| { scene::hide(w, true); None };
    ShowAllThings => When::Scene, "Show all things", [], "Shows and selects all hidden things", |w| { scene::show_all(w); None };
    LockThings => When::Thing, "Lock things", [], "Locks or unlocks the selected things, so that they are not changed with the mouse", |w| { scene::toggle_lock(w); None };
    DropToGround => When::Thing, "Drop to the ground", [], "Moves the selected roles, props and marks up or down so that they stand on the ground", scene_ground::drop_selected;
    ToggleGroundSnap => When::Always, "Snap to the ground", [], "Keeps roles, props and marks on the ground while they are moved", |w| { scene_ground::toggle(w); None };
    AttachHere => When::Thing, "Attach to the bone under the pointer", [key(NONE, Key::J)], "Attaches the selected things to the bone or thing under the pointer, or to the one selected last, from the playhead on; they stay where they are. An object dropped as a file on a bone sits in its place instead", scene_attach::attach;
    DetachHere => When::Thing, "Detach", [key(ALT, Key::J)], "Detaches the selected things at the playhead; they stay where they are", scene_attach::detach;
    PickFocus => When::Scene, "Pick the focus", [], "Lets the next click set the focus of the camera of the view, or of the selected one: a bone, or with Shift and elsewhere a distance", |w| { scene_focus::begin(w); None };
    CutHere => When::Scene, "Cut to the next camera here", [], "Inserts a shot of the next camera at the playhead", scene_clips::cut_to_next;
    CutToCamera => When::Thing, "Cut to this camera here", [], "Inserts a shot of the selected camera at the playhead", scene_clips::cut_to_selected;
    PreviousShot => When::Scene, "Go to previous shot", [], "Moves the playhead to the start of the shot before it", |w| { scene_clips::go_to_shot(w, false); None };
    NextShot => When::Scene, "Go to next shot", [], "Moves the playhead to the start of the next shot", |w| { scene_clips::go_to_shot(w, true); None };
    PreviousEdge => When::Scene, "Go to previous begin or end", [], "Moves the playhead to where an action of the selected things, or of all, begins or ends before it", |w| { scene_time::step_edge(w, false); None }, repeats;
    NextEdge => When::Scene, "Go to next begin or end", [], "Moves the playhead to where an action of the selected things, or of all, begins or ends next", |w| { scene_time::step_edge(w, true); None }, repeats;
    ClipToPlayhead => When::Clip, "Move action to playhead", [], "Lets the first selected action begin at the playhead; the others move along", scene_clips::to_playhead;
    ClipEarlier => When::Clip, "Move action a frame earlier", [], "Moves the selected actions one frame back", |w| scene_clips::nudge(w, -1), repeats;
    ClipLater => When::Clip, "Move action a frame later", [], "Moves the selected actions one frame forward", |w| scene_clips::nudge(w, 1), repeats;
    ClipStartToPlayhead => When::Clip, "Trim start to playhead", [], "Lets the selected action start at the playhead, with the rest of it where it is", scene_clips::start_to_playhead;
    ClipEndToPlayhead => When::Clip, "Trim end to playhead", [], "Lets the selected action end at the playhead", scene_clips::end_to_playhead;
    SplitActions => When::Clip, "Split action at playhead", [key(NONE, Key::Y)], "Splits the selected actions at the playhead; both halves together play what the whole played (cut, razor)", scene_split::split;
    PreviousAction => When::Scene, "Select previous action", [], "Selects the action before the selected one in the script", |w| { scene_clips::step(w, false); None };
    NextAction => When::Scene, "Select next action", [], "Selects the action after the selected one in the script", |w| { scene_clips::step(w, true); None };
    SelectAllActions => When::Scene, "Select all actions", [], "Selects every action in the timeline", |w| { scene_clipboard::select_all(w); None };
    CutActions => When::Clip, "Cut actions", [], "Copies the selected actions and deletes them", scene_clipboard::cut;
    CopyActions => When::Clip, "Copy actions", [], "Copies the selected actions; Paste inserts them at the playhead, also for another role", scene_clipboard::copy;
    PasteActions => When::Scene, "Paste actions", [], "Pastes the copied actions at the playhead: for the selected role or prop, or, while an action is selected, for the things they were copied from", |_| Some(Effect::PastePose { mirrored: false });
    SceneDuplicate => When::SceneItem, "Duplicate", [], "Duplicates the selected actions after the last of them ends, or the selected thing or line", scene_clips::duplicate;
    SceneDelete => When::SceneItem, "Delete", [], "Deletes the selected actions, the selected things with the actions that name them, the selected lines, or the point of a path or line that was clicked last; what follows in a sequence moves up", |w| scene_clips::delete(w, false);
    SceneLift => When::Clip, "Delete and leave a gap", [], "Deletes the selected actions; what follows stays where it is", |w| scene_clips::delete(w, true);
    ToggleSceneRipple => When::Always, "Ripple", [], "Lets what follows in a sequence move along with an action that is dragged; hold 2 for the other way", |w| { scene::toggle_ripple(w); None };
    EditSceneModel => When::Thing, "Edit takes and bones", [], "Opens the model of the selected thing, in place: its takes and bones", |w| { let thing = w.scene.things().last().cloned()?; scene::edit_model(w, &thing) };
    BackToScene => When::Always, "Back to scene", [], "Shows the scene again whose model is edited", scene::show_scene;
    LoopFromHere => When::Scene, "Start loop range here", [], "Sets the start of the part of the scene that plays and loops to the playhead", |w| { keys::range_from_here(w); None };
    LoopToHere => When::Scene, "End loop range here", [], "Sets the end of the part of the scene that plays and loops to the playhead", |w| { keys::range_to_here(w); None };
    LoopActions => When::Scene, "Set loop range to selection", [], "Lets the part of the scene play and loop in which the selected actions are, or the part that the timeline shows", |w| { scene_clips::loop_selected(w); None };
    LoopWhole => When::Scene, "Play the whole scene", [], "Clears the loop range", |w| { keys::clear_range(w); None };
    FitScene => When::Scene, "Show the whole scene", [], "Shows all of the scene in its timeline", |w| { scene::fit(w); None };
}
