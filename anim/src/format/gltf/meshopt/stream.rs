//! Bytes of compressed data, read from the front.

/// Reason why compressed data cannot be decoded.
pub(super) type MeshoptFault = &'static str;

/// Fault of data that ends too early.
pub(super) const ENDS_EARLY: MeshoptFault = "it ends too early";

/// Compressed data that is being read.
pub(super) struct MeshoptStream<'a> {
    rest: &'a [u8],
}

impl<'a> MeshoptStream<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Removes and returns the next `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], MeshoptFault> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(ENDS_EARLY)?;
        self.rest = rest;
        Ok(taken)
    }

    /// Removes and returns the last `count` bytes.
    pub(super) fn take_last(&mut self, count: usize) -> Result<&'a [u8], MeshoptFault> {
        let from = self.rest.len().checked_sub(count).ok_or(ENDS_EARLY)?;
        let (rest, taken) = self.rest.split_at(from);
        self.rest = rest;
        Ok(taken)
    }

    pub(super) fn byte(&mut self) -> Result<u8, MeshoptFault> {
        let (&byte, rest) = self.rest.split_first().ok_or(ENDS_EARLY)?;
        self.rest = rest;
        Ok(byte)
    }

    /// Returns a number of up to five bytes with seven bits each, the lowest first (LEB128).
    pub(super) fn number(&mut self) -> Result<u32, MeshoptFault> {
        let mut number = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(number);
            }
        }
        Err("a number has more than five bytes")
    }

    /// Returns an error unless everything was read.
    pub(super) fn finish(&self) -> Result<(), MeshoptFault> {
        if self.rest.is_empty() { Ok(()) } else { Err("it has more bytes than needed") }
    }
}

/// Returns the signed number, in two's complement, of a zigzag-encoded one: 0, -1, 1, -2, …
pub(super) fn unzigzag(number: u32) -> u32 {
    (number >> 1) ^ (number & 1).wrapping_neg()
}

/// Writes an index of `stride` bytes, 2 or 4, into its place of `out`.
pub(super) fn put_index(out: &mut [u8], index: u32) {
    out.iter_mut().zip(index.to_le_bytes()).for_each(|(out, byte)| *out = byte);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_the_specification_are_read() {
        // The examples of the extension's text.
        let bytes = [0x7f, 0x81, 0x04, 0xff, 0xa0, 0x05, 0xff, 0xff, 0xff, 0xff, 0xff];
        let mut stream = MeshoptStream::new(&bytes);
        let numbers = [stream.number(), stream.number(), stream.number()];
        assert_eq!(numbers, [Ok(0x7f), Ok(0x201), Ok(0x1_507f)]);
        assert!(stream.number().is_err());
        assert_eq!([0, 1, 2, 3].map(|number| unzigzag(number) as i32), [0, -1, 1, -2]);
    }
}
