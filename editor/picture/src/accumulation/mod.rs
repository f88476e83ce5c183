//! Frames of movies as the mean of several sub-frames: smooth edges, motion blur, depth of field and soft shadows by one technique.
//!
//! Each sub-frame differs in the position within the pixel, the point of the lens, the time within that of the open shutter, the point of
//! each light and the threshold of masks. They are added as light, before the tone map, and developed once (Haeberli and Akeley, "The
//! Accumulation Buffer", SIGGRAPH 1990). A frame needs nothing of the frames before it, so frames can be drawn in any order and anywhere.
//!
//! ```text
//! FrameSampling (settings) + time → SampledFrame → SubFrame: where a sub-frame differs
//! Scene::prepare applies it to camera, lens and uniform · every pass of the scene draws · FrameSum adds and develops
//! ```

mod drawing;
mod optics;
mod pixel_filter;
mod settings;
mod sub_frame;
mod sum;

pub(crate) use optics::{LensShift, moved_image};
pub use pixel_filter::{FILTER_RADIUS, blackman_harris};
pub use settings::{FrameSampling, MOST_SAMPLES, SampledFrame};
pub use sub_frame::SubFrame;
pub(crate) use sum::FrameSum;
