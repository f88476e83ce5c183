//! MP4: pictures and sound with their tables, in a file that plays while it is being loaded; and parts of one joined.

mod growing_sound;
mod label;
mod moov;
mod part;
mod track;
mod writer;

pub(crate) mod inspect;
pub(crate) mod join;

// The format that writes pictures exists only with an encoder; joining needs none.
#[cfg(feature = "h264")]
pub(crate) use {
    label::{MovieLabel, plain_box},
    writer::{Mp4File, unencoded},
};
