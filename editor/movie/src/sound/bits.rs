//! Bits written one after the other, most significant first.

/// Bytes that grow by bits.
#[derive(Clone, Debug, Default)]
pub(super) struct SoundBits {
    bytes: Vec<u8>,
    /// Bits that do not fill a byte yet, and their number.
    open: u64,
    count: u32,
}

impl SoundBits {
    /// Writes the lowest `count` bits of a number, at most 32.
    pub(super) fn put(&mut self, value: u32, count: u32) {
        let value = u64::from(value) & ((1 << count) - 1);
        self.open = self.open << count | value;
        self.count += count;
        while self.count >= 8 {
            self.count -= 8;
            self.bytes.push((self.open >> self.count) as u8);
        }
        self.open &= (1 << self.count) - 1;
    }

    /// Writes `zeros` zeros and a one.
    pub(super) fn unary(&mut self, zeros: u32) {
        (0..zeros / 32).for_each(|_| self.put(0, 32));
        self.put(0, zeros % 32);
        self.put(1, 1);
    }

    /// Fills the last byte with zeros. Returns the bytes so far.
    pub(super) fn aligned(&mut self) -> &mut Vec<u8> {
        if self.count > 0 {
            self.put(0, 8 - self.count);
        }
        &mut self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_written_in_order() {
        let mut bits = SoundBits::default();
        bits.put(0b101, 3);
        bits.put(0xFFFF_FFFF, 32);
        bits.unary(33);
        bits.put(0, 0);
        assert_eq!(*bits.aligned(), [0b1011_1111, 255, 255, 255, 0b1110_0000, 0, 0, 0, 0b0000_1000]);
    }
}
