//! Movies of scenes and takes: which frames they have, how each is rendered, and the file that they become.
//!
//! ```text
//! MovieFrames ──▶ FrameSource (StudioFrames: the studio of the picture crate) ── a ring of frames ──▶ Movie, in a job of the runtime
//! ```
//!
//! [`render_movie`] renders and encodes at the same time, reports each frame, and ends between two frames when it is cancelled. An MP4 is rendered in
//! parts next to its file, which are joined at the end, so that a movie that was interrupted is resumed. This module knows no command and no panel.

mod error;
mod frame_pipe;
mod frame_subject;
mod frames;
mod identity;
mod movie_run;
mod order;
mod parts;
mod progress;
mod render;
mod sequence;
mod sound;
mod source;
mod studio_frames;
mod take_camera;

pub use error::MovieRenderError;
pub use frame_subject::FrameSubject;
pub use frames::MovieFrames;
pub use identity::movie_tag;
pub use order::{MovieOrder, RenderedMovie};
pub use parts::{has_parts, parts_folder};
pub use progress::{MovieNews, MovieProgress};
pub use render::render_movie;
pub use sound::{SOUND_CHANNELS, SOUND_RATE, scene_samples, scene_sound};
pub use source::{FrameSource, RenderedFrame};
pub use studio_frames::StudioFrames;
pub use take_camera::take_camera;
