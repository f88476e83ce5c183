//! Mode 0, attributes: differences of consecutive elements, each byte of an element on its own.
//!
//! Elements are stored in blocks, the bytes of a block by their position in the element, in groups of 16. Version 0 of the
//! encoding is that of `EXT_meshopt_compression`; version 1 has control modes (which widths a byte uses) and channel
//! modes (how differences are added).

use super::stream::{MeshoptFault, MeshoptStream, unzigzag};

/// Number of elements of a group.
const GROUP: usize = 16;
/// Largest number of elements of a block.
const BLOCK: usize = 256;

/// Widths in bits that the two header bits of a group choose from.
const WIDTHS_OF_VERSION_0: [u8; 4] = [0, 2, 4, 8];
const NARROW_WIDTHS: [u8; 4] = [0, 1, 2, 4];
const WIDE_WIDTHS: [u8; 4] = [1, 2, 4, 8];

/// How the differences of four bytes are added to the element before.
#[derive(Clone, Copy, Debug)]
enum MeshoptChannel {
    /// Each byte on its own.
    Bytes,
    /// Two numbers of 16 bits.
    Words,
    /// Exclusive or with a number of 32 bits, which is stored rotated to the left by this many bits.
    Bits(u32),
}

impl MeshoptChannel {
    fn of(mode: u8) -> Result<Self, MeshoptFault> {
        match (mode & 15, mode >> 4) {
            (0, 0) => Ok(Self::Bytes),
            (1, 0) => Ok(Self::Words),
            (2, rotation) => Ok(Self::Bits(u32::from(rotation))),
            _ => Err("a channel mode is unknown"),
        }
    }

    /// Adds the differences to four bytes of an element.
    fn add(self, before: &mut [u8; 4], difference: [u8; 4]) {
        match self {
            Self::Bytes => {
                for (before, difference) in before.iter_mut().zip(difference) {
                    *before = before.wrapping_add(unzigzag(difference.into()) as u8);
                }
            }
            Self::Words => {
                let [a, b, c, d] = *before;
                let [e, f, g, h] = difference;
                let sum = |before: [u8; 2], difference: [u8; 2]| {
                    let difference = unzigzag(u16::from_le_bytes(difference).into()) as u16;
                    u16::from_le_bytes(before).wrapping_add(difference).to_le_bytes()
                };
                let ([a, b], [c, d]) = (sum([a, b], [e, f]), sum([c, d], [g, h]));
                *before = [a, b, c, d];
            }
            Self::Bits(rotation) => {
                let rotated = u32::from_le_bytes(difference).rotate_right(rotation);
                *before = (u32::from_le_bytes(*before) ^ rotated).to_le_bytes();
            }
        }
    }
}

/// Decodes elements of `stride` bytes, a multiple of 4 up to 256, until `out` is full.
pub(super) fn decode(data: &[u8], stride: usize, out: &mut [u8]) -> Result<(), MeshoptFault> {
    let mut stream = MeshoptStream::new(data);
    let is_version_1 = match stream.byte()? {
        0xa0 => false,
        0xa1 => true,
        _ => return Err("it is no attributes of version 0 or 1"),
    };
    let (modes, least) = if is_version_1 { (stride / 4, 24) } else { (0, 32) };
    let tail = stream.take_last((stride + modes).max(least))?;
    let mut tail = MeshoptStream::new(tail);
    let modes = tail.take_last(modes)?;
    let (baseline, _) = tail.take_last(stride)?.as_chunks::<4>();
    let mut channels = vec![MeshoptChannel::Bytes; stride / 4];
    for (channel, &mode) in channels.iter_mut().zip(modes) {
        *channel = MeshoptChannel::of(mode)?;
    }
    let mut before = baseline.to_vec();
    // At most 64 KiB: the differences of a block, by position in the element.
    let mut differences = vec![0; stride * BLOCK];
    let block = (8192 / stride / GROUP * GROUP).min(BLOCK);
    for elements in out.chunks_mut(block * stride) {
        let count = elements.len() / stride;
        let controls = if is_version_1 { stream.take(stride / 4)? } else { &[] };
        for (position, column) in differences.chunks_mut(BLOCK).enumerate() {
            let control = controls.get(position / 4).map(|byte| byte >> (position % 4 * 2) & 3);
            read_column(&mut stream, control, count, column)?;
        }
        for (index, element) in elements.chunks_exact_mut(stride).enumerate() {
            let (element, _) = element.as_chunks_mut::<4>();
            for (number, ((element, before), channel)) in
                element.iter_mut().zip(&mut before).zip(&channels).enumerate()
            {
                let difference = std::array::from_fn(|byte| differences[(number * 4 + byte) * BLOCK + index]);
                channel.add(before, difference);
                *element = *before;
            }
        }
    }
    stream.finish()
}

/// Reads the differences of one byte of `count` elements into the start of `column`, whose length is [`BLOCK`]. `control`
/// is the control mode, 0..3; `None` for version 0.
fn read_column(
    stream: &mut MeshoptStream<'_>,
    control: Option<u8>,
    count: usize,
    column: &mut [u8],
) -> Result<(), MeshoptFault> {
    let widths = match control {
        None => WIDTHS_OF_VERSION_0,
        Some(0) => NARROW_WIDTHS,
        Some(1) => WIDE_WIDTHS,
        Some(2) => {
            column.fill(0);
            return Ok(());
        }
        Some(_) => {
            let literal = stream.take(count)?;
            column.iter_mut().zip(literal).for_each(|(difference, &byte)| *difference = byte);
            return Ok(());
        }
    };
    let groups = count.div_ceil(GROUP);
    let headers = stream.take(groups.div_ceil(4))?;
    let (column, _) = column.as_chunks_mut::<GROUP>();
    for (number, group) in column.iter_mut().take(groups).enumerate() {
        let header = headers[number / 4] >> (number % 4 * 2) & 3;
        read_group(stream, widths[usize::from(header)], group)?;
    }
    Ok(())
}

/// Reads the 16 differences of a group, of `width` bits each. One with all bits set is followed, after the group, by a
/// whole byte in its place.
fn read_group(
    stream: &mut MeshoptStream<'_>,
    width: u8,
    group: &mut [u8; GROUP],
) -> Result<(), MeshoptFault> {
    let width = usize::from(width);
    match width {
        0 => group.fill(0),
        8 => group.copy_from_slice(stream.take(GROUP)?),
        _ => {
            let packed = stream.take(GROUP * width / 8)?;
            let all = (1 << width) - 1;
            let in_byte = 8 / width;
            for (index, difference) in group.iter_mut().enumerate() {
                // The first one is in the lowest bit if there is one bit each, otherwise in the highest bits.
                let place = index % in_byte;
                let place = if width == 1 { place } else { in_byte - 1 - place };
                let bits = packed[index / in_byte] >> (place * width) & all;
                *difference = if bits == all { stream.byte()? } else { bits };
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_group_of_the_specification_is_decoded() {
        let bytes = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut stream = MeshoptStream::new(&bytes);
        let mut group = [0; GROUP];
        read_group(&mut stream, 4, &mut group).unwrap();
        let decoded = group.map(|difference| unzigzag(difference.into()) as i8);
        assert_eq!(decoded, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
        stream.finish().unwrap();
    }
}
