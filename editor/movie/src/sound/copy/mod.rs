//! Sound files whose packets are copied without encoding them again. A format is one file here and one row of [`COPIED_FORMATS`].

mod aac;
mod flac;
mod mp3;
mod mp4;
mod opus;
mod packets;
mod tag;

use packets::{CopiedFormat, CopiedPackets, Unreadable};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// All formats.
const COPIED_FORMATS: &[CopiedFormat] = &[flac::FLAC, opus::OPUS, mp4::MP4, aac::AAC, mp3::MP3];

/// Finds the packets of a file; an error is a clause with the offset of the byte.
pub(super) fn read(file: Vec<u8>) -> Result<CopiedPackets, String> {
    let start = tag::after_tags(&file);
    let Some(format) = sniffed(file.get(start..).unwrap_or_default()) else {
        let titles: Vec<&str> = COPIED_FORMATS.iter().map(|format| format.title).collect();
        return Err(format!("the file is none of {}", titles.join(", ")));
    };
    // A crate that panics is like one that fails.
    let found = catch_unwind(AssertUnwindSafe(|| (format.read)(file, start)));
    let found = found.unwrap_or_else(|_| Err(Unreadable::new(start, "the reader failed")));
    found.map_err(|error| format!("{}, byte {}: {}", format.title, error.at, error.reason))
}

/// Returns the title of the format of a file, by its first bytes.
pub(super) fn format_of(start: &[u8]) -> Option<&'static str> {
    let after = start.get(tag::after_tags(start)..)?;
    sniffed(after).map(|format| format.title)
}

fn sniffed(start: &[u8]) -> Option<&'static CopiedFormat> {
    COPIED_FORMATS.iter().find(|format| (format.sniff)(start))
}
