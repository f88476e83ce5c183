//! Numbers of any width in a bit stream, the lowest bit first.

use super::FormatError;

/// Appends numbers to a bit stream.
#[derive(Debug, Default)]
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    /// Number of bits written so far.
    bits: usize,
}

impl BitWriter {
    /// Appends the lowest `width` bits of `value`; `width` is 0..=32.
    pub(super) fn put(&mut self, value: u32, width: u32) {
        let mut value = u64::from(value) & ((1 << width.min(32)) - 1);
        let (mut width, mut used) = (width.min(32) as usize, self.bits % 8);
        self.bits += width;
        while width > 0 {
            if used == 0 {
                self.bytes.push(0);
            }
            let taken = width.min(8 - used);
            if let Some(last) = self.bytes.last_mut() {
                *last |= ((value << used) & 0xff) as u8;
            }
            value >>= taken;
            width -= taken;
            used = 0;
        }
    }

    /// Appends all 32 bits of a float.
    pub(super) fn put_float(&mut self, value: f32) {
        self.put(value.to_bits(), 32);
    }

    /// Pads with zeros to a whole byte.
    pub(super) fn fill_byte(&mut self) {
        self.bits = self.bytes.len() * 8;
    }

    /// Returns the number of bytes started so far.
    pub(super) fn length(&self) -> usize {
        self.bytes.len()
    }

    /// Returns the bytes, the last one padded with zeros.
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

/// Reads numbers from a bit stream.
#[derive(Clone, Debug)]
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    /// Number of bits read so far, from the first byte.
    at: usize,
}

impl<'a> BitReader<'a> {
    /// Creates a reader of `bytes` from byte `offset` on.
    pub(super) fn new(bytes: &'a [u8], offset: usize) -> Self {
        Self { bytes, at: offset.saturating_mul(8) }
    }

    /// Returns a reader of the same stream, `bits` bits further on.
    pub(super) fn after(mut self, bits: u32) -> Self {
        self.at = self.at.saturating_add(bits as usize);
        self
    }

    /// Reads the next `width` bits, 0..=32.
    pub(super) fn take(&mut self, width: u32) -> Result<u32, FormatError> {
        let end = self.at.saturating_add(width as usize);
        if end > self.bytes.len() * 8 {
            return Err(FormatError::new(self.bytes.len(), "the bytes end too early"));
        }
        let first = self.at / 8;
        let mut word = [0; 8];
        let there = self.bytes.len().min(first + 8) - first;
        word[..there].copy_from_slice(&self.bytes[first..first + there]);
        let value = (u64::from_le_bytes(word) >> (self.at % 8)) & ((1 << width) - 1);
        self.at = end;
        Ok(value as u32)
    }

    /// Reads the next 32 bits as a finite float.
    pub(super) fn take_float(&mut self) -> Result<f32, FormatError> {
        let offset = self.offset();
        let value = f32::from_bits(self.take(32)?);
        if value.is_finite() {
            Ok(value)
        } else {
            Err(FormatError::new(offset, format!("{value} is not a finite number")))
        }
    }

    /// Returns the index of the byte that contains the next bit.
    pub(super) fn offset(&self) -> usize {
        self.at / 8
    }

    /// Returns the index of the first byte of which no bit has been read.
    pub(super) fn next_byte(&self) -> usize {
        self.at.div_ceil(8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_width_come_back_in_order() {
        let mut writer = BitWriter::default();
        let numbers = |width: u32| (0x9e37_79b9_u32.wrapping_mul(width + 1)) & ((1_u64 << width) - 1) as u32;
        (0..=32).for_each(|width| writer.put(numbers(width), width));
        let bytes = writer.into_bytes();
        assert_eq!(bytes.len(), (32 * 33 / 2_usize).div_ceil(8));
        let mut reader = BitReader::new(&bytes, 0);
        (0..=32).for_each(|width| assert_eq!(reader.take(width), Ok(numbers(width)), "{width}"));
        assert!(reader.take(8).is_err());
    }
}
