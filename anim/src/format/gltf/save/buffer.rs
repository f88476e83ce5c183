//! The buffer that new numbers are appended to.

use super::document::SourceDocument;
use super::json::patch::TextPatch;
use super::json::token::{unquoted, written_at};
use super::mark::is_ours;
use super::source::is_data;
use crate::format::uri::{DataUri, relative_path};
use base64::prelude::{BASE64_STANDARD, Engine};
use percent_encoding::{NON_ALPHANUMERIC, percent_encode};
use std::collections::HashSet;

/// Storage of a buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum BufferHome {
    /// The binary chunk, which is created if needed.
    Chunk,
    /// An existing data URI.
    DataUri,
    /// A referenced file that an earlier save wrote. It is not overwritten: the next save writes another one.
    OurFile,
    /// A referenced file to be written.
    NewFile,
    /// A data URI to be written.
    NewDataUri,
}

/// The buffer that new numbers are appended to.
#[derive(Clone, Copy, Debug)]
pub(super) struct TargetBuffer {
    pub(super) home: BufferHome,
    /// Number of the buffer, which may be that of a new one.
    pub(super) index: usize,
    /// Number of existing bytes.
    pub(super) present: usize,
}

impl TargetBuffer {
    /// Chooses the binary chunk where there can be one; otherwise the file that an earlier save wrote; otherwise a data
    /// URI; otherwise, if the document has buffers in referenced files, a new file; otherwise a new data URI.
    pub(super) fn choose(document: &SourceDocument<'_>) -> Self {
        let json = document.json;
        let uri = |index: usize| json.string_member(document.buffers[index], "uri");
        let count = document.buffers.len();
        let present = |index| document.buffer(index).map_or(0, <[u8]>::len);
        if let Some(chunks) = &document.source.container.glb {
            let bin = chunks.bin.as_ref();
            let is_chunk = |buffer| json.member(buffer, "uri").is_none() && !document.is_fallback(buffer);
            if count == 0 || (bin.is_some() && is_chunk(document.buffers[0])) {
                return Self { home: BufferHome::Chunk, index: 0, present: bin.map_or(0, |bin| bin.len()) };
            }
        }
        let ours = (0..count).find(|&index| {
            is_ours(json, document.buffers[index])
                && uri(index).is_some_and(|uri| !is_data(&uri))
                && document.buffer(index).is_some()
        });
        if let Some(index) = ours {
            return Self { home: BufferHome::OurFile, index, present: present(index) };
        }
        let data = |index: &usize| {
            uri(*index).is_some_and(|uri| is_data(&uri))
                && document.buffer(*index).is_some()
                && !document.is_fallback(document.buffers[*index])
        };
        if let Some(index) = (0..count).find(data) {
            return Self { home: BufferHome::DataUri, index, present: present(index) };
        }
        let beside = (0..count).any(|index| uri(index).is_some_and(|uri| !is_data(&uri)));
        Self {
            home: if beside { BufferHome::NewFile } else { BufferHome::NewDataUri },
            index: count,
            present: 0,
        }
    }

    /// Returns whether the buffer is not yet an element of `/buffers`.
    pub(super) fn is_new(&self, document: &SourceDocument<'_>) -> bool {
        self.index >= document.buffers.len()
    }

    /// Returns the existing bytes.
    pub(super) fn bytes<'d>(&self, document: &'d SourceDocument<'_>) -> &'d [u8] {
        if let (BufferHome::Chunk, true) = (self.home, self.is_new(document)) {
            let bin = document.source.container.glb.as_ref().and_then(|chunks| chunks.bin.clone());
            return bin.and_then(|bin| document.source.bytes.get(bin)).unwrap_or_default();
        }
        document.buffer(self.index).unwrap_or_default()
    }
}

/// The replaced end of a buffer: everything from byte `from` on.
#[derive(Clone, Debug, Default)]
pub(super) struct BufferTail {
    pub(super) from: usize,
    pub(super) bytes: Vec<u8>,
}

impl BufferTail {
    /// Returns the tail of a buffer of `old` bytes that is resized to `end` bytes and then overwritten by `writes`
    /// (offset and bytes).
    pub(super) fn of(old: &[u8], writes: &[(usize, Vec<u8>)], end: usize) -> Self {
        let from = writes.iter().map(|write| write.0).min().unwrap_or(end).min(old.len()).min(end);
        let mut bytes = old[from..old.len().min(end)].to_vec();
        bytes.resize(end - from, 0);
        for (at, write) in writes {
            bytes[at - from..][..write.len()].copy_from_slice(write);
        }
        Self { from, bytes }
    }
}

/// Returns the patch that replaces the end of a data URI; `uri` is its string in the text.
pub(super) fn data_uri_patch(
    document: &SourceDocument<'_>,
    uri: usize,
    old: &[u8],
    tail: &BufferTail,
    pointer: &str,
) -> TextPatch {
    let token = document.json.token(uri);
    let span = document.json.span(uri);
    let text = unquoted(token);
    let body = text.find(',').map_or(text.len(), |comma| comma + 1);
    let is_base64 = DataUri::parse(&text).is_some_and(|data| data.is_ok_and(|data| data.is_base64()));
    let (from, new) = if is_base64 {
        let whole = tail.from / 3 * 3;
        let bytes = [&old[whole..tail.from], &tail.bytes].concat();
        (body + whole / 3 * 4, base64(&bytes))
    } else {
        (body + written_bytes(&text.as_bytes()[body..], tail.from), percent(&tail.bytes))
    };
    TextPatch::new(span.start + written_at(token, from)..span.end - 1, new, pointer)
}

/// Returns the length of the percent-encoded text of the first `count` bytes.
fn written_bytes(text: &[u8], count: usize) -> usize {
    let mut at = 0;
    for _ in 0..count {
        at += if text.get(at) == Some(&b'%') { 3 } else { 1 };
    }
    at.min(text.len())
}

/// Encodes as base64 (RFC 4648 §4) with padding.
pub(super) fn base64(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// Percent-encodes every byte except letters and digits.
fn percent(bytes: &[u8]) -> String {
    percent_encode(bytes, NON_ALPHANUMERIC).to_string()
}

/// Returns a name for a new buffer next to the file called `name`. The name contains a hash of the content, so that an
/// existing file of this name has the same content.
///
/// `taken` contains the paths that the file refers to.
pub(super) fn beside(name: &str, content: &[u8], taken: &HashSet<String>) -> String {
    let (stem, hash) = (plain_stem(name), fingerprint(content));
    let mut names = (0_u32..).map(|number| named(&stem, hash, number));
    names.find(|name| !taken.contains(name)).expect("the file refers to a finite number of names")
}

/// Returns the name of a model file without folder and extension, with only characters that every system and every URI accepts, and
/// not too many.
fn plain_stem(model: &str) -> String {
    let file = model.rsplit(['/', '\\']).next().unwrap_or(model);
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    let stem: String = stem.chars().map(|c| if plain(c) { c } else { '_' }).take(100).collect();
    if relative_path(&format!("{stem}.bin")).is_ok() && !stem.is_empty() { stem } else { "model".to_owned() }
}

fn named(stem: &str, hash: u64, number: u32) -> String {
    match number {
        0 => format!("{stem}.dragonfly-{hash:016x}.bin"),
        _ => format!("{stem}.dragonfly-{hash:016x}-{number}.bin"),
    }
}

/// Returns the hash in the name of a buffer file, if a save of the model file called `model` may have given it that name: the hash of its
/// content (FNV-1a, 64 bits).
pub fn buffer_of_save(name: &str, model: &str) -> Option<u64> {
    let rest = name.strip_suffix(".bin")?;
    let (_, numbered) = rest.rsplit_once(".dragonfly-")?;
    let (hash, number) = match numbered.split_once('-') {
        Some((hash, number)) => (hash, Some(number.parse::<u32>().ok()?)),
        None => (numbered, None),
    };
    let hash = u64::from_str_radix(hash, 16).ok()?;
    // Compared as a whole, so that no other spelling of the number counts.
    (name == named(&plain_stem(model), hash, number.unwrap_or(0))).then_some(hash)
}

/// Computes FNV-1a, 64 bits (Fowler, Noll and Vo).
fn fingerprint(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_a_save_of_the_model_gives_are_those_of_its_buffers() {
        let taken = HashSet::from([beside("a b.gltf", b"abc", &HashSet::new())]);
        for name in [beside("a b.gltf", b"abc", &HashSet::new()), beside("a b.gltf", b"abc", &taken)] {
            assert_eq!(buffer_of_save(&name, "a b.gltf"), Some(fingerprint(b"abc")), "{name}");
            assert_eq!(buffer_of_save(&name, "a c.gltf"), None, "{name}");
        }
        for name in [
            "a_b.bin",
            "a_b.dragonfly-1.bin",
            "a_b.dragonfly-0000000000000abC.bin",
            "a_b.dragonfly-0123456789abcdef-01.bin",
        ] {
            assert_eq!(buffer_of_save(name, "a b.gltf"), None, "{name}");
        }
    }

    #[test]
    fn encoded_base64_decodes_to_the_same_bytes() {
        let all: Vec<u8> = (0..=255).collect();
        for length in [0, 1, 2, 3, 4, 5, 255, 256] {
            let uri = format!("data:;base64,{}", base64(&all[..length]));
            let mut bytes = Vec::new();
            DataUri::parse(&uri).unwrap().unwrap().decode(&mut bytes).unwrap();
            assert_eq!(bytes, all[..length]);
            let uri = format!("data:,{}", percent(&all[..length]));
            bytes.clear();
            DataUri::parse(&uri).unwrap().unwrap().decode(&mut bytes).unwrap();
            assert_eq!(bytes, all[..length]);
        }
    }

    #[test]
    fn the_name_of_a_new_buffer_file_is_valid_on_every_system() {
        let taken = HashSet::new();
        for (name, stem) in [
            ("a/Fox 2.gltf", "Fox_2"),
            ("NUL.gltf", "model"),
            (".gltf", "model"),
            ("x", "x"),
            ("ö%.gltf", "__"),
        ] {
            let file = beside(name, b"abc", &taken);
            assert_eq!(file, format!("{stem}.dragonfly-{:016x}.bin", fingerprint(b"abc")));
        }
    }
}
