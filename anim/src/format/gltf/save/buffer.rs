//! The buffer that new numbers are appended to.

use super::document::Document;
use super::json::patch::Patch;
use super::json::token::{unquoted, written_at};
use super::reuse::is_ours;
use super::source::is_data;
use crate::format::uri::{DataUri, relative_path};
use base64::prelude::{BASE64_STANDARD, Engine};
use percent_encoding::{NON_ALPHANUMERIC, percent_encode};
use std::collections::HashSet;

/// Where the bytes of a buffer are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Home {
    /// In the binary chunk; it may have to be made.
    Chunk,
    /// In a data URI that is there.
    DataUri,
    /// In a file beside this one that an earlier save wrote. It is not overwritten: the next save writes another.
    OurFile,
    /// In a file beside this one that is to be written.
    NewFile,
    /// In a data URI that is to be written.
    NewDataUri,
}

/// The buffer that new numbers go to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) home: Home,
    /// Its number, which may be that of a new one.
    pub(super) index: usize,
    /// Bytes that are there.
    pub(super) present: usize,
}

impl Target {
    /// The binary chunk where there can be one; else what an earlier save wrote; else a data URI; else, where the
    /// file has buffers beside it, a new one of those; else a new data URI.
    pub(super) fn choose(document: &Document<'_>) -> Self {
        let json = document.json;
        let uri = |index: usize| json.string_member(document.buffers[index], "uri");
        let count = document.buffers.len();
        let present = |index| document.buffer(index).map_or(0, <[u8]>::len);
        if let Some(chunks) = &document.source.container.glb {
            let bin = chunks.bin.as_ref();
            if count == 0 || (bin.is_some() && json.member(document.buffers[0], "uri").is_none()) {
                return Self { home: Home::Chunk, index: 0, present: bin.map_or(0, |bin| bin.len()) };
            }
        }
        let ours = (0..count).find(|&index| {
            is_ours(json, document.buffers[index])
                && uri(index).is_some_and(|uri| !is_data(&uri))
                && document.buffer(index).is_some()
        });
        if let Some(index) = ours {
            return Self { home: Home::OurFile, index, present: present(index) };
        }
        let data =
            |index: &usize| uri(*index).is_some_and(|uri| is_data(&uri)) && document.buffer(*index).is_some();
        if let Some(index) = (0..count).find(data) {
            return Self { home: Home::DataUri, index, present: present(index) };
        }
        let beside = (0..count).any(|index| uri(index).is_some_and(|uri| !is_data(&uri)));
        Self { home: if beside { Home::NewFile } else { Home::NewDataUri }, index: count, present: 0 }
    }

    /// Is the buffer no element of `/buffers` yet?
    pub(super) fn is_new(&self, document: &Document<'_>) -> bool {
        self.index >= document.buffers.len()
    }

    /// The bytes that are there.
    pub(super) fn bytes<'d>(&self, document: &'d Document<'_>) -> &'d [u8] {
        if let (Home::Chunk, true) = (self.home, self.is_new(document)) {
            let bin = document.source.container.glb.as_ref().and_then(|chunks| chunks.bin.clone());
            return bin.and_then(|bin| document.source.bytes.get(bin)).unwrap_or_default();
        }
        document.buffer(self.index).unwrap_or_default()
    }
}

/// The end of a buffer, exchanged: everything from byte `from` on.
#[derive(Clone, Debug, Default)]
pub(super) struct Tail {
    pub(super) from: usize,
    pub(super) bytes: Vec<u8>,
}

impl Tail {
    /// A buffer of `old` bytes, made `end` bytes long, with `writes` over it: where, and what.
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

/// The patch that puts a tail into the data URI that is the string `uri` of the text.
pub(super) fn data_uri_patch(
    document: &Document<'_>,
    uri: usize,
    old: &[u8],
    tail: &Tail,
    pointer: &str,
) -> Patch {
    let token = document.json.token(uri);
    let span = document.json.span(uri);
    let said = unquoted(token);
    let body = said.find(',').map_or(said.len(), |comma| comma + 1);
    let is_base64 = DataUri::parse(&said).is_some_and(|data| data.is_ok_and(|data| data.is_base64()));
    let (from, text) = if is_base64 {
        let whole = tail.from / 3 * 3;
        let bytes = [&old[whole..tail.from], &tail.bytes].concat();
        (body + whole / 3 * 4, base64(&bytes))
    } else {
        (body + written_bytes(&said.as_bytes()[body..], tail.from), percent(&tail.bytes))
    };
    Patch::new(span.start + written_at(token, from)..span.end - 1, text, pointer)
}

/// Bytes of a percent-encoded text that write its first `count` bytes.
fn written_bytes(text: &[u8], count: usize) -> usize {
    let mut at = 0;
    for _ in 0..count {
        at += if text.get(at) == Some(&b'%') { 3 } else { 1 };
    }
    at.min(text.len())
}

/// Base64 (RFC 4648 §4) with padding.
pub(super) fn base64(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// Every byte as `%41`, letters and digits as they are.
fn percent(bytes: &[u8]) -> String {
    percent_encode(bytes, NON_ALPHANUMERIC).to_string()
}

/// A name for a new buffer beside the file called `name`, after its content: what is there under it is the same.
///
/// `taken` are paths that the file names already.
pub(super) fn beside(name: &str, content: &[u8], taken: &HashSet<String>) -> String {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    // Only what any system and any URI takes, and not too much of it.
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    let stem: String = stem.chars().map(|c| if plain(c) { c } else { '_' }).take(100).collect();
    let stem =
        if relative_path(&format!("{stem}.bin")).is_ok() && !stem.is_empty() { &stem } else { "model" };
    let hash = fingerprint(content);
    let mut names = (0_u32..).map(|number| match number {
        0 => format!("{stem}.dragonfly-{hash:016x}.bin"),
        _ => format!("{stem}.dragonfly-{hash:016x}-{number}.bin"),
    });
    names.find(|name| !taken.contains(name)).expect("the file does not name so many")
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
fn fingerprint(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_reads_back_as_it_was() {
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
    fn a_file_beside_gets_a_name_that_any_system_takes() {
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
