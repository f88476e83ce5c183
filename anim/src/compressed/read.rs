//! Reading of bytes into the tables that decoding needs; every number is checked before it is used.

use super::bits::BitReader;
use super::clock::FrameClock;
use super::encode::TURN_UNIT;
use super::extents::{AHEAD, PREFACE, SUMMED};
use super::grid::{FLOATS, MOST_BITS, rotation_from};
use super::stored::{
    CONSTANT, LARGEST, MAX_BITS, PACKED, Reference, RoundingGrid, SHIFTS, SegmentHead, ValueRange, WHOLE,
};
use super::table::{SegmentPlace, Tables};
use super::whole::WholeTrack;
use super::{FormatError, MAGIC, MAX_BONES, MAX_BYTES, MAX_FRAMES, MAX_VALUES, VERSION};
use crate::checksum::CRC_32;
use crate::data::Transform;
use glam::{Quat, Vec3};

type Result<T> = std::result::Result<T, FormatError>;

/// Checks `bytes` and builds the tables.
pub(super) fn read(bytes: &[u8]) -> Result<Tables> {
    let end_of_keys = check_preface(bytes)?;
    let mut bits = BitReader::new(bytes, end_of_keys);
    let (header, name) = header(&mut bits)?;
    let kinds = kinds(&mut bits, &header)?;
    let constants = constants(&mut bits, &header, &kinds)?;
    let mut tables = Tables::new(header.clock, header.shift, name, &kinds, &constants);
    let mut tracks = Vec::new();
    for place in tables.slots() {
        let (reference, range) = track(&mut bits, place.part)?;
        if place.part == 0 {
            tables.refer(&place, reference);
        }
        tracks.push((place, range));
    }
    let segments = if tracks.is_empty() { 0 } else { header.clock.frames.div_ceil(1 << header.shift) };
    let mut at = PREFACE;
    for (bone, part) in of_kind(&kinds, WHOLE) {
        let track = WholeTrack { bone, part, offset: at };
        at += track.bytes_per_key() * header.clock.frames as usize;
        tables.whole.push(track);
    }
    for segment in 0..segments {
        let heads = tracks.iter().map(|_| head(&mut bits, segments == 1)).collect::<Result<Vec<_>>>()?;
        let stride = tables.add_segment(&tracks, &heads).div_ceil(8);
        // If this exceeds 32 bits, so does the total, which is checked before it is used.
        tables.segments.push(SegmentPlace { at: at as u32, stride });
        at += stride as usize
            * (header.clock.frames - (segment << header.shift)).min(1 << header.shift) as usize;
    }
    check(16, "the end of the keys", end_of_keys, end_of_keys == at)?;
    check_whole(bytes, &tables)?;
    check_end(bytes, bits.next_byte(), end_of_keys)?;
    Ok(tables)
}

/// Checks that after the last bit only the zeros follow that reading ahead needs.
fn check_end(bytes: &[u8], end: usize, end_of_keys: usize) -> Result<()> {
    if bytes.len() != end.max(end_of_keys + AHEAD) {
        return Err(FormatError::new(end, format!("{} unexpected bytes at the end", bytes.len() - end)));
    }
    match bytes[end..].iter().position(|&byte| byte != 0) {
        Some(place) => Err(FormatError::new(end + place, "the last bytes are not zero")),
        None => Ok(()),
    }
}

/// Returns the byte after the last key, where the description starts.
fn check_preface(bytes: &[u8]) -> Result<usize> {
    if bytes.len() < PREFACE + AHEAD {
        return Err(FormatError::new(
            bytes.len(),
            format!("{} bytes are too few for a compressed take", bytes.len()),
        ));
    }
    let word = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    if bytes[..4] != MAGIC {
        return Err(FormatError::new(0, "not a compressed take: the magic number is wrong"));
    }
    if word(4) != u32::from(VERSION) {
        return Err(FormatError::new(4, format!("version {} is not supported", word(4))));
    }
    if word(8) as usize != bytes.len() || bytes.len() > MAX_BYTES {
        return Err(FormatError::new(
            8,
            format!("the stored length is {} bytes, but there are {}", word(8), bytes.len()),
        ));
    }
    // A fuzzer cannot guess a checksum; what follows must be safe without one.
    if word(12) != CRC_32.checksum(&bytes[SUMMED..]) && !cfg!(fuzzing) {
        return Err(FormatError::new(12, "the checksum does not match: the bytes were changed"));
    }
    let end_of_keys = word(16) as usize;
    let right = (PREFACE..=bytes.len() - AHEAD).contains(&end_of_keys);
    check(16, "the end of the keys", end_of_keys, right)
}

struct TakeHeader {
    clock: FrameClock,
    bones: usize,
    shift: u32,
    grid: RoundingGrid,
}

/// Returns `value` if `right`, and an error otherwise.
fn check<T: Copy + std::fmt::Display>(offset: usize, what: &str, value: T, right: bool) -> Result<T> {
    if right { Ok(value) } else { Err(FormatError::new(offset, format!("{what} is invalid: {value}"))) }
}

fn header(bits: &mut BitReader<'_>) -> Result<(TakeHeader, String)> {
    let at = bits.offset();
    let start = bits.take_float()?;
    let length = bits.take_float()?;
    check(at + 4, "the length", length, length >= 0.0 && (start + length).is_finite())?;
    let frames = bits.take(32)?;
    check(at + 8, "the number of keys", frames, frames >= 1 && frames as usize <= MAX_FRAMES)?;
    let bones = bits.take(32)? as usize;
    check(at + 12, "the number of bones", bones, bones <= MAX_BONES)?;
    let shift = bits.take(8)?;
    check(at + 16, "the size of segments", shift, SHIFTS.contains(&shift))?;
    let rotation_bits = bits.take(8)?;
    let translation_bits = bits.take(8)?;
    for (at, bits) in [(at + 17, rotation_bits), (at + 18, translation_bits)] {
        check(at, "the width of constants", bits, (4..=MOST_BITS).contains(&bits) || bits == FLOATS)?;
    }
    let step = bits.take_float()?;
    check(at + 19, "the step of constants", step, step > 0.0 && step < 1e18)?;
    let length_of_name = bits.take(8)?;
    let place = bits.offset();
    let name: Vec<u8> = (0..length_of_name).map(|_| Ok(bits.take(8)? as u8)).collect::<Result<_>>()?;
    let name = String::from_utf8(name).map_err(|_| FormatError::new(place, "the name is not UTF-8"))?;
    let grid = RoundingGrid { rotation_bits, step, translation_bits };
    Ok((TakeHeader { clock: FrameClock { start, length, frames }, bones, shift, grid }, name))
}

/// Reads the storage of three channels per bone.
fn kinds(bits: &mut BitReader<'_>, header: &TakeHeader) -> Result<Vec<[u32; 3]>> {
    let at = bits.offset();
    let mut kinds = Vec::new();
    for _ in 0..header.bones {
        kinds.push([bits.take(2)?, bits.take(2)?, bits.take(2)?]);
    }
    let moving = kinds.iter().flatten().filter(|&&kind| kind == PACKED || kind == WHOLE).count();
    let values = moving.saturating_mul(header.clock.frames as usize);
    check(at, "the number of values", values, values <= MAX_VALUES)?;
    Ok(kinds)
}

/// Returns the bones and channels with one storage: all rotations, then translations, then scales.
fn of_kind(kinds: &[[u32; 3]], kind: u32) -> Vec<(usize, usize)> {
    let of = |part: usize| kinds.iter().enumerate().filter(move |(_, kinds)| kinds[part] == kind);
    (0..3).flat_map(|part| of(part).map(move |(bone, _)| (bone, part))).collect()
}

fn constants(bits: &mut BitReader<'_>, header: &TakeHeader, kinds: &[[u32; 3]]) -> Result<Vec<Transform>> {
    let mut poses = Vec::new();
    for &[rotation, translation, scale] in kinds {
        let mut pose = Transform::IDENTITY;
        if rotation == CONSTANT {
            pose.rotation = constant_rotation(bits, header.grid.rotation_bits)?;
        }
        if translation == CONSTANT {
            pose.translation = three(|| constant_length(bits, &header.grid))?;
        }
        if scale == CONSTANT {
            pose.scale = three(|| constant_factor(bits))?;
        }
        poses.push(pose);
    }
    Ok(poses)
}

fn three(mut one: impl FnMut() -> Result<f32>) -> Result<Vec3> {
    Ok(Vec3::new(one()?, one()?, one()?))
}

fn constant_rotation(bits: &mut BitReader<'_>, width: u32) -> Result<Quat> {
    let at = bits.offset();
    if width == FLOATS {
        let numbers = [bits.take_float()?, bits.take_float()?, bits.take_float()?, bits.take_float()?];
        let rotation = Quat::from_array(numbers);
        check(at, "a rotation", rotation, (rotation.length_squared() - 1.0).abs() < 1e-3)
    } else {
        let dropped = bits.take(2)?;
        Ok(rotation_from(dropped, [bits.take(width)?, bits.take(width)?, bits.take(width)?], width))
    }
}

fn constant_length(bits: &mut BitReader<'_>, grid: &RoundingGrid) -> Result<f32> {
    let width = grid.translation_bits;
    if width == FLOATS {
        return number(bits);
    }
    if bits.take(1)? == 0 {
        return Ok(0.0);
    }
    Ok((bits.take(width)? as i32 - (1 << (width - 1))) as f32 * grid.step)
}

/// Reads a float and checks its size.
fn number(bits: &mut BitReader<'_>) -> Result<f32> {
    let at = bits.offset();
    let number = bits.take_float()?;
    check(at, "a constant", number, number.abs() <= LARGEST)
}

fn constant_factor(bits: &mut BitReader<'_>) -> Result<f32> {
    let at = bits.offset();
    match bits.take(2)? {
        0 => Ok(1.0),
        1 => Ok(-1.0),
        2 => number(bits),
        other => Err(FormatError::new(at, format!("unknown code {other} of a constant factor"))),
    }
}

fn track(bits: &mut BitReader<'_>, part: usize) -> Result<(Reference, ValueRange)> {
    if part == 0 {
        let mut reference = [0; 4];
        for number in &mut reference {
            *number = bits.take(8)? as u8 as i8;
        }
        let low = three(|| Ok(f32::from(bits.take(16)? as u16 as i16) * TURN_UNIT))?;
        let extent = three(|| Ok(bits.take(16)? as f32 * TURN_UNIT))?;
        return Ok((Reference(reference), ValueRange { low, extent }));
    }
    let low = three(|| bits.take_float())?;
    let at = bits.offset();
    let extent = three(|| bits.take_float())?;
    let right = extent.min_element() >= 0.0
        && extent.max_element() < 2e18
        && low.abs().max_element() <= 2.0 * LARGEST;
    check(at, "the extent of a track", extent, right)?;
    Ok((Reference::NONE, ValueRange { low, extent }))
}

fn head(bits: &mut BitReader<'_>, only: bool) -> Result<SegmentHead> {
    let mut head = SegmentHead::default();
    for axis in 0..3 {
        if !only {
            head.place[axis] = bits.take(8)? as u8;
            head.extent[axis] = bits.take(8)? as u8;
        }
        let at = bits.offset();
        let width = bits.take(5)?;
        head.bits[axis] = check(at, "the width of keys", width, width <= MAX_BITS)? as u8;
    }
    Ok(if only { SegmentHead::only(head.bits) } else { head })
}

fn check_whole(bytes: &[u8], tables: &Tables) -> Result<()> {
    for track in &tables.whole {
        for key in 0..tables.clock.frames {
            let value = track.value(bytes, key);
            let at = track.offset + track.bytes_per_key() * key as usize;
            check(at, "a value", value[0], value.iter().all(|number| number.abs() <= LARGEST))?;
        }
    }
    Ok(())
}
