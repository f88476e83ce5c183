//! Reads elements from the parts, one after the other, each with its place in the file.

use super::code::{DFM_COUNT, DFM_TEXT, DFM_VALUE};
use super::container::{FoundPart, open};
use super::error::invalid;
use super::part::{DfmPart, PartLayout, PartList};
use super::record::{DfmRecord, RecordFields};
use crate::format::ImportContext;
use crate::format::{ImportError, Place};

/// A file whose parts were found.
pub(super) struct DfmReader<'a, 'g> {
    layouts: &'static PartList,
    parts: Vec<Stream<'a>>,
    pub(super) context: &'g ImportContext<'g>,
    /// Whether to accept only what an importer guarantees: finite numbers, increasing key times, values within the
    /// limits.
    pub(super) strict: bool,
    /// Offset of the last element that was read.
    last: usize,
}

/// The remaining elements of a part.
struct Stream<'a> {
    count: u32,
    sizes: [usize; 3],
    /// Offset of `rest` in the file.
    at: usize,
    rest: &'a [u8],
}

impl<'a, 'g> DfmReader<'a, 'g> {
    /// Finds the parts and verifies their checksums.
    pub(super) fn new(
        layouts: &'static PartList,
        bytes: &'a [u8],
        context: &'g ImportContext<'g>,
        strict: bool,
    ) -> Result<Self, ImportError> {
        let found = open(layouts, bytes, context)?;
        let stream = |(found, layout): (FoundPart<'a>, &PartLayout)| Stream {
            count: found.count,
            sizes: found.sizes,
            at: found.at + layout.part.header_bytes(),
            rest: found.bytes,
        };
        let parts = found.into_iter().zip(layouts).map(stream).collect();
        Ok(Self { layouts, parts, context, strict, last: 0 })
    }

    /// Returns the number of elements in the header of `part`.
    pub(super) fn count(&self, part: DfmPart) -> usize {
        self.parts[part as usize].count as usize
    }

    /// Returns the number of elements of `part` that were not read yet.
    pub(super) fn left(&self, part: DfmPart) -> usize {
        let stream = &self.parts[part as usize];
        stream.rest.len() / stream.sizes[0].max(1)
    }

    /// Reads the next element of `part`.
    pub(super) fn get<R: DfmRecord>(&mut self, part: DfmPart) -> Result<R, ImportError> {
        self.get_sized(part, 0)
    }

    /// Reads the next element of `part`, of the size number `kind`: takes, tracks and key-frames are one part.
    pub(super) fn get_sized<R: DfmRecord>(&mut self, part: DfmPart, kind: usize) -> Result<R, ImportError> {
        self.context.work(1)?;
        let stream = &mut self.parts[part as usize];
        let Some((element, rest)) = stream.rest.split_at_checked(stream.sizes[kind]) else {
            return Err(ends(&self.layouts[part as usize], stream.at));
        };
        self.last = stream.at;
        stream.at += element.len();
        stream.rest = rest;
        let mut fields = RecordFields::new(element);
        let record = R::get(&mut fields).map_err(|reason| self.wrong(DFM_VALUE, reason))?;
        if self.strict && !fields.finite {
            let reason = format!("{}: a number is NaN or infinite", self.layouts[part as usize].name);
            return Err(self.wrong(DFM_VALUE, reason));
        }
        Ok(record)
    }

    /// Reads the next `count` elements of `part`.
    pub(super) fn list<R: DfmRecord>(&mut self, part: DfmPart, count: usize) -> Result<Vec<R>, ImportError> {
        let mut list = self.vec(part, 0, count)?;
        for _ in 0..count {
            list.push(self.get(part)?);
        }
        Ok(list)
    }

    /// Returns a vector with capacity for `count` values, one per element of `part`; an error if fewer elements are
    /// left.
    pub(super) fn vec<T>(&self, part: DfmPart, kind: usize, count: usize) -> Result<Vec<T>, ImportError> {
        let stream = &self.parts[part as usize];
        if count > stream.rest.len() / stream.sizes[kind].max(1) {
            return Err(ends(&self.layouts[part as usize], stream.at));
        }
        self.context.vec(&self.place(), count)
    }

    /// Reads the next `count` bytes of `part`, whose elements are bytes.
    pub(super) fn bytes(&mut self, part: DfmPart, count: usize) -> Result<&'a [u8], ImportError> {
        let stream = &mut self.parts[part as usize];
        // In a newer version the elements could be larger than a byte; such a file cannot be read.
        let taken = stream.rest.split_at_checked(count).filter(|_| stream.sizes[0] == 1);
        let Some((bytes, rest)) = taken else { return Err(ends(&self.layouts[part as usize], stream.at)) };
        self.last = stream.at;
        stream.at += count;
        stream.rest = rest;
        self.context.charge(&self.place(), count as u64)?;
        Ok(bytes)
    }

    /// Reads the next text.
    pub(super) fn text(&mut self) -> Result<String, ImportError> {
        let length = self.get::<u32>(DfmPart::TextLengths)? as usize;
        let bytes = self.bytes(DfmPart::Text, length)?;
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(text.to_owned()),
            Err(error) => {
                let at = self.last + error.valid_up_to();
                Err(invalid(at, DFM_TEXT, "a name is not UTF-8".to_owned()))
            }
        }
    }

    /// Returns the place of the last element that was read.
    pub(super) fn place(&self) -> Place {
        Place::Byte(self.last as u64)
    }

    /// Returns an error in the last element that was read.
    pub(super) fn wrong(&self, code: &'static str, reason: String) -> ImportError {
        invalid(self.last, code, reason)
    }

    /// Refuses a count above a limit, when reading as an importer.
    pub(super) fn limit(
        &self,
        what: &'static str,
        size: impl TryInto<u64>,
        limit: impl TryInto<u64>,
    ) -> Result<(), ImportError> {
        let (size, limit) = (size.try_into().unwrap_or(u64::MAX), limit.try_into().unwrap_or(u64::MAX));
        if !self.strict || size <= limit {
            return Ok(());
        }
        Err(ImportError::TooLarge { place: self.place(), what, size, limit })
    }

    /// Checks that every element of every part was read.
    pub(super) fn finish(self) -> Result<(), ImportError> {
        for (stream, layout) in self.parts.iter().zip(self.layouts) {
            if !stream.rest.is_empty() {
                let reason = format!("there are more {} than the file uses, from here on", layout.name);
                return Err(invalid(stream.at, DFM_COUNT, reason));
            }
        }
        Ok(())
    }
}

fn ends(layout: &PartLayout, at: usize) -> ImportError {
    invalid(at, DFM_COUNT, format!("there are no more {}, but the file needs more", layout.name))
}
