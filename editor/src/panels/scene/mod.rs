//! Scenes: the list of things, the timeline of their actions, the script.
//!
//! ```text
//! panel ── gesture of `anim::stage::gesture` on the script as it was ── new text ──► SceneRequest::Text ──► one edit of the document
//!   ▲                                                                                                          │
//!   └───────────────────────────── View::scene: text, script, plan, errors ◄───────────────────────────────────┘
//! ```
//!
//! The panels contain nothing of the scene: they draw the last script that worked, and a text of their own only while someone types.

mod action_menu;
mod action_selection;
mod attribute_numbers;
pub mod attributes;
mod base;
mod changed_things;
mod editing;
mod effect_note;
mod entered;
mod follow;
mod gesture_request;
mod hide_and_lock;
mod last_split;
mod left_scene;
mod line_color;
mod line_editing;
mod line_eraser;
mod line_look;
mod new_thing;
mod newest_text;
mod no_place;
pub mod outliner;
mod path_handles;
mod probe;
mod renamed_things;
mod renaming;
mod request;
pub mod script;
mod shot_list;
pub mod shots;
mod sounds;
mod standing_boxes;
mod template;
mod thing_icon;
mod thing_poses;
mod thing_selection;
mod thumbnails;
pub mod timeline;
mod viewport;

pub(in crate::panels) use action_menu::submenu_of as add_action_menu;
pub use base::SceneBase;
pub use changed_things::ChangedThings;
pub use editing::SceneEditing;
pub(in crate::panels) use effect_note::{NOT_DRAWN, effect_on, is_of_effect};
pub use entered::{EnteredClip, EnteredThing};
pub use follow::follow_actions;
pub(in crate::panels) use gesture_request::move_label;
pub(in crate::panels) use hide_and_lock::SceneMarks;
pub(in crate::panels) use last_split::SplitActions;
pub use left_scene::LeftScene;
pub(in crate::panels) use line_color::{LINE_COLORS, LineColor, color_text};
pub use line_editing::{LineEditing, line_name, line_named};
pub use line_eraser::LineEraser;
pub(in crate::panels) use line_eraser::nearest_on_piece;
pub use new_thing::{
    NewModel, NewThing, begin_text, new_thing_splices, role_place, with_new_sound, with_new_thing, with_run,
};
pub use no_place::{no_drop_text, no_place_text};
pub(in crate::panels) use outliner::{active_request, thing_menu};
pub(in crate::panels) use path_handles::directed_point;
pub use probe::SceneProbe;
pub use renamed_things::RenamedThings;
pub use request::{DraggedTake, LineRequest, SceneRequest, ScriptChange};
pub use sounds::{SceneSound, SceneSounds};
pub use standing_boxes::StandingBoxes;
pub(in crate::panels) use template::NO_LINES;
pub use template::{ListedModel, duel_text, free_name, project_texts};
pub use thing_poses::ThingPoses;
pub use thumbnails::{SceneThumbnails, ShotKey};
pub use viewport::SceneViewport;
