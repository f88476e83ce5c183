//! Gestures in a timeline or a viewport, as new texts of a script.
//!
//! ```text
//! a drag of a bar → function of this module → the new text, or the reason why it is refused
//! ```
//!
//! Each function changes as few attributes as it can; comments, layout and spelling of the rest stay ([`splice`](super::splice)). The new text
//! is always a script that can be read and whose times do not depend on themselves. Several things at once are changed by
//! [`place_splices`] and [`face_splices`], whose results [`spliced_script`] applies and checks together. It changes the texts of things of a project,
//! too; gestures that return one text refuse those, because they are in another text.
//!
//! | gesture | what it changes |
//! |---|---|
//! | [`move_clip`] | `begin`; in a `seq` the order, where the middle of the clip passes that of a neighbor |
//! | [`trim_start`] | `begin`, and `from` of a take (`to` of one that plays backwards), so that the rest stays where it is |
//! | [`trim_end`] | `to` of a take, `repeat` beyond its end, otherwise `dur` or `end` |
//! | [`set_fade`], [`set_speed`], [`set_repeat`] | the attribute; removed where it is the default |
//! | [`delete_clip`], [`duplicate_clip`] | one element |
//! | [`cut_to`], [`add_clip`], [`follow_path`], [`attach_thing`] | one new element |
//! | [`move_path_point`] | three numbers of `points` |
//! | [`place_thing`], [`face_thing`] | `at` or `facing` of the cast, or of the last `place` |
//!
//! Times between actions are kept where the script has them: in a `seq`, what follows moves along unless [`Followers::Stay`] is asked for,
//! and a `begin` that refers to another action keeps that reference. A change after which an action that refers to the one before it as
//! `prev` would have another one before it is refused.

mod attributes;
mod begin;
mod cast;
mod draft;
mod insert;
mod moving;
mod path_points;
mod places;
mod removal;
mod scene;
mod trim;

pub use attributes::{FadeEnd, set_fade, set_repeat, set_speed};
pub use cast::{delete_thing, duplicate_thing, rename_thing, set_on_thing, spliced_script};
pub use draft::spliced_text;
pub use insert::{add_clip, attach_thing, cut_to, follow_path};
pub use moving::{SequenceOrder, move_clip};
pub use path_points::{move_path_point, path_point_splices, written_points};
pub use places::{face_splices, face_thing, place_splices, place_thing};
pub use removal::{delete_clip, duplicate_clip};
pub use scene::{Followers, GestureRefusal, GestureScene};
pub use trim::{trim_end, trim_start};
