//! The sound of an MP4: AAC, FLAC, Opus or MP3.

use super::mp3::{MPEG1, MPEG2};
use super::packets::{CopiedFormat, CopiedHead, CopiedPackets, FoundPackets, Unreadable};
use super::{aac, opus};
use shiguredo_mp4::aux::SampleTableAccessor;
use shiguredo_mp4::boxes::{EdtsBox, HdlrBox, MoovBox, SampleEntry, TrakBox};
use shiguredo_mp4::descriptors::DecoderConfigDescriptor;
use shiguredo_mp4::{BaseBox, BoxHeader, Decode};
use std::num::NonZeroU32;
use std::ops::Range;

pub(super) const MP4: CopiedFormat = CopiedFormat {
    title: "sound in MP4",
    sniff: |start| start.get(4..8).is_some_and(|kind| KINDS.contains(&kind)),
    read,
};

/// Boxes at the start of a file.
const KINDS: [&[u8]; 3] = [b"ftyp", b"moov", b"mdat"];
/// Kinds of objects that are AAC: that of MPEG-4, and three of MPEG-2.
const AAC: [u8; 4] =
    [DecoderConfigDescriptor::OBJECT_TYPE_INDICATION_AUDIO_ISO_IEC_14496_3, 0x66, 0x67, 0x68];

fn read(file: Vec<u8>, start: usize) -> Result<CopiedPackets, Unreadable> {
    let place = tables_place(&file, start)?;
    let wrong = |reason: String| Unreadable::new(place.start, reason);
    let damaged = |error: shiguredo_mp4::Error| wrong(format!("its tables are damaged: {}", error.reason));
    let (tables, _) = MoovBox::decode(&file[place.clone()]).map_err(damaged)?;
    if tables.mvex_box.is_some() {
        return Err(wrong("its sound is in fragments, which cannot be copied".to_owned()));
    }
    let seconds = tables.mvhd_box.timescale;
    let is_sound = |track: &TrakBox| track.mdia_box.hdlr_box.handler_type == HdlrBox::HANDLER_TYPE_SOUN;
    let track =
        tables.trak_boxes.into_iter().find(is_sound).ok_or_else(|| wrong("it has no sound".to_owned()))?;
    let timescale = track.mdia_box.mdhd_box.timescale;
    let edit = edit(track.edts_box.as_ref(), seconds, timescale).map_err(&wrong)?;
    let table = track.mdia_box.minf_box.stbl_box;
    let [entry] = table.stsd_box.entries.as_slice() else {
        return Err(wrong("its sound has more than one description".to_owned()));
    };
    let entry = entry.clone();
    let table = SampleTableAccessor::new(table);
    let table = table.map_err(|error| wrong(format!("its tables are damaged: {error}")))?;
    let mut found = FoundPackets::default();
    for sample in table.samples() {
        let size = sample.data_size() as usize;
        let offset = usize::try_from(sample.data_offset()).unwrap_or(usize::MAX);
        if size == 0 || offset.checked_add(size).is_none_or(|end| end > file.len()) {
            let reason = format!("packet {} is empty, or outside of the file", sample.index());
            return Err(Unreadable::new(offset.min(file.len()), reason));
        }
        found.add(offset, size, sample.duration())?;
    }
    if found.bytes() > file.len() as u64 {
        return Err(wrong("its packets overlap".to_owned()));
    }
    let roll = roll(&entry, found.longest()).map_err(&wrong)?;
    let (skip, played) = edit.unwrap_or((0, None));
    found.end(file, CopiedHead { entry, timescale, skip, played, roll })
}

/// Returns the place of the box with the tables.
fn tables_place(file: &[u8], start: usize) -> Result<Range<usize>, Unreadable> {
    let mut at = start;
    while let Some(rest) = file.get(at..).filter(|rest| !rest.is_empty()) {
        let (header, _) = BoxHeader::decode(rest).map_err(|error| Unreadable::new(at, error.reason))?;
        let size = match usize::try_from(header.box_size.get()).unwrap_or(usize::MAX) {
            // Up to the end of the file.
            0 => rest.len(),
            size => size,
        };
        if size > rest.len() {
            return Err(Unreadable::new(at, "the file ends in a box"));
        }
        if header.box_type == MoovBox::TYPE {
            return Ok(at..at + size);
        }
        at += size;
    }
    Err(Unreadable::new(at, "it has no tables"))
}

/// Returns the ticks of a track that are not played, and those after them that are; `None` for a track that is played as it is. An error is a
/// clause.
fn edit(
    edits: Option<&EdtsBox>,
    seconds: NonZeroU32,
    timescale: NonZeroU32,
) -> Result<Option<(u64, Option<u64>)>, String> {
    let Some(list) = edits.and_then(|edits| edits.elst_box.as_ref()) else { return Ok(None) };
    let entry = match list.entries.as_slice() {
        [] => return Ok(None),
        [entry] => entry,
        _ => return Err("its sound is put together of several parts, which cannot be copied".to_owned()),
    };
    let skip = u64::try_from(entry.media_time).map_err(|_| "its sound is a pause")?;
    // Nothing is the rest of the track.
    let ticks = u128::from(entry.edit_duration) * u128::from(timescale.get()) / u128::from(seconds.get());
    Ok(Some((skip, u64::try_from(ticks).ok().filter(|ticks| *ticks > 0))))
}

/// Returns the number of packets that a decoder needs before the one from which it plays; an error, a clause, for sound that is not copied.
fn roll(entry: &SampleEntry, longest: u32) -> Result<u16, String> {
    let other = || format!("its sound is {}, which is not copied", entry.box_type());
    match entry {
        SampleEntry::Mp4a(sound) => {
            let kind = sound.esds_box.es.dec_config_descr.object_type_indication;
            match kind {
                MPEG1 | MPEG2 => Ok(0),
                kind if AAC.contains(&kind) => Ok(aac::ROLL),
                _ => Err(other()),
            }
        }
        SampleEntry::Opus(_) => Ok(opus::roll(longest)),
        SampleEntry::Flac(_) => Ok(0),
        _ => Err(other()),
    }
}
