//! CRC-32, the checksum of Ethernet, zip and PNG (ISO 3309): notices every change of up to 32 bits in a row.
//!
//! ```text
//! remainder of the bytes, as a polynomial over two numbers, divided by
//! x³² + x²⁶ + x²³ + x²² + x¹⁶ + x¹² + x¹¹ + x¹⁰ + x⁸ + x⁷ + x⁵ + x⁴ + x² + x + 1
//! lowest bit first, begun with all ones, all bits turned over at the end
//! ```

/// The polynomial, lowest bit first.
const POLYNOMIAL: u32 = 0xEDB8_8320;

/// Eight bits of division at once.
const TABLE: [u32; 256] = table();

const fn table() -> [u32; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut remainder = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            remainder = if remainder & 1 == 1 { remainder >> 1 ^ POLYNOMIAL } else { remainder >> 1 };
            bit += 1;
        }
        table[byte] = remainder;
        byte += 1;
    }
    table
}

/// A checksum under way.
#[derive(Clone, Copy)]
pub(crate) struct Checksum(u32);

impl Checksum {
    /// Of nothing yet.
    pub(crate) const START: Self = Self(u32::MAX);

    /// With `bytes` behind what came before.
    pub(crate) fn with(self, bytes: &[u8]) -> Self {
        let step = |remainder: u32, &byte: &u8| remainder >> 8 ^ TABLE[(remainder as u8 ^ byte) as usize];
        Self(bytes.iter().fold(self.0, step))
    }

    /// The number that is written.
    pub(crate) fn value(self) -> u32 {
        !self.0
    }
}

#[cfg(test)]
mod tests {
    use super::Checksum;

    #[test]
    fn the_checksum_is_that_of_the_standard() {
        assert_eq!(Checksum::START.value(), 0);
        // The check value that every description of this checksum gives.
        assert_eq!(Checksum::START.with(b"1234").with(b"56789").value(), 0xCBF4_3926);
    }
}
