//! The sequence parameter set of H.264: color, rate and buffering are added to what the encoder writes, so that they stay with the pictures when
//! another program copies them into another container.

use dragonfly_anim::stage::time::StageRate;

/// BT.709 in the tables of the standard, for primaries, transfer and matrix.
pub(crate) const BT709: u8 = 1;

/// Profiles whose parameters have no description of the color format: baseline, main and extended.
const SIMPLE_PROFILES: [u32; 3] = [66, 77, 88];

/// Returns the parameter set `nal` (with its header byte, without a start code) with usability information added; `None` where there is some
/// already, or the bytes are no parameter set of a simple profile.
pub(super) fn with_usability(nal: &[u8], rate: StageRate, references: u32) -> Option<Vec<u8>> {
    let (header, payload) = nal.split_first().filter(|(header, _)| **header & 31 == 7)?;
    let mut bits = BitString::read(payload);
    bits.pop_stop()?;
    // Only without the information is its flag the last bit.
    let flag = usability_flag(&bits)?;
    if flag + 1 != bits.0.len() || bits.0.pop()? {
        return None;
    }
    bits.put(1, 1);
    // No aspect ratio, no overscan.
    bits.put(0, 2);
    // A video signal of no format in limited range, with a description of its color.
    bits.put(1, 1);
    bits.put(5, 3);
    bits.put(0, 1);
    bits.put(1, 1);
    (0..3).for_each(|_| bits.put(u32::from(BT709), 8));
    // Color samples at the left, as is usual.
    bits.put(0, 1);
    let (frames, seconds) = rate.fraction();
    // A tick is half a frame, which has two fields.
    match frames.checked_mul(2) {
        Some(ticks) => {
            bits.put(1, 1);
            bits.put(seconds, 32);
            bits.put(ticks, 32);
            bits.put(1, 1);
        }
        None => bits.put(0, 1),
    }
    // No buffering models, no structure of pictures.
    bits.put(0, 3);
    // Restrictions: motion across the edges, sizes without a limit, vectors of any length, pictures in the order in which they are shown.
    bits.put(0b11, 2);
    bits.golomb(0);
    bits.golomb(0);
    bits.golomb(15);
    bits.golomb(15);
    bits.golomb(0);
    bits.golomb(references);
    Some(bits.into_nal(*header))
}

/// Returns the position of the flag of usability information.
fn usability_flag(bits: &BitString) -> Option<usize> {
    let mut at = 0;
    let profile = bits.number(&mut at, 8)?;
    if !SIMPLE_PROFILES.contains(&profile) {
        return None;
    }
    // Constraints and level; the number of the set; the length of the numbers of frames.
    bits.number(&mut at, 16)?;
    bits.code(&mut at)?;
    bits.code(&mut at)?;
    // The order of pictures, of which type 1 has a list.
    match bits.code(&mut at)? {
        0 => drop(bits.code(&mut at)?),
        1 => return None,
        _ => {}
    }
    // References, gaps, columns and rows.
    bits.code(&mut at)?;
    bits.number(&mut at, 1)?;
    bits.code(&mut at)?;
    bits.code(&mut at)?;
    let is_progressive = bits.number(&mut at, 1)? == 1;
    bits.number(&mut at, if is_progressive { 1 } else { 2 })?;
    if bits.number(&mut at, 1)? == 1 {
        for _ in 0..4 {
            bits.code(&mut at)?;
        }
    }
    Some(at)
}

/// Bits of a parameter set, most significant first.
struct BitString(Vec<bool>);

impl BitString {
    /// Reads bits, without the bytes that prevent start codes.
    fn read(payload: &[u8]) -> Self {
        let mut bits = Vec::with_capacity(payload.len() * 8);
        let mut zeros = 0;
        for byte in payload {
            if zeros >= 2 && *byte == 3 {
                zeros = 0;
                continue;
            }
            zeros = if *byte == 0 { zeros + 1 } else { 0 };
            bits.extend((0..8).rev().map(|bit| byte >> bit & 1 == 1));
        }
        Self(bits)
    }

    /// Returns the next `count` bits as a number.
    fn number(&self, at: &mut usize, count: usize) -> Option<u32> {
        let bits = self.0.get(*at..*at + count)?;
        *at += count;
        Some(bits.iter().fold(0, |number, bit| number << 1 | u32::from(*bit)))
    }

    /// Returns the next number in an Exp-Golomb code, of at most 16 bits.
    fn code(&self, at: &mut usize) -> Option<u32> {
        let zeros = self.0.get(*at..)?.iter().take_while(|bit| !**bit).count();
        *at += zeros;
        if zeros > 16 { None } else { Some(self.number(at, zeros + 1)? - 1) }
    }

    /// Removes the stop bit and the zeros after it.
    fn pop_stop(&mut self) -> Option<()> {
        while !self.0.pop()? {}
        Some(())
    }

    /// Adds the lowest `count` bits of a number.
    fn put(&mut self, value: u32, count: u32) {
        self.0.extend((0..count).rev().map(|bit| value >> bit & 1 == 1));
    }

    /// Adds a number in an Exp-Golomb code.
    fn golomb(&mut self, value: u32) {
        let coded = value + 1;
        let length = coded.ilog2();
        self.put(0, length);
        self.put(coded, length + 1);
    }

    /// Returns the bytes with a stop bit and the bytes that prevent start codes.
    fn into_nal(mut self, header: u8) -> Vec<u8> {
        self.put(1, 1);
        let mut nal = vec![header];
        let mut zeros = 0;
        for bits in self.0.chunks(8) {
            let byte = bits.iter().enumerate().fold(0, |byte, (at, bit)| byte | u8::from(*bit) << (7 - at));
            if zeros >= 2 && byte <= 3 {
                nal.push(3);
                zeros = 0;
            }
            zeros = if byte == 0 { zeros + 1 } else { 0 };
            nal.push(byte);
        }
        nal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn information_is_added_once_and_without_start_codes() {
        let rate = StageRate::parse("24000/1001").unwrap();
        // Baseline, level 3; 4 pictures of 2 × 2 blocks with 3 references, no cropping; no information.
        let mut bits = BitString(Vec::new());
        [66, 0, 30].into_iter().for_each(|byte| bits.put(byte, 8));
        [0, 0, 0, 4, 3].into_iter().for_each(|number| bits.golomb(number));
        bits.put(0, 1);
        bits.golomb(1);
        bits.golomb(1);
        bits.put(0b1100, 4);
        let plain = bits.into_nal(0x67);
        let added = with_usability(&plain, rate, 3).unwrap();
        assert!(added.starts_with(&plain[..plain.len() - 2]) && added.len() > plain.len() + 15);
        // 1001 has two zeros before it, and 48000 one.
        assert!(added.windows(3).all(|bytes| bytes[..2] != [0, 0] || bytes[2] >= 3));
        assert_eq!(with_usability(&added, rate, 3), None);
        assert_eq!(with_usability(&[0x67], rate, 3), None);
        assert_eq!(with_usability(&[0x67, 0, 0], rate, 3), None);
        assert_eq!(with_usability(&[0x68, 0xff], rate, 3), None);
    }
}
