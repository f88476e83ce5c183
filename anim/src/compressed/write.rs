//! Writes the stored take as bytes; the layout is documented in [`super`].

use super::bits::BitWriter;
use super::encode::TURN_UNIT;
use super::extents::{AHEAD, ByteSizes, PREFACE, SUMMED};
use super::frames::limit;
use super::grid::{FLOATS, WHOLE_BITS, rotation_numbers};
use super::lane_groups::{TrackSlot, groups, slots};
use super::stored::{PARTS, PackedChannel, StoredChannel, StoredTake};
use super::{CompressError, MAGIC, MAX_BYTES, VERSION};
use crate::checksum::CRC_32;
use glam::Quat;

/// Returns the bytes of `stored`, and their sizes by content.
pub(super) fn write(stored: &StoredTake) -> Result<(Vec<u8>, ByteSizes), CompressError> {
    let tracks = packed(stored);
    let mut spent = ByteSizes::default();
    let mut bytes = vec![0; PREFACE];
    whole(stored, &mut bytes);
    spent.whole = bytes.len() - PREFACE;
    let keys = keys(&tracks);
    spent.keys = keys.len();
    bytes.extend(keys);
    limit("bytes", bytes.len() as u64, MAX_BYTES as u64)?;
    let end_of_keys = bytes.len() as u32;
    bytes[SUMMED..PREFACE].copy_from_slice(&end_of_keys.to_le_bytes());
    let mut bits = BitWriter::default();
    let mut mark = 0;
    let mut since = |length: usize| length - std::mem::replace(&mut mark, length);
    header(stored, &mut bits);
    spent.header = PREFACE + since(bits.length());
    kinds_and_constants(stored, &mut bits);
    spent.constants = since(bits.length());
    ranges(&tracks, &mut bits);
    heads(&tracks, &mut bits);
    spent.ranges = since(bits.length());
    let mut description = bits.into_bytes();
    let ahead = AHEAD.saturating_sub(description.len());
    spent.header += ahead;
    description.resize(description.len() + ahead, 0);
    bytes.extend(description);
    limit("bytes", bytes.len() as u64, MAX_BYTES as u64)?;
    preface(&mut bytes);
    Ok((bytes, spent))
}

/// Fills in the first bytes, after all others are written.
fn preface(bytes: &mut [u8]) {
    let (length, sum) = (bytes.len() as u32, CRC_32.checksum(&bytes[SUMMED..]));
    bytes[..4].copy_from_slice(&MAGIC);
    bytes[4..6].copy_from_slice(&VERSION.to_le_bytes());
    bytes[6..8].copy_from_slice(&[0; 2]);
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes[12..16].copy_from_slice(&sum.to_le_bytes());
}

fn header(stored: &StoredTake, bits: &mut BitWriter) {
    bits.put_float(stored.clock.start);
    bits.put_float(stored.clock.length);
    bits.put(stored.clock.frames, 32);
    bits.put(stored.bones.len() as u32, 32);
    bits.put(stored.shift, 8);
    bits.put(stored.grid.rotation_bits, 8);
    bits.put(stored.grid.translation_bits, 8);
    bits.put_float(stored.grid.step);
    let name = name(&stored.name);
    bits.put(name.len() as u32, 8);
    name.bytes().for_each(|byte| bits.put(u32::from(byte), 8));
}

/// Truncates a name to 255 bytes.
fn name(name: &str) -> &str {
    let end = (0..=name.len().min(255)).rev().find(|&end| name.is_char_boundary(end)).unwrap_or(0);
    &name[..end]
}

fn kinds_and_constants(stored: &StoredTake, bits: &mut BitWriter) {
    for part in stored.bones.iter().flatten() {
        bits.put(part.kind(), 2);
    }
    for parts in &stored.bones {
        for (which, part) in parts.iter().enumerate() {
            match (which, part) {
                (0, StoredChannel::Constant(rotation)) => constant_rotation(stored, *rotation, bits),
                (1, StoredChannel::Constant([x, y, z, _])) => {
                    [x, y, z].into_iter().for_each(|value| constant_length(stored, *value, bits));
                }
                (_, StoredChannel::Constant([x, y, z, _])) => {
                    [x, y, z].into_iter().for_each(|value| constant_factor(*value, bits));
                }
                _ => {}
            }
        }
    }
}

fn constant_rotation(stored: &StoredTake, rotation: [f32; 4], bits: &mut BitWriter) {
    let width = stored.grid.rotation_bits;
    if width == FLOATS {
        return rotation.into_iter().for_each(|number| bits.put_float(number));
    }
    let (dropped, numbers) = rotation_numbers(Quat::from_array(rotation), width);
    bits.put(dropped, 2);
    numbers.into_iter().for_each(|number| bits.put(number, width));
}

fn constant_length(stored: &StoredTake, value: f32, bits: &mut BitWriter) {
    let width = stored.grid.translation_bits;
    if width == FLOATS {
        return bits.put_float(value);
    }
    let number = stored.grid.number(value);
    bits.put(u32::from(number != 0), 1);
    if number != 0 {
        bits.put((number + (1 << (width - 1))) as u32, width);
    }
}

fn constant_factor(value: f32, bits: &mut BitWriter) {
    if value == 1.0 {
        bits.put(0, 2);
    } else if value == -1.0 {
        bits.put(1, 2);
    } else {
        bits.put(2, 2);
        bits.put_float(value);
    }
}

/// Returns the channels for which `pick` returns a value, with their bones: all rotations, then translations, then
/// scales.
fn of_all<'a, T>(stored: &'a StoredTake, pick: impl Fn(&'a StoredChannel) -> Option<T>) -> Vec<(usize, T)> {
    let of = |which: usize| stored.bones.iter().map(move |parts| (which, &parts[which]));
    (0..3).flat_map(of).filter_map(|(which, part)| Some((which, pick(part)?))).collect()
}

/// Returns the packed tracks with their properties, in the order in which they are stored.
fn packed(stored: &StoredTake) -> Vec<(usize, &PackedChannel)> {
    let kinds: Vec<[u32; PARTS]> =
        stored.bones.iter().map(|parts| [0, 1, 2].map(|part| parts[part].kind())).collect();
    let packed = |slot: TrackSlot| Some((slot.part, stored.bones[slot.bone][slot.part].packed()?));
    slots(&groups(&kinds)).into_iter().filter_map(packed).collect()
}

fn ranges(tracks: &[(usize, &PackedChannel)], bits: &mut BitWriter) {
    for (part, track) in tracks {
        let (low, extent) = (track.range.low.to_array(), track.range.extent.to_array());
        if *part == 0 {
            track.reference.0.into_iter().for_each(|number| bits.put(u32::from(number as u8), 8));
            low.into_iter().for_each(|number| bits.put((number / TURN_UNIT) as i32 as u32, 16));
            extent.into_iter().for_each(|number| bits.put((number / TURN_UNIT) as u32, 16));
        } else {
            low.into_iter().chain(extent).for_each(|number| bits.put_float(number));
        }
    }
}

fn heads(tracks: &[(usize, &PackedChannel)], bits: &mut BitWriter) {
    let segments = tracks.first().map_or(0, |(_, track)| track.segments.len());
    for segment in 0..segments {
        for (_, track) in tracks {
            let head = &track.segments[segment].head;
            for axis in 0..3 {
                if segments > 1 {
                    bits.put(u32::from(head.place[axis]), 8);
                    bits.put(u32::from(head.extent[axis]), 8);
                }
                bits.put(u32::from(head.bits[axis]), 5);
            }
        }
    }
}

fn whole(stored: &StoredTake, bytes: &mut Vec<u8>) {
    let values = |part: &'_ StoredChannel| {
        if let StoredChannel::Whole(values) = part { Some(values.clone()) } else { None }
    };
    for (which, values) in of_all(stored, values) {
        for value in values {
            if which == 0 {
                let (dropped, numbers) = rotation_numbers(Quat::from_array(value), WHOLE_BITS);
                let word =
                    numbers.into_iter().rev().fold(0, |word, number| word << WHOLE_BITS | u64::from(number));
                bytes.extend((word << 2 | u64::from(dropped)).to_le_bytes());
            } else {
                value[..3].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
            }
        }
    }
}

fn keys(tracks: &[(usize, &PackedChannel)]) -> Vec<u8> {
    let mut bits = BitWriter::default();
    let segments = tracks.first().map_or(0, |(_, track)| track.segments.len());
    for segment in 0..segments {
        let length = tracks.first().map_or(0, |(_, track)| track.segments[segment].keys.len());
        for key in 0..length {
            for (_, track) in tracks {
                let segment = &track.segments[segment];
                let numbers = segment.keys[key].into_iter().zip(segment.head.bits);
                numbers.for_each(|(number, width)| bits.put(number, u32::from(width)));
            }
            bits.fill_byte();
        }
    }
    bits.into_bytes()
}
