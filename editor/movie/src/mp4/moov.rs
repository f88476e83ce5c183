//! The tables of an MP4: `ftyp` and `moov`.

use super::label::MovieLabel;
use super::writer::{TrackKind, TrackTable};
use shiguredo_mp4::boxes::{
    Brand, Co64Box, DinfBox, FtypBox, HdlrBox, MdhdBox, MdiaBox, MediaHeader, MinfBox, MoovBox, MvhdBox,
    SmhdBox, StblBox, StcoBox, StscBox, StscEntry, StsdBox, StssBox, StszBox, SttsBox, SttsEntry, TkhdBox,
    TrakBox, VmhdBox,
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
        let durations = self.tracks.iter().map(|track| track.duration_in(timescale));
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
        TrackKind::Sound => {
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
        duration: track.duration_in(timescale),
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
    TrakBox { tkhd_box, edts_box: None, mdia_box, unknown_boxes: Vec::new() }
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
    let stss_box = match &track.kind {
        TrackKind::Pictures { whole, .. } => Some(StssBox { sample_numbers: whole.clone() }),
        TrackKind::Sound => None,
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
        unknown_boxes: Vec::new(),
    }
}
