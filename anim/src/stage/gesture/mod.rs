//! Gestures in a timeline or a viewport, as new texts of a script.
//!
//! ```text
//! a drag of a bar → function of this module → the new text, or the reason why it is refused
//! ```
//!
//! Each function changes as few attributes as it can; comments, layout and spelling of the rest stay ([`splice`](super::splice)). The new text
//! is always a script that can be read and whose times do not depend on themselves. Several things at once are changed by
//! the functions that return splices, whose results [`spliced_script`] applies and checks together. It changes the texts of things of a project,
//! too; gestures that return one text refuse those, because they are in another text.
//!
//! If a gesture makes a clip overlap the one before it in its lane, the `fade-in` of the later one is as long as the overlap, as in other
//! timelines; it follows the overlap unless it was given another length. A clip that comes inside of another one has no such length: it gets a `fade-in`
//! and a `fade-out` of a quarter of a second, at most half of itself, so that the other one continues after it. Without a `fade-out` it would hold
//! its last pose instead, by the rules of time.
//!
//! | gesture | what it changes |
//! |---|---|
//! | [`move_clip`] | `begin`; in a `seq` the order, where the middle of the clip passes that of a neighbor |
//! | [`trim_start`] | `begin`, and `from` of a take (`to` of one that plays backwards), so that the rest stays where it is |
//! | [`trim_end`] | `to` of a take, `repeat` beyond its end, otherwise `dur` or `end` |
//! | [`set_fade`], [`set_speed`], [`stretch_to`], [`set_repeat`] | the attribute; removed where it is the default |
//! | [`delete_clip`], [`duplicate_clip`] | one element |
//! | [`move_clips`], [`delete_clips`] | the same for several actions |
//! | [`split_clips`] | for each action a second element, and the part of the take or the `dur` |
//! | [`delete_things`] | the elements of things and of the actions that name them |
//! | [`move_to_lane`] | `who` and `begin`, and the place in the text |
//! | [`copied_clips`], [`paste_clips`] | new elements, one for each that was copied |
//! | [`cut_to`], [`add_clip`], [`follow_path`], [`attach_thing`], [`detach_splices`], [`key_place_splices`] | one new element |
//! | [`add_new_action`], [`wait_after`] | one new element, by the table of such actions |
//! | [`grip_splices`] | `offset` and `turn` of an `attach` |
//! | [`move_path_point`], [`path_points_splices`] | numbers of `points` |
//! | [`place_thing`], [`face_thing`] | `at` or `facing` of the cast, or of the last `place` |
//!
//! Times between actions are kept where the script has them: in a `seq`, what follows moves along unless [`Followers::Stay`] is asked for,
//! and a `begin` that refers to another action keeps that reference. A change after which an action that refers to the one before it as
//! `prev` would have another one before it is refused, and so is one of what belongs to an included file: it is in another text.

mod along;
mod angles;
mod attributes;
mod begin;
mod cast;
mod copying;
mod draft;
mod halves;
mod holding;
mod insert;
mod mixes;
mod moving;
mod new_action;
mod other_lane;
mod path_points;
mod place_keys;
mod places;
mod removal;
mod scene;
mod several;
mod split;
mod split_check;
mod thing_removal;
mod trim;

pub use along::{MovedPart, moved_along};
pub use angles::{facing_and_tilt, turn_about_axes};
pub use attributes::{FadeEnd, set_fade, set_repeat, set_speed, stretch_to};
pub use cast::{delete_thing, duplicate_thing, rename_thing, set_on_thing, spliced_script};
pub use copying::{copied_clips, duplicate_clips, is_copied_clips, paste_clips, things_of_pasted};
pub use draft::spliced_text;
pub use holding::{HeldGrip, attach_splices, attach_thing, detach_splices, grip_splices};
pub use insert::{add_clip, cut_to, follow_path};
pub use moving::{SequenceMove, SequenceOrder, move_clip, sequence_move, sequence_place};
pub use new_action::{add_new_action, wait_after};
pub use other_lane::{MovedToLane, move_clips_to_lane, move_to_lane};
pub use path_points::{
    add_path_point_splices, move_path_point, path_point_splices, path_points_splices,
    remove_path_point_splices, written_points,
};
pub use place_keys::key_place_splices;
pub use places::{face_splices, face_thing, place_splices, place_thing};
pub use removal::{delete_clip, duplicate_clip};
pub use scene::{Followers, GestureRefusal, GestureScene, in_scene_texts, in_this_text};
pub use several::{delete_clips, move_clips};
pub use split::{SplitClips, split_clips};
pub use thing_removal::delete_things;
pub use trim::{trim_end, trim_start};
