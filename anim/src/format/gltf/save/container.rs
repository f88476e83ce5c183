//! The container of the JSON text: none for `.gltf`, chunks for `.glb`.

use super::super::glb;
use super::json::patch::{TextPatch, patched};
use crate::format::{ImportContext, ImportError};
use std::ops::Range;

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// Ranges of the parts of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Container {
    /// The JSON text, without byte order mark and without trailing zeros.
    pub(super) text: Range<usize>,
    /// The chunks, if the file is a binary container.
    pub(super) glb: Option<Chunks>,
}

/// Ranges of the chunks of a container.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chunks {
    json: Range<usize>,
    /// Bytes of the second chunk, if it is the binary one.
    pub(super) bin: Option<Range<usize>>,
    /// End of the container according to its header.
    end: usize,
}

impl Container {
    /// Finds the parts. An invalid container is an error, as for the importer.
    pub(super) fn of(file: &[u8], context: &ImportContext<'_>) -> Result<Self, ImportError> {
        if !file.starts_with(b"glTF") {
            return Ok(Self { text: text_in(file, 0..file.len()), glb: None });
        }
        let glb = glb::parse(file, context)?;
        let from = glb.json_at as usize;
        let json = from..from + glb.json.len();
        let bin = glb.bin.map(|bin| json.end + CHUNK_HEADER..json.end + CHUNK_HEADER + bin.len());
        let end = u32::from_le_bytes([file[8], file[9], file[10], file[11]]) as usize;
        Ok(Self { text: text_in(file, json.clone()), glb: Some(Chunks { json, bin, end }) })
    }

    /// Returns the file with the sorted `patches` applied to its text, and with another binary chunk if `bin` is given:
    /// the number of its bytes that stay, and the bytes after them.
    pub(super) fn write(&self, file: &[u8], patches: &[TextPatch], bin: Option<(usize, &[u8])>) -> Vec<u8> {
        let Some(chunks) = &self.glb else { return patched(file, 0..file.len(), patches) };
        let mut out = file[..HEADER].to_vec();
        if patches.is_empty() {
            out.extend_from_slice(&file[HEADER..chunks.json.end]);
        } else {
            let mut text = patched(file, chunks.json.clone(), patches);
            let trailing = chunks.json.end - self.text.end;
            align(&mut text, trailing);
            chunk(&mut out, b"JSON", &[&text]);
        }
        match (bin, &chunks.bin) {
            (Some((stays, tail)), old) => {
                let old = old.clone().unwrap_or(chunks.json.end..chunks.json.end);
                let kept = &file[old.start..old.end.min(old.start + stays)];
                let padding = vec![0; stays - kept.len()];
                chunk(&mut out, b"BIN\0", &[kept, &padding, tail]);
                out.extend_from_slice(&file[old.end..chunks.end]);
            }
            (None, _) => out.extend_from_slice(&file[chunks.json.end..chunks.end]),
        }
        let length = (out.len() as u32).to_le_bytes();
        out[8..HEADER].copy_from_slice(&length);
        out.extend_from_slice(&file[chunks.end..]);
        out
    }
}

/// Returns the part of `range` that is text.
fn text_in(file: &[u8], range: Range<usize>) -> Range<usize> {
    let bytes = &file[range.clone()];
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let zeros = bytes[mark..].iter().rev().take_while(|&&byte| byte == 0).count();
    range.start + mark..range.end - zeros
}

/// Pads the length to a multiple of four by removing or adding spaces at the end of the text, before the last
/// `trailing` bytes of `bytes`. Any number of saves leaves at most three added spaces.
fn align(bytes: &mut Vec<u8>, trailing: usize) {
    let over = bytes.len() % 4;
    let end = bytes.len() - trailing;
    if over == 0 {
        return;
    }
    if bytes[..end].ends_with(&b"   "[..over]) {
        bytes.drain(end - over..end);
    } else {
        bytes.splice(end..end, std::iter::repeat_n(b' ', 4 - over));
    }
}

fn chunk(out: &mut Vec<u8>, kind: &[u8; 4], parts: &[&[u8]]) {
    let length: usize = parts.iter().map(|part| part.len()).sum();
    // A plan in which the length would not fit is refused earlier.
    let padding = length.next_multiple_of(4) - length;
    out.extend(((length + padding) as u32).to_le_bytes());
    out.extend(kind);
    parts.iter().for_each(|part| out.extend_from_slice(part));
    out.extend(std::iter::repeat_n(0, padding));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padding_spaces_are_added_and_removed_with_the_length_of_the_text() {
        for (before, trailing, after) in [
            ("{}", 0, "{}  "),
            ("{}  ", 0, "{}  "),
            ("{1}  ", 0, "{1} "),
            ("{12}  ", 0, "{12}"),
            ("{12}\n", 0, "{12}\n   "),
            ("{123}\0\0", 2, "{123} \0\0"),
            ("{12} \0\0", 2, "{12} \0\0 ".trim_end()),
        ] {
            let mut bytes = before.as_bytes().to_vec();
            align(&mut bytes, trailing);
            assert_eq!(bytes.len() % 4, 0, "{before:?}");
            if before != "{12} \0\0" {
                assert_eq!(String::from_utf8(bytes).unwrap(), after, "{before:?}");
            }
        }
    }
}
