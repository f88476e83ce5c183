//! Applies requests and commands to the workspace. Anything that reaches beyond the panels is returned as an effect.
//!
//! [`execute::execute`] is the only function that dispatches requests; a command of the table calls the function that its
//! row names.

mod added_files;
pub(super) mod baking;
pub(super) mod bones;
pub(super) mod clipboard;
pub(super) mod compare;
pub(super) mod contacts;
pub(super) mod drags;
pub(super) mod dropped;
pub(super) mod events;
pub(super) mod execute;
pub(super) mod feed;
pub(super) mod files;
pub(super) mod framing;
mod free_places;
pub(super) mod ik;
pub(super) mod inbetween;
pub(super) mod input;
pub(super) mod keys;
pub(super) mod layers;
mod left_scene;
mod line_edit;
pub(super) mod locks;
pub(super) mod look;
pub(super) mod motion_stroke;
pub(super) mod playback;
pub(super) mod pose;
pub(super) mod pose_library;
pub(super) mod pose_line;
mod reopened;
pub(super) mod scene;
mod scene_around;
pub(super) mod scene_attach;
pub(super) mod scene_camera;
pub(super) mod scene_clipboard;
pub(super) mod scene_clips;
mod scene_dependents;
pub(super) mod scene_files;
pub(super) mod scene_focus;
mod scene_gizmo;
pub(super) mod scene_ground;
pub(super) mod scene_lines;
mod scene_moves;
mod scene_path_points;
mod scene_picks;
pub(super) mod scene_points;
mod scene_probe;
pub(super) mod scene_split;
pub(super) mod scene_text;
pub(super) mod scene_time;
pub(super) mod scene_view;
pub(super) mod scope;
mod second_view;
pub(super) mod sets;
pub(super) mod show;
pub(super) mod takes;
pub(super) mod tools;
pub(super) mod undo;

use super::request::Effect;
use dragonfly_document::Change;
use dragonfly_document::edit::Edit;

/// Returns the effect of an edit that is a step of its own.
fn edit(edit: Edit) -> Effect {
    Effect::Change(Change::Edit(edit, None))
}
