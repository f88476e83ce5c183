//! Collects the parts of a file and concatenates them, with the total length and the checksums at the end.

use super::error::WriteError;
use super::part::{DIRECTORY_TAG, DfmPart, ENDING_MAGIC, PartLayout, PartList, VERSION};
use super::record::{DfmRecord, Put};
use crate::checksum::CRC_32;

/// A file that is being written.
pub(super) struct DfmWriter {
    layouts: &'static PartList,
    /// Elements of each part, without its header.
    parts: Vec<Vec<u8>>,
    /// Number of takes, since their elements differ in size.
    pub(super) takes: usize,
}

impl DfmWriter {
    pub(super) fn new(layouts: &'static PartList) -> Self {
        Self { layouts, parts: vec![Vec::new(); layouts.len()], takes: 0 }
    }

    /// Appends an element to `part`.
    pub(super) fn put<R: DfmRecord>(&mut self, part: DfmPart, record: &R) {
        record.put(&mut self.parts[part as usize]);
    }

    /// Appends elements to `part`.
    pub(super) fn put_all<R: DfmRecord>(&mut self, part: DfmPart, records: &[R]) {
        for record in records {
            self.put(part, record);
        }
    }

    /// Appends bytes to `part`, whose elements are bytes.
    pub(super) fn bytes(&mut self, part: DfmPart, bytes: &[u8]) {
        self.parts[part as usize].extend_from_slice(bytes);
    }

    /// Appends a text; texts are read in the order in which they were written.
    pub(super) fn text(&mut self, text: &str) {
        self.put(DfmPart::TextLengths, &(text.len() as u32));
        self.bytes(DfmPart::Text, text.as_bytes());
    }

    /// Returns the number of elements of `part` so far.
    pub(super) fn count(&self, part: DfmPart) -> usize {
        match part {
            DfmPart::Takes => self.takes,
            part => self.parts[part as usize].len() / self.layouts[part as usize].sizes[0],
        }
    }

    /// Returns the whole file, or an error above the 4 GiB that the first four bytes can represent.
    pub(super) fn finish(self) -> Result<Vec<u8>, WriteError> {
        let parts = self
            .layouts
            .iter()
            .map(|layout| (layout.part.header_bytes() + self.parts[layout.part as usize].len()) as u64);
        let bytes = 4 + parts.sum::<u64>() + 12 + 16 * (self.layouts.len() as u64 + 1);
        let total = total(bytes)?;
        let mut file = Vec::with_capacity(bytes as usize);
        // Overwritten at the end, as in the thesis.
        file.u32(0);
        let mut directory = Vec::new();
        for layout in self.layouts {
            let at = file.len();
            self.header(layout, &mut file);
            file.extend_from_slice(&self.parts[layout.part as usize]);
            directory.extend_from_slice(&layout.tag);
            directory.u32(at as u32);
            directory.u32((file.len() - at) as u32);
            directory.u32(CRC_32.checksum(&file[at..]));
        }
        ending(&mut file, &directory);
        debug_assert_eq!(file.len() as u64, bytes);
        file[..4].copy_from_slice(&total.to_le_bytes());
        Ok(file)
    }

    fn header(&self, layout: &PartLayout, file: &mut Vec<u8>) {
        let part = layout.part;
        if !part.is_of_thesis() {
            file.extend_from_slice(&layout.tag);
        }
        file.u32(self.count(part) as u32);
        // Takes have three sizes, all others one.
        let sizes = if part == DfmPart::Takes { &layout.sizes[..] } else { &layout.sizes[..1] };
        for size in sizes {
            file.u32(*size as u32);
        }
    }
}

/// Returns the first four bytes of a file of this length.
fn total(bytes: u64) -> Result<u32, WriteError> {
    u32::try_from(bytes).map_err(|_| WriteError::TooLarge { bytes })
}

/// Appends the directory of the parts, and the last 16 bytes.
fn ending(file: &mut Vec<u8>, entries: &[u8]) {
    let at = file.len();
    file.extend_from_slice(&DIRECTORY_TAG);
    file.u32((entries.len() / 16) as u32);
    file.u32(16);
    file.extend_from_slice(entries);
    file.u32(at as u32);
    file.extend_from_slice(&VERSION.0.to_le_bytes());
    file.extend_from_slice(&VERSION.1.to_le_bytes());
    let checksum = CRC_32.checksum(&file[at..]);
    file.u32(checksum);
    file.extend_from_slice(&ENDING_MAGIC);
}

#[cfg(test)]
mod tests {
    use super::total;
    use crate::format::dfm::WriteError;

    #[test]
    fn files_of_four_gibibytes_are_refused() {
        assert_eq!(total(u32::MAX.into()), Ok(u32::MAX));
        let error = total(1 << 32).unwrap_err();
        assert_eq!(error, WriteError::TooLarge { bytes: 1 << 32 });
        assert_eq!(error.to_string(), "file: 4294967296 bytes, at most 4294967295");
    }
}
