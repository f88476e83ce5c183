//! Collects the patches of a save: lists that grow or are created, and the buffer of the new numbers.

use super::buffer::{BufferHome, BufferTail, TargetBuffer, base64, beside, data_uri_patch};
use super::changes::{ChangedToken, Changes, shortened};
use super::document::SourceDocument;
use super::error::SaveError;
use super::json::list::{ListEdit, edit};
use super::json::patch::{TextPatch, sort};
use super::json::style::{Fresh, JsonSpot, JsonStyle};
use super::json::token::quoted;
use super::json::tree::{JsonKind, ValueId};
use super::mark::MARK;
use super::planned::Plan;
use crate::format::OutputFile;
use crate::format::uri::relative_path;
use crate::limits::FILE_BYTES;
use std::collections::{HashMap, HashSet};

/// A plan that is being made.
pub(super) struct Draw<'d, 'a> {
    pub(super) document: &'d SourceDocument<'a>,
    pub(super) style: JsonStyle,
    pub(super) patches: Vec<TextPatch>,
    /// Added and removed members of the root.
    pub(super) root: ListEdit,
    pub(super) changes: Changes,
    chunk: Option<BufferTail>,
    beside: Option<OutputFile>,
    /// Positions of new elements of a list of the root, by the name of the list.
    spots: HashMap<&'static str, JsonSpot>,
}

impl<'d, 'a> Draw<'d, 'a> {
    pub(super) fn new(document: &'d SourceDocument<'a>) -> Self {
        Self {
            document,
            style: JsonStyle::of(document.json),
            patches: Vec::new(),
            root: ListEdit::default(),
            changes: Changes::default(),
            chunk: None,
            beside: None,
            spots: HashMap::new(),
        }
    }

    fn spot(&mut self, list: &'static str) -> JsonSpot {
        let (document, style) = (self.document, &self.style);
        let spot = || style.spot(document.json, document.json.member(0, list), 2);
        self.spots.entry(list).or_insert_with(spot).clone()
    }

    /// Returns the array that is the member `name` of the root, if there is such a member.
    pub(super) fn list(&self, name: &str) -> Result<Option<ValueId>, SaveError> {
        let json = self.document.json;
        match json.member(0, name) {
            Some(list) if json.kind(list) == JsonKind::Array => Ok(Some(list)),
            None => Ok(None),
            Some(_) => Err(SaveError::File { place: format!("/{name}"), reason: "is not a list".to_owned() }),
        }
    }

    /// Appends `count` elements to a list of the root, which is created if needed.
    pub(super) fn append<'f>(
        &mut self,
        name: &'static str,
        count: usize,
        item: impl Fn(usize) -> Fresh<'f> + 'f,
    ) -> Result<(), SaveError> {
        if count == 0 {
            return Ok(());
        }
        let json = self.document.json;
        let Some(list) = self.list(name)? else {
            self.new_list(name, count, item);
            return Ok(());
        };
        let spot = self.spot(name);
        let last = json.items(list).last();
        let inserted = (0..count).map(|number| (last, self.style.write(&item(number), &spot))).collect();
        let change = ListEdit { removed: Vec::new(), inserted };
        self.patches.extend(edit(json, list, &change, &self.style, &spot, &format!("/{name}")));
        Ok(())
    }

    /// Adds a list of `count` elements to the root.
    pub(super) fn new_list<'f>(
        &mut self,
        name: &'static str,
        count: usize,
        item: impl Fn(usize) -> Fresh<'f> + 'f,
    ) {
        let json = self.document.json;
        let spot = self.style.spot(json, Some(0), 1).with_lines(&self.style);
        let last = json.items(0).filter(|item| !self.root.removed.contains(item)).last();
        self.root.inserted.push((last, self.style.member(name, &Fresh::Items(count, Box::new(item)), &spot)));
    }

    /// Replaces an element by `fresh`, unless it has this text already.
    pub(super) fn replace(&mut self, id: ValueId, list: &'static str, number: usize, fresh: &Fresh<'_>) {
        let json = self.document.json;
        let spot = self.spot(list);
        let text = self.style.write(fresh, &spot);
        if text.as_bytes() != json.token(id) {
            self.patches.push(TextPatch::new(json.span(id), text, format!("/{list}/{number}")));
        }
    }

    /// Writes `writes` over the buffer, which is `end` bytes long afterwards.
    pub(super) fn buffer(
        &mut self,
        target: TargetBuffer,
        writes: &[(usize, Vec<u8>)],
        end: usize,
    ) -> Result<(), SaveError> {
        let document = self.document;
        let old = target.bytes(document);
        if writes.is_empty() && end == old.len() {
            return Ok(());
        }
        let tail = BufferTail::of(old, writes, end);
        self.changes.bytes_appended = end.saturating_sub(old.len());
        self.changes.bytes_removed = old.len().saturating_sub(end);
        let within = |write: &(usize, Vec<u8>)| write.1.len().min(old.len().saturating_sub(write.0));
        self.changes.bytes_reused = writes.iter().map(within).sum();
        let mut members = vec![("name", quoted(MARK)), ("byteLength", end.to_string())];
        let uri = match target.home {
            BufferHome::Chunk => None,
            BufferHome::DataUri => None,
            BufferHome::NewDataUri => {
                Some(format!("data:application/octet-stream;base64,{}", base64(&tail.bytes)))
            }
            BufferHome::OurFile | BufferHome::NewFile => Some(self.neighbor_file(target, old, &tail)),
        };
        if target.is_new(document) {
            members.extend(uri.map(|uri| ("uri", quoted(&uri))));
            self.append("buffers", 1, move |_| {
                let member = |(name, token): &(&'static str, String)| (*name, Fresh::Raw(token.clone()));
                Fresh::Object(members.iter().map(member).collect())
            })?;
        } else {
            self.adjust(target, end, old, &tail, uri)?;
        }
        if target.home == BufferHome::Chunk {
            self.chunk = Some(tail);
        }
        Ok(())
    }

    /// Patches the length, and the URI, of an existing buffer.
    fn adjust(
        &mut self,
        target: TargetBuffer,
        end: usize,
        old: &[u8],
        tail: &BufferTail,
        uri: Option<String>,
    ) -> Result<(), SaveError> {
        let json = self.document.json;
        let buffer = self.document.buffers[target.index];
        let pointer = |name: &str| format!("/buffers/{}/{name}", target.index);
        let member = |name: &str| {
            json.member(buffer, name)
                .ok_or_else(|| SaveError::File { place: pointer(name), reason: "is missing".to_owned() })
        };
        let length = member("byteLength")?;
        if json.whole(length) != Some(end as u64) {
            self.patches.push(TextPatch::new(json.span(length), end.to_string(), pointer("byteLength")));
        }
        if target.home == BufferHome::DataUri {
            self.patches.push(data_uri_patch(self.document, member("uri")?, old, tail, &pointer("uri")));
        }
        if let Some(uri) = uri {
            self.patches.push(TextPatch::new(json.span(member("uri")?), quoted(&uri), pointer("uri")));
        }
        Ok(())
    }

    /// Plans a buffer in a new file and returns its URI.
    fn neighbor_file(&mut self, target: TargetBuffer, old: &[u8], tail: &BufferTail) -> String {
        let json = self.document.json;
        let uri = |id: &ValueId| relative_path(&json.string_member(*id, "uri")?).ok();
        let taken: HashSet<String> =
            self.document.buffers.iter().chain(&json.list(0, "images")).filter_map(uri).collect();
        let bytes = [&old[..tail.from], &tail.bytes].concat();
        let before = self.document.buffers.get(target.index).and_then(uri);
        let mut others = taken;
        if let Some(before) = &before {
            others.remove(before);
        }
        let name = beside(&self.document.source.name, &bytes, &others);
        self.changes.files_left.extend(before.filter(|before| *before != name));
        self.beside = Some(OutputFile { name: name.clone(), bytes });
        name
    }

    /// Returns the plan, or an error if its patches overlap or the file becomes too large.
    pub(super) fn finish(mut self) -> Result<Plan<'a>, SaveError> {
        let document = self.document;
        let json = document.json;
        let spot = self.style.spot(json, Some(0), 1);
        self.patches.extend(edit(json, 0, &self.root, &self.style, &spot, ""));
        self.patches.retain(|patch| !(patch.span.is_empty() && patch.text.is_empty()));
        if !sort(&mut self.patches) {
            let reason = "two edits of this save would change the same bytes".to_owned();
            return Err(SaveError::File { place: "file".to_owned(), reason });
        }
        self.check_size()?;
        let token = |patch: &TextPatch| ChangedToken {
            pointer: patch.pointer.clone(),
            offset: patch.span.start,
            length: patch.span.len(),
            old: shortened(&String::from_utf8_lossy(&json.file[patch.span.clone()])),
            new: shortened(&patch.text),
            new_length: patch.text.len(),
        };
        self.changes.tokens = self.patches.iter().map(token).collect();
        if !self.changes.is_empty() {
            self.changes.files.extend(self.beside.iter().map(|file| file.name.clone()));
            self.changes.files.push(document.source.name.clone());
        }
        Ok(Plan {
            source: document.source,
            patches: self.patches,
            chunk: self.chunk,
            beside: self.beside,
            changes: self.changes,
        })
    }

    fn check_size(&self) -> Result<(), SaveError> {
        let old = document_size(self.document);
        let gone: u64 = self.patches.iter().map(|patch| patch.span.len() as u64).sum();
        let come: u64 = self.patches.iter().map(|patch| patch.text.len() as u64).sum();
        let chunk = self.chunk.as_ref().map_or(0, |tail| tail.bytes.len() as u64 + 16);
        check_size(old - gone + come + chunk)
    }
}

fn document_size(document: &SourceDocument<'_>) -> u64 {
    document.source.bytes.len() as u64
}

/// Refuses a file that would be too large to be opened again. A container could be twice as large.
fn check_size(bytes: u64) -> Result<(), SaveError> {
    if bytes > FILE_BYTES { Err(SaveError::TooLarge { bytes, limit: FILE_BYTES }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_too_large_to_be_opened_again_is_refused() {
        assert_eq!(check_size(FILE_BYTES), Ok(()));
        for bytes in [FILE_BYTES + 1, u64::from(u32::MAX) + 1, u64::MAX] {
            assert_eq!(check_size(bytes), Err(SaveError::TooLarge { bytes, limit: FILE_BYTES }));
        }
    }
}
