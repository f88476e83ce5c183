//! MP4: pictures and sound with their tables, in a file that plays while it is being loaded; and parts of one joined.

mod label;
mod moov;
mod part;
mod writer;

pub(crate) mod join;

pub(crate) use label::MovieLabel;
#[cfg(feature = "h264")]
pub(crate) use label::plain_box;
pub(crate) use writer::Mp4File;
#[cfg(feature = "h264")]
pub(crate) use writer::unencoded;
