//! FLAC: frames that begin with a sign and end with a checksum, and do not contain their length.
//!
//! The end of a frame is where the header of the next one begins: with a checksum of its own, the next number, and after bytes whose checksum is
//! right. Each byte is looked at once.

use super::packets::{CopiedFormat, CopiedHead, CopiedPackets, FoundPackets, Unreadable};
use crate::sound::flac::{FRAME_CRC, HEADER_CRC, flac_entry};
use std::num::NonZeroU32;

pub(super) const FLAC: CopiedFormat =
    CopiedFormat { title: "FLAC", sniff: |start| start.starts_with(SIGN), read };

const SIGN: &[u8] = b"fLaC";
/// Kind and length of the first block, with the parameters of the stream.
const PARAMETERS: [u8; 4] = [0, 0, 0, 34];
/// Flag of the last block before the frames.
const LAST: u8 = 0x80;
/// Bytes of a block before its content.
const BLOCK_HEADER: usize = 4;
/// Bytes of the tag that old programs put at the end of a file.
const TAG: usize = 128;

/// The parameters of a stream that each frame repeats.
#[derive(Clone, Copy, Debug)]
struct FlacStream {
    rate: NonZeroU32,
    channels: u8,
    depth: u8,
}

impl FlacStream {
    /// Reads the content of the first block.
    fn read(parameters: &[u8]) -> Option<Self> {
        let bits = u64::from_be_bytes(*parameters.get(10..)?.first_chunk()?);
        Some(Self {
            rate: NonZeroU32::new((bits >> 44) as u32)?,
            channels: (bits >> 41 & 7) as u8 + 1,
            depth: (bits >> 36 & 31) as u8 + 1,
        })
    }
}

/// The header of a frame.
#[derive(Clone, Copy, Debug)]
struct FlacFrame {
    /// Whether the number is that of the first sample, and not of the frame.
    counts_samples: bool,
    number: u64,
    samples: u32,
}

impl FlacFrame {
    /// Reads the header of a frame of a stream; `None` where there is none.
    fn read(bytes: &[u8], stream: FlacStream) -> Option<Self> {
        let (&[first, second, sizes, kinds], rest) = bytes.split_first_chunk()?;
        if first != 0xFF || second & 0xFE != 0xF8 || kinds & 1 != 0 {
            return None;
        }
        let channels = match kinds >> 4 {
            plain @ 0..=7 => plain + 1,
            // Two channels, of which one is a difference or a mean.
            8..=10 => 2,
            _ => return None,
        };
        let depth = match kinds >> 1 & 7 {
            0 => stream.depth,
            1 => 8,
            2 => 12,
            4 => 16,
            5 => 20,
            6 => 24,
            7 => 32,
            _ => return None,
        };
        let (number, rest) = coded_number(rest)?;
        let (samples, rest) = match sizes >> 4 {
            0 => return None,
            1 => (192, rest),
            thirds @ 2..=5 => (576 << (thirds - 2), rest),
            6 => rest.split_first().map(|(size, rest)| (u32::from(*size) + 1, rest))?,
            7 => rest
                .split_first_chunk()
                .map(|(size, rest)| (u32::from(u16::from_be_bytes(*size)) + 1, rest))?,
            powers => (256 << (powers - 8), rest),
        };
        // The rate is that of the stream; it has a byte, two or none.
        let rest = rest.get(match sizes & 15 {
            12 => 1..,
            13 | 14 => 2..,
            15 => return None,
            _ => 0..,
        })?;
        let header = bytes.get(..bytes.len() - rest.len())?;
        let is_right = rest.first() == Some(&HEADER_CRC.checksum(header));
        let fits = (channels, depth) == (stream.channels, stream.depth);
        (is_right && fits).then_some(Self { counts_samples: second & 1 == 1, number, samples })
    }

    /// Returns whether `next` is the header of the frame after this one.
    fn precedes(self, next: Self) -> bool {
        let wanted = self.number + if self.counts_samples { u64::from(self.samples) } else { 1 };
        (next.counts_samples, next.number) == (self.counts_samples, wanted)
    }
}

/// Reads a number in the form of UTF-8, which the format extends to 36 bits.
fn coded_number(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let (first, rest) = bytes.split_first()?;
    let after = match first.leading_ones() {
        0 => return Some((u64::from(*first), rest)),
        ones @ 2..=7 => ones as usize - 1,
        _ => return None,
    };
    let (more, rest) = rest.split_at_checked(after)?;
    let start = u64::from(*first) & (0x3F >> after);
    more.iter()
        .try_fold(start, |number, byte| (byte >> 6 == 0b10).then_some(number << 6 | u64::from(byte & 0x3F)))
        .map(|number| (number, rest))
}

fn read(file: Vec<u8>, start: usize) -> Result<CopiedPackets, Unreadable> {
    let blocks = start + SIGN.len();
    let parameters = file.get(blocks..).and_then(|rest| rest.get(..BLOCK_HEADER + PARAMETERS[3] as usize));
    let parameters =
        parameters.filter(|block| [block[0] & !LAST, block[1], block[2], block[3]] == PARAMETERS);
    let parameters = parameters.map(|block| block[BLOCK_HEADER..].to_vec());
    let no_parameters = || Unreadable::new(blocks, "the parameters of the stream are missing");
    let parameters = parameters.ok_or_else(no_parameters)?;
    let stream = FlacStream::read(&parameters).ok_or_else(no_parameters)?;
    let mut found = FoundPackets::default();
    add_frames(&file, frames_start(&file, blocks)?, stream, &mut found)?;
    let entry = flac_entry(parameters, stream.rate, u16::from(stream.channels), u16::from(stream.depth));
    let head = CopiedHead { entry, timescale: stream.rate, skip: 0, played: None, roll: 0 };
    found.end(file, head)
}

/// Returns the offset of the first frame, after all blocks.
fn frames_start(file: &[u8], blocks: usize) -> Result<usize, Unreadable> {
    let mut at = blocks;
    loop {
        let header = file.get(at..).and_then(|rest| rest.first_chunk::<BLOCK_HEADER>());
        let [kind, length @ ..] =
            header.ok_or_else(|| Unreadable::new(at, "the file ends before the sound"))?;
        at += BLOCK_HEADER + length.iter().fold(0, |number, byte| number << 8 | usize::from(*byte));
        if kind & LAST != 0 {
            return Ok(at);
        }
    }
}

/// Finds the frames from `start` on.
fn add_frames(
    file: &[u8],
    start: usize,
    stream: FlacStream,
    found: &mut FoundPackets,
) -> Result<(), Unreadable> {
    let tag = file.len().saturating_sub(TAG);
    let end = if file.get(tag..).is_some_and(|last| last.starts_with(b"TAG")) { tag } else { file.len() };
    let file = &file[..end];
    let first = file.get(start..).and_then(|rest| FlacFrame::read(rest, stream));
    let mut frame = first.ok_or_else(|| Unreadable::new(start, "there is no frame of the stream"))?;
    let (mut begin, mut at) = (start, start + 1);
    let mut checksum = FRAME_CRC.digest();
    // The checksum of all bytes of a frame, its own checksum included, is 0.
    let mut summed = begin;
    while at < file.len() {
        let Some(sign) = file[at..].iter().position(|byte| *byte == 0xFF) else { break };
        at += sign;
        let next = FlacFrame::read(&file[at..], stream).filter(|next| frame.precedes(*next));
        if let Some(next) = next {
            checksum.update(&file[summed..at]);
            summed = at;
            if checksum.clone().finalize() == 0 {
                found.add(begin, at - begin, frame.samples)?;
                (frame, begin) = (next, at);
                checksum = FRAME_CRC.digest();
            }
        }
        at += 1;
    }
    checksum.update(&file[summed..]);
    if checksum.finalize() != 0 {
        return Err(Unreadable::new(begin, "the frame is damaged, or the file ends in it"));
    }
    found.add(begin, file.len() - begin, frame.samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_the_format_writes_them() {
        let read = |bytes: &[u8]| coded_number(bytes).map(|(number, rest)| (number, rest.len()));
        assert_eq!(read(&[0x7F, 1]), Some((0x7F, 1)));
        assert_eq!(read(&[0xC2, 0x80]), Some((0x80, 0)));
        assert_eq!(read(&[0xDF, 0xBF, 9]), Some((0x7FF, 1)));
        assert_eq!(read(&[0xEF, 0xBF, 0xBF]), Some((0xFFFF, 0)));
        assert_eq!(read(&[0xFE, 0xBF, 0xBF, 0xBF, 0xBF, 0xBF, 0xBF]), Some((0xF_FFFF_FFFF, 0)));
        for wrong in [&[0x80][..], &[0xFF, 0x80], &[0xC2], &[0xC2, 0x00], &[]] {
            assert_eq!(read(wrong), None, "{wrong:?}");
        }
    }
}
