//! The places of the bytes of a compressed take, and their numbers by content.

/// Bytes before the keys: magic number, version, length, checksum, and the end of the keys.
pub(super) const PREFACE: usize = 20;
/// The first byte that the checksum covers.
pub(super) const SUMMED: usize = 16;
/// Smallest number of bytes after the keys, so that the numbers of eight lanes can be read at once from any position.
pub(super) const AHEAD: usize = 32;

/// Sizes in bytes, by content.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ByteSizes {
    /// Name, times, checksums.
    pub header: usize,
    /// Constant channels.
    pub constants: usize,
    /// Ranges and widths of packed channels.
    pub ranges: usize,
    /// Keys stored whole.
    pub whole: usize,
    /// Packed keys.
    pub keys: usize,
}

impl ByteSizes {
    /// Returns the sum: the length of [`CompressedTake::as_bytes`](super::CompressedTake::as_bytes).
    pub fn total(&self) -> usize {
        self.header + self.constants + self.ranges + self.whole + self.keys
    }
}
