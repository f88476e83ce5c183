//! URIs in a file: relative paths to other files, and data URIs.
//!
//! A URI is decoded exactly once and validated after that, so a second decoding later on cannot turn a harmless name
//! into another one. The validation is that of the strictest system: names that are special on one are rejected on all.

use crate::limits::PATH_BYTES;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{Engine, alphabet};
use percent_encoding::percent_decode_str;
use thiserror::Error;

/// Reason why a URI is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct UriError(&'static str);

/// Returns the path of `uri` relative to the file's own folder: parts joined by `/`, none of them special.
///
/// Rejected are: an empty path, a scheme or a drive, an absolute path, `..`, an encoded separator, a backslash, control
/// characters, parts that end in a dot or a space, device names, and paths that are too long. A leading `./` is removed.
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
        return Err(UriError("absolute paths are not allowed"));
    }
    let mut parts = Vec::new();
    for part in path.split('/') {
        if part != "." {
            parts.push(plain_part(part)?);
        }
    }
    if parts.is_empty() { Err(UriError("a folder is not a file")) } else { Ok(parts.join("/")) }
}

/// Returns the URI of a file name that is written as plain text, as in OBJ and DirectX files, for
/// [`ImportContext::read_neighbor`](super::ImportContext::read_neighbor): `\\` separates folders as on Windows, `%` is an
/// ordinary character, and of an absolute path, which is that of another machine, only the last part is used.
pub(super) fn plain_reference(name: &str) -> String {
    let path = name.trim().replace('\\', "/");
    let is_absolute = path.starts_with('/') || path.as_bytes().get(1) == Some(&b':');
    let path = if is_absolute { path.rsplit('/').next().unwrap_or_default() } else { &path };
    path.trim_start_matches("./").replace('%', "%25")
}

/// Returns `part` if it is an ordinary name on every system.
fn plain_part(part: &str) -> Result<&str, UriError> {
    let refused = if part.is_empty() {
        "a part of the path is empty"
    } else if part == ".." {
        "the path leaves the folder"
    } else if part.contains(':') {
        "schemes and drives are not allowed"
    } else if part.contains('\\') {
        "the path contains a backslash"
    } else if part.chars().any(char::is_control) {
        "the path contains a control character"
    } else if part.ends_with(['.', ' ']) {
        "a part of the path ends in a dot or a space"
    } else if part.len() > 255 {
        "a part of the path is too long"
    } else if is_device(part) {
        "the path is the name of a device"
    } else {
        return Ok(part);
    };
    Err(UriError(refused))
}

/// Returns whether `part` is the name of a device on some system, with any extension.
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

/// Decodes each `%41` in `text` to its byte, once. A `%` without two hexadecimal digits is an error.
fn percent_decoded(text: &str) -> Result<Vec<u8>, UriError> {
    let is_encoded =
        |after: &str| after.as_bytes().iter().take(2).filter(|digit| digit.is_ascii_hexdigit()).count() == 2;
    if !text.split('%').skip(1).all(is_encoded) {
        return Err(UriError("a % is not followed by two hexadecimal digits"));
    }
    Ok(percent_decode_str(text).collect())
}

/// A URI that contains its data (RFC 2397).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataUri<'a> {
    /// MIME type such as `"image/png"`; empty when missing.
    pub mime: &'a str,
    body: &'a str,
    is_base64: bool,
}

impl<'a> DataUri<'a> {
    /// Parses a data URI. `None` when `uri` is not one; an error when its comma is missing.
    pub fn parse(uri: &'a str) -> Option<Result<Self, UriError>> {
        let (scheme, rest) = uri.split_at_checked(5)?;
        if !scheme.eq_ignore_ascii_case("data:") {
            return None;
        }
        let Some((head, body)) = rest.split_once(',') else {
            return Some(Err(UriError("the data URI has no comma")));
        };
        let base64 = head.rsplit_once(';').filter(|(_, last)| last.trim().eq_ignore_ascii_case("base64"));
        let mime = head.split(';').next().unwrap_or("").trim();
        Some(Ok(Self { mime, body, is_base64: base64.is_some() }))
    }

    /// Returns whether the data is base64; otherwise it is percent-encoded.
    pub fn is_base64(&self) -> bool {
        self.is_base64
    }

    /// Returns an upper bound of the number of bytes that [`Self::decode`] appends.
    pub fn capacity(&self) -> usize {
        if self.is_base64 { self.body.len() / 4 * 3 + 3 } else { self.body.len() }
    }

    /// Decodes the data and appends it to `bytes`.
    pub fn decode(&self, bytes: &mut Vec<u8>) -> Result<(), UriError> {
        if self.is_base64 {
            return decode_base64(self.body.as_bytes(), bytes);
        }
        bytes.extend(percent_decoded(self.body)?);
        Ok(())
    }
}

/// Standard alphabet without padding, which [`decode_base64`] has removed. Bits after the last byte are ignored.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_allow_trailing_bits(true)
        .with_decode_padding_mode(DecodePaddingMode::RequireNone),
);

/// Decodes base64 (RFC 4648 §4), padding optional, and appends it to `bytes`.
fn decode_base64(text: &[u8], bytes: &mut Vec<u8>) -> Result<(), UriError> {
    let text = text.strip_suffix(b"==").or_else(|| text.strip_suffix(b"=")).unwrap_or(text);
    BASE64
        .decode_vec(text, bytes)
        .map_err(|_| UriError("the base64 data contains an invalid character, or is cut short"))
}
