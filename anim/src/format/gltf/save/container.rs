//! The frame around the JSON text: nothing for `.gltf`, chunks for `.glb`.

use super::super::glb;
use super::json::patch::{Patch, patched};
use crate::format::{ImportContext, ImportError};
use std::ops::Range;

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// Where the parts of a file lie.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Container {
    /// The JSON text, without byte order mark before and zeros behind.
    pub(super) text: Range<usize>,
    /// The chunks, where the file is a container.
    pub(super) glb: Option<Chunks>,
}

/// Where the chunks of a container lie.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chunks {
    json: Range<usize>,
    /// The second chunk's bytes, if it is the binary one.
    pub(super) bin: Option<Range<usize>>,
    /// The end that the header announces.
    end: usize,
}

impl Container {
    /// Finds the parts; what is wrong with the frame is an error, as in reading.
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

    /// The file with the sorted `patches` made in its text, and with another binary chunk if one is given: a length
    /// of its bytes that stay, and what follows them.
    pub(super) fn write(&self, file: &[u8], patches: &[Patch], bin: Option<(usize, &[u8])>) -> Vec<u8> {
        let Some(chunks) = &self.glb else { return patched(file, 0..file.len(), patches) };
        let mut out = file[..HEADER].to_vec();
        if patches.is_empty() {
            out.extend_from_slice(&file[HEADER..chunks.json.end]);
        } else {
            let mut text = patched(file, chunks.json.clone(), patches);
            let behind = chunks.json.end - self.text.end;
            align(&mut text, behind);
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

/// The part of `range` that is text.
fn text_in(file: &[u8], range: Range<usize>) -> Range<usize> {
    let bytes = &file[range.clone()];
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let zeros = bytes[mark..].iter().rev().take_while(|&&byte| byte == 0).count();
    range.start + mark..range.end - zeros
}

/// Brings the length to a multiple of four by taking or adding spaces at the end of the text, before the last
/// `behind` bytes of `bytes`. As many saves as one likes leave at most three of our spaces.
fn align(bytes: &mut Vec<u8>, behind: usize) {
    let over = bytes.len() % 4;
    let end = bytes.len() - behind;
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
    // A plan whose lengths do not fit is not made.
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
    fn spaces_come_and_go_with_the_length_of_the_text() {
        for (before, behind, after) in [
            ("{}", 0, "{}  "),
            ("{}  ", 0, "{}  "),
            ("{1}  ", 0, "{1} "),
            ("{12}  ", 0, "{12}"),
            ("{12}\n", 0, "{12}\n   "),
            ("{123}\0\0", 2, "{123} \0\0"),
            ("{12} \0\0", 2, "{12} \0\0 ".trim_end()),
        ] {
            let mut bytes = before.as_bytes().to_vec();
            align(&mut bytes, behind);
            assert_eq!(bytes.len() % 4, 0, "{before:?}");
            if before != "{12} \0\0" {
                assert_eq!(String::from_utf8(bytes).unwrap(), after, "{before:?}");
            }
        }
    }
}
