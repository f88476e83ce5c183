//! H.264: pictures of a movie in groups that do not refer to each other.
//!
//! Each group is encoded by an encoder of its own. So the bytes of a group depend on its pictures only, and parts that are encoded apart are
//! joined to what one pass writes.

mod encoder;
mod level;
mod sps;

pub(crate) use encoder::{H264Encoder, ParameterSets};
pub(crate) use sps::BT709;
