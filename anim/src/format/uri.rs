//! What a file may call its neighbours: which URIs are followed, and to where.
//!
//! A URI is decoded exactly once and judged after that, so no second decoding further on can turn an innocent name
//! into another one. The judgement is the strictest of all systems': what is special on one is refused on each.

use crate::limits::PATH_BYTES;
use thiserror::Error;

/// Why a URI is not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct UriError(&'static str);

/// The path that `uri` names below the file's own folder: parts joined by `/`, none of them special.
///
/// Refused: nothing, a scheme or a drive, an absolute path, `..`, an encoded separator, a backslash, control
/// characters, parts that end in a dot or a blank, names of devices, and what is too long. A leading `./` is dropped.
pub fn relative_path(uri: &str) -> Result<String, UriError> {
    if uri.is_empty() {
        return Err(UriError("the name is empty"));
    }
    if uri.len() > PATH_BYTES * 3 {
        return Err(UriError("the name is too long"));
    }
    if has_encoded_separator(uri) {
        return Err(UriError("a path separator may not be encoded"));
    }
    let path = String::from_utf8(percent_decoded(uri)?).map_err(|_| UriError("the name is not UTF-8"))?;
    if path.len() > PATH_BYTES {
        return Err(UriError("the name is too long"));
    }
    if path.starts_with('/') || path.starts_with('\\') {
        return Err(UriError("an absolute path is not followed"));
    }
    let mut parts = Vec::new();
    for part in path.split('/') {
        if part != "." {
            parts.push(plain_part(part)?);
        }
    }
    if parts.is_empty() { Err(UriError("a folder is not a file")) } else { Ok(parts.join("/")) }
}

/// `part` if it is an ordinary name on every system.
fn plain_part(part: &str) -> Result<&str, UriError> {
    let refused = if part.is_empty() {
        "a part of the path is empty"
    } else if part == ".." {
        "the path leaves the folder"
    } else if part.contains(':') {
        "schemes and drives are not followed"
    } else if part.contains('\\') {
        "a backslash may not stand in a path"
    } else if part.chars().any(char::is_control) {
        "a control character may not stand in a path"
    } else if part.ends_with(['.', ' ']) {
        "a part of the path ends in a dot or a blank"
    } else if part.len() > 255 {
        "a part of the path is too long"
    } else if is_device(part) {
        "the path names a device"
    } else {
        return Ok(part);
    };
    Err(UriError(refused))
}

/// Names that mean a device on some system, with any ending.
fn is_device(part: &str) -> bool {
    let stem = part.split('.').next().unwrap_or(part).trim_end().to_ascii_lowercase();
    let numbered =
        |prefix| stem.strip_prefix(prefix).is_some_and(|rest: &str| matches!(rest.as_bytes(), [b'0'..=b'9']));
    matches!(stem.as_str(), "con" | "prn" | "aux" | "nul") || numbered("com") || numbered("lpt")
}

fn has_encoded_separator(uri: &str) -> bool {
    uri.as_bytes().windows(3).any(|three| {
        let lower = [three[0], three[1].to_ascii_lowercase(), three[2].to_ascii_lowercase()];
        matches!(&lower, b"%2f" | b"%5c")
    })
}

/// `text` with each `%41` replaced by the byte it stands for, once.
fn percent_decoded(text: &str) -> Result<Vec<u8>, UriError> {
    const BROKEN: UriError = UriError("% stands without two hexadecimal digits");
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte == b'%' {
            let (digits, after) = rest.split_first_chunk::<2>().ok_or(BROKEN)?;
            let digit = |digit: u8| char::from(digit).to_digit(16).ok_or(BROKEN);
            bytes.push((digit(digits[0])? * 16 + digit(digits[1])?) as u8);
            rest = after;
        } else {
            bytes.push(byte);
        }
    }
    Ok(bytes)
}

/// A URI that carries its data itself (RFC 2397).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataUri<'a> {
    /// `"image/png"`; empty when not said.
    pub mime: &'a str,
    body: &'a str,
    is_base64: bool,
}

impl<'a> DataUri<'a> {
    /// `None` when `uri` is something else; an error when it is a data URI without a comma.
    pub fn parse(uri: &'a str) -> Option<Result<Self, UriError>> {
        let (scheme, rest) = uri.split_at_checked(5)?;
        if !scheme.eq_ignore_ascii_case("data:") {
            return None;
        }
        let Some((head, body)) = rest.split_once(',') else {
            return Some(Err(UriError("a data URI without a comma")));
        };
        let base64 = head.rsplit_once(';').filter(|(_, last)| last.trim().eq_ignore_ascii_case("base64"));
        let mime = head.split(';').next().unwrap_or("").trim();
        Some(Ok(Self { mime, body, is_base64: base64.is_some() }))
    }

    /// Is the data base64? Else it is percent-encoded.
    pub fn is_base64(&self) -> bool {
        self.is_base64
    }

    /// At most how many bytes [`Self::decode`] yields.
    pub fn capacity(&self) -> usize {
        if self.is_base64 { self.body.len() / 4 * 3 + 3 } else { self.body.len() }
    }

    /// Appends the data to `bytes`.
    pub fn decode(&self, bytes: &mut Vec<u8>) -> Result<(), UriError> {
        if self.is_base64 {
            return base64(self.body.as_bytes(), bytes);
        }
        bytes.extend(percent_decoded(self.body)?);
        Ok(())
    }
}

/// The value of each base64 digit, 255 for anything else.
const DIGITS: [u8; 256] = {
    let mut digits = [255; 256];
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut value = 0;
    while value < 64 {
        digits[alphabet[value] as usize] = value as u8;
        value += 1;
    }
    digits
};

/// Base64 (RFC 4648 §4), padding optional.
fn base64(text: &[u8], bytes: &mut Vec<u8>) -> Result<(), UriError> {
    const BROKEN: UriError = UriError("the base64 data holds something else");
    let text = text.strip_suffix(b"==").or_else(|| text.strip_suffix(b"=")).unwrap_or(text);
    for four in text.chunks(4) {
        let mut bits = 0_u32;
        for &digit in four {
            let value = DIGITS[digit as usize];
            if value == 255 {
                return Err(BROKEN);
            }
            bits = bits << 6 | u32::from(value);
        }
        match four.len() {
            4 => bytes.extend_from_slice(&bits.to_be_bytes()[1..]),
            3 => bytes.extend_from_slice(&(bits >> 2).to_be_bytes()[2..]),
            2 => bytes.push((bits >> 4) as u8),
            _ => return Err(BROKEN),
        }
    }
    Ok(())
}
