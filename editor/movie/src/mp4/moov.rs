//! The tables of an MP4: `ftyp` and `moov`.

use super::label::{MovieLabel, plain_box};
use super::track::{TrackKind, TrackTable};
use shiguredo_mp4::boxes::{
    Brand, Co64Box, DinfBox, EdtsBox, ElstBox, ElstEntry, FtypBox, HdlrBox, MdhdBox, MdiaBox, MediaHeader,
    MinfBox, MoovBox, MvhdBox, SmhdBox, StblBox, StcoBox, StscBox, StscEntry, StsdBox, StssBox, StszBox,
    SttsBox, SttsEntry, TkhdBox, TrakBox, UnknownBox, VmhdBox,
};
use shiguredo_mp4::{Either, Encode, Error, FixedPointNumber, LanguageCode, Mp4FileTime};
use std::num::NonZeroU32;

/// Returns the box at the start of a file.
pub(super) fn file_type() -> Result<Vec<u8>, Error> {
    let compatible_brands = vec![Brand::ISOM, Brand::ISO2, Brand::AVC1, Brand::MP41];
    FtypBox { major_brand: Brand::ISOM, minor_version: 512, compatible_brands }.encode_to_vec()
}

/// The tables of a whole movie.
pub(super) struct MovieTables<'a> {
    pub(super) label: &'a MovieLabel,
    pub(super) tracks: Vec<&'a TrackTable>,
    /// Offset of the samples in the file before these tables are inserted.
    pub(super) start: u64,
    /// Number of bytes of all samples.
    pub(super) length: u64,
}

impl MovieTables<'_> {
    /// Returns the box, which is to be inserted before the samples.
    pub(super) fn encode(&self) -> Result<Vec<u8>, Error> {
        let far = self.start + self.length > u64::from(u32::MAX / 2);
        // The size does not depend on the offsets.
        let size = self.boxes(self.start, far)?.encode_to_vec()?.len() as u64;
        self.boxes(self.start + size, far)?.encode_to_vec()
    }

    fn boxes(&self, start: u64, far: bool) -> Result<MoovBox, Error> {
        let timescale = self.tracks.first().map_or(NonZeroU32::MIN, |track| track.timescale);
        let durations = self.tracks.iter().map(|track| track.played_in(timescale));
        let mvhd_box = MvhdBox {
            creation_time: Mp4FileTime::default(),
            modification_time: Mp4FileTime::default(),
            timescale,
            duration: durations.max().unwrap_or_default(),
            rate: MvhdBox::DEFAULT_RATE,
            volume: MvhdBox::DEFAULT_VOLUME,
            matrix: MvhdBox::DEFAULT_MATRIX,
            next_track_id: self.tracks.len() as u32 + 1,
        };
        let tracks = self.tracks.iter().enumerate();
        let trak_boxes =
            tracks.map(|(at, track)| track_box(track, at as u32 + 1, timescale, start, far)).collect();
        Ok(MoovBox { mvhd_box, trak_boxes, mvex_box: None, unknown_boxes: vec![self.label.to_box()?] })
    }
}

fn track_box(track: &TrackTable, id: u32, timescale: NonZeroU32, start: u64, far: bool) -> TrakBox {
    let side = |side: u16| FixedPointNumber::new(side as i16, 0);
    let (size, volume, handler_type, name, media_header) = match &track.kind {
        TrackKind::Pictures { size, .. } => {
            let (graphicsmode, opcolor) = (VmhdBox::DEFAULT_GRAPHICSMODE, VmhdBox::DEFAULT_OPCOLOR);
            let header = MediaHeader::Vmhd(VmhdBox { graphicsmode, opcolor });
            (*size, TkhdBox::DEFAULT_VIDEO_VOLUME, HdlrBox::HANDLER_TYPE_VIDE, &b"pictures\0"[..], header)
        }
        TrackKind::Sound { .. } => {
            let header = MediaHeader::Smhd(SmhdBox { balance: SmhdBox::DEFAULT_BALANCE });
            ([0; 2], TkhdBox::DEFAULT_AUDIO_VOLUME, HdlrBox::HANDLER_TYPE_SOUN, &b"sound\0"[..], header)
        }
    };
    let tkhd_box = TkhdBox {
        flag_track_enabled: true,
        flag_track_in_movie: true,
        flag_track_in_preview: false,
        flag_track_size_is_aspect_ratio: false,
        creation_time: Mp4FileTime::default(),
        modification_time: Mp4FileTime::default(),
        track_id: id,
        duration: track.played_in(timescale),
        layer: TkhdBox::DEFAULT_LAYER,
        alternate_group: TkhdBox::DEFAULT_ALTERNATE_GROUP,
        volume,
        matrix: TkhdBox::DEFAULT_MATRIX,
        width: side(size[0]),
        height: side(size[1]),
    };
    let mdhd_box = MdhdBox {
        creation_time: Mp4FileTime::default(),
        modification_time: Mp4FileTime::default(),
        timescale: track.timescale,
        duration: track.duration(),
        language: LanguageCode::UNDEFINED,
    };
    let minf_box = MinfBox {
        media_header: Some(media_header),
        dinf_box: DinfBox::LOCAL_FILE,
        stbl_box: sample_tables(track, start, far),
        unknown_boxes: Vec::new(),
    };
    let hdlr_box = HdlrBox { handler_type, name: name.to_vec() };
    let mdia_box = MdiaBox { mdhd_box, hdlr_box, minf_box, unknown_boxes: Vec::new() };
    TrakBox { tkhd_box, edts_box: edit_box(track, timescale), mdia_box, unknown_boxes: Vec::new() }
}

/// Returns the box with the part of a track that is played, where it is not all of it.
fn edit_box(track: &TrackTable, timescale: NonZeroU32) -> Option<EdtsBox> {
    let edit = track.edit?;
    let entry = ElstEntry {
        edit_duration: track.played_in(timescale),
        media_time: edit.skip as i64,
        media_rate: FixedPointNumber::new(1, 0),
    };
    let elst_box = Some(ElstBox { entries: vec![entry] });
    Some(EdtsBox { elst_box, unknown_boxes: Vec::new() })
}

/// Returns the boxes with the number of packets that a decoder needs before the one from which it plays.
fn roll_boxes(packets: u16, samples: u32) -> Vec<UnknownBox> {
    if packets == 0 {
        return Vec::new();
    }
    // Version 1, one description of two bytes.
    let mut description = vec![1, 0, 0, 0];
    description.extend(b"roll\0\0\0\x02\0\0\0\x01");
    description.extend(0_u16.wrapping_sub(packets).to_be_bytes());
    // Version 0, one run with that description.
    let mut samples_of = vec![0, 0, 0, 0];
    samples_of.extend(b"roll\0\0\0\x01");
    samples_of.extend(samples.to_be_bytes());
    samples_of.extend(1_u32.to_be_bytes());
    vec![plain_box(*b"sgpd", description), plain_box(*b"sbgp", samples_of)]
}

fn sample_tables(track: &TrackTable, start: u64, far: bool) -> StblBox {
    let mut runs: Vec<StscEntry> = Vec::new();
    for (at, chunk) in (1..).zip(&track.chunks) {
        if runs.last().is_none_or(|run| run.sample_per_chunk != chunk.samples) {
            runs.push(StscEntry {
                first_chunk: NonZeroU32::MIN.saturating_add(at - 1),
                sample_per_chunk: chunk.samples,
                sample_description_index: NonZeroU32::MIN,
            });
        }
    }
    let offsets = track.chunks.iter().map(|chunk| start + chunk.offset);
    let stco_or_co64_box = if far {
        Either::B(Co64Box { chunk_offsets: offsets.collect() })
    } else {
        Either::A(StcoBox { chunk_offsets: offsets.map(|offset| offset as u32).collect() })
    };
    let durations = track.durations.iter();
    let durations = durations.map(|&(sample_count, sample_delta)| SttsEntry { sample_count, sample_delta });
    let (stss_box, unknown_boxes) = match &track.kind {
        TrackKind::Pictures { whole, .. } => (Some(StssBox { sample_numbers: whole.clone() }), Vec::new()),
        TrackKind::Sound { roll } => (None, roll_boxes(*roll, track.sizes.len() as u32)),
    };
    StblBox {
        stsd_box: StsdBox { entries: vec![track.entry.clone()] },
        stts_box: SttsBox { entries: durations.collect() },
        ctts_box: None,
        cslg_box: None,
        stsc_box: StscBox { entries: runs },
        stsz_box: StszBox::Variable { entry_sizes: track.sizes.clone() },
        stco_or_co64_box,
        stss_box,
        sdtp_box: None,
        unknown_boxes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mp4::track::PlayedPart;
    use shiguredo_mp4::Decode;
    use shiguredo_mp4::aux::SampleTableAccessor;
    use shiguredo_mp4::boxes::SampleEntry;

    #[test]
    fn the_tables_of_many_hours_and_gigabytes_are_read_back() {
        let number = |number| NonZeroU32::new(number).unwrap();
        let entry = || SampleEntry::Unknown(plain_box(*b"test", vec![0; 8]));
        let kind = TrackKind::Pictures { size: [640, 360], whole: vec![number(1)] };
        let mut pictures = TrackTable::new(kind, entry(), number(24_000));
        let mut sound = TrackTable::new(TrackKind::Sound { roll: 4 }, entry(), number(48_000));
        // 60 hours in 30 chunks of four pictures and a packet, each of almost a gigabyte.
        let (each, side) = (500_000_000_u32, 1_000_000_000_u64);
        for chunk in 0..30_u64 {
            for at in 0..4 {
                pictures.add(5 * side * chunk, each, 43_200_000, at == 0);
            }
            sound.add(5 * side * chunk + 4 * side, each, 345_600_000, true);
        }
        sound.edit = Some(PlayedPart { skip: 312, played: 48_000 * 3600 * 59 });
        let label = MovieLabel { first: 0, group: 48, coarseness: 24, tag: String::new() };
        let (start, length) = (48, 150 * side);
        let tables = MovieTables { label: &label, tracks: vec![&pictures, &sound], start, length };
        let bytes = tables.encode().unwrap();
        let (read, size) = MoovBox::decode(&bytes).unwrap();
        assert_eq!(size, bytes.len());
        assert_eq!(read.mvhd_box.duration, 24_000 * 3600 * 60);
        let [one, two]: [TrakBox; 2] = read.trak_boxes.try_into().unwrap();
        assert_eq!(one.mdia_box.mdhd_box.duration, 24_000 * 3600 * 60);
        assert_eq!(two.mdia_box.mdhd_box.duration, 48_000 * 3600 * 60);
        assert_eq!((one.edts_box.is_none(), two.tkhd_box.duration), (true, 24_000 * 3600 * 59));
        let edit = &two.edts_box.as_ref().unwrap().elst_box.as_ref().unwrap().entries[0];
        assert_eq!((edit.edit_duration, edit.media_time), (24_000 * 3600 * 59, 312));
        let others = &two.mdia_box.minf_box.stbl_box.unknown_boxes;
        let kinds: Vec<_> = others.iter().map(|found| found.box_type).collect();
        assert_eq!(format!("{kinds:?}"), "[BoxType(\"sgpd\"), BoxType(\"sbgp\")]");
        for (track, places) in [(one, [0, 3, 119]), (two, [0, 1, 29])] {
            let table = SampleTableAccessor::new(track.mdia_box.minf_box.stbl_box).unwrap();
            let offsets = places.map(|at: u32| table.get_sample(number(at + 1)).unwrap().data_offset());
            let inserted = start + bytes.len() as u64;
            let wanted = match table.sample_count() {
                120 => [0, 3 * u64::from(each), 145 * side + 3 * u64::from(each)],
                _ => [4 * side, 9 * side, 149 * side],
            };
            assert_eq!(offsets, wanted.map(|offset| inserted + offset));
        }
    }
}
