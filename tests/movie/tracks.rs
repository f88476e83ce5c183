//! The tracks of an MP4, as the crate that reads boxes finds them.

use shiguredo_mp4::aux::SampleTableAccessor;
use shiguredo_mp4::boxes::{MoovBox, SampleEntry};
use shiguredo_mp4::{BoxHeader, Decode};
use std::path::Path;

/// A track of an MP4.
pub(crate) struct ReadTrack {
    pub(crate) entry: SampleEntry,
    pub(crate) timescale: u32,
    /// The bytes of each sample, and its duration.
    pub(crate) samples: Vec<(Vec<u8>, u32)>,
    /// Duration of the part that is played, in ticks of the movie, and the tick at which it begins.
    pub(crate) edit: Option<(u64, i64)>,
    /// Ticks of the movie in a second, and its duration in them.
    pub(crate) movie: (u32, u64),
    /// Names of boxes of the table that the crate does not know.
    pub(crate) others: Vec<[u8; 4]>,
}

impl ReadTrack {
    /// Returns the duration of all samples.
    pub(crate) fn ticks(&self) -> u64 {
        self.samples.iter().map(|(_, duration)| u64::from(*duration)).sum()
    }
}

/// Returns the tracks of an MP4 that is a file.
pub(crate) fn tracks(path: &Path) -> Vec<ReadTrack> {
    let bytes = std::fs::read(path).unwrap();
    let mut at = 0;
    loop {
        let (header, _) = BoxHeader::decode(&bytes[at..]).unwrap();
        let size = header.box_size.get() as usize;
        if header.box_type == MoovBox::TYPE {
            let tables = MoovBox::decode(&bytes[at..at + size]).unwrap().0;
            let movie = (tables.mvhd_box.timescale.get(), tables.mvhd_box.duration);
            return tables.trak_boxes.into_iter().map(|track| read(&bytes, track, movie)).collect();
        }
        at += size;
    }
}

fn read(bytes: &[u8], track: shiguredo_mp4::boxes::TrakBox, movie: (u32, u64)) -> ReadTrack {
    let edits = track.edts_box.and_then(|edits| edits.elst_box);
    let edit = edits.map(|list| (list.entries[0].edit_duration, list.entries[0].media_time));
    let table = track.mdia_box.minf_box.stbl_box;
    let entry = table.stsd_box.entries[0].clone();
    let others = table.unknown_boxes.iter().map(|found| *found.box_type.as_bytes().first_chunk().unwrap());
    let others = others.collect();
    let table = SampleTableAccessor::new(table).unwrap();
    let sample = |offset: u64, size: u32| bytes[offset as usize..][..size as usize].to_vec();
    let samples = table.samples();
    let samples = samples.map(|found| (sample(found.data_offset(), found.data_size()), found.duration()));
    let samples = samples.collect();
    ReadTrack { entry, timescale: track.mdia_box.mdhd_box.timescale.get(), samples, edit, movie, others }
}

/// Returns the sound of an MP4.
pub(crate) fn sound(path: &Path) -> ReadTrack {
    tracks(path).into_iter().nth(1).expect("a movie with sound")
}
