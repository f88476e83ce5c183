//! Parses the JSON text into the document model; every error has a JSON pointer.

use super::check as code;
use super::pointer::ChannelPointers;
use super::survey::{Survey, SurveyPatch, survey};
use super::walk::pointer_before;
use crate::format::{ImportContext, ImportError, Place};
use gltf::json;
use std::borrow::Cow;
use std::io::{self, Read};

/// Longest text that is parsed in one piece. Longer ones are parsed through a reader that polls the cancel flag, which
/// is slower.
const PARSE_AT_ONCE: usize = 4 << 20;

/// Parses the JSON text that starts at byte `at` of the file. Also returns the targets of channels that are JSON pointers,
/// which the document model leaves out.
pub(super) fn parse(
    bytes: &[u8],
    at: u64,
    context: &ImportContext<'_>,
) -> Result<(json::Root, ChannelPointers), ImportError> {
    let text = text_of(bytes, at)?;
    let mut survey = survey(text.as_bytes(), context)?;
    check_version(&survey)?;
    context.charge(&Place::Pointer(String::new()), survey.memory)?;
    let text = completed(text, &survey, context)?;
    let parsed = if text.len() <= PARSE_AT_ONCE {
        json::deserialize::from_str(&text)
    } else {
        let reader = CancellableReader { text: text.as_bytes(), context, cancelled: false };
        json::deserialize::from_reader(io::BufReader::with_capacity(1 << 16, reader))
    };
    context.progress(0.2)?;
    let root = parsed.map_err(|error| placed(&error, &text, at))?;
    Ok((root, std::mem::take(&mut survey.pointers)))
}

/// Returns the text as UTF-8, without byte order mark and padding.
fn text_of(bytes: &[u8], at: u64) -> Result<&str, ImportError> {
    let (bytes, at) = match bytes.strip_prefix(b"\xef\xbb\xbf") {
        Some(rest) => (rest, at + 3),
        None => (bytes, at),
    };
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text.trim_end_matches('\0')),
        Err(error) => Err(ImportError::Invalid {
            place: Place::Byte(at + error.valid_up_to() as u64),
            code: code::INVALID_JSON,
            reason: "the text is not UTF-8".to_owned(),
        }),
    }
}

/// Accepts only version 2.x, and only where 2.0 is sufficient.
fn check_version(survey: &Survey) -> Result<(), ImportError> {
    let is_later = |least: &str| least.strip_prefix("2.").is_none_or(|minor| minor.parse() != Ok(0_u32));
    let unsupported = |member: &str, version: &str| {
        let place = Place::Pointer(format!("/asset/{member}"));
        Err(ImportError::Unsupported { place, feature: format!("glTF version {version}") })
    };
    match (&survey.version, &survey.min_version) {
        (Some(version), _) if !version.starts_with("2.") => unsupported("version", version),
        (_, Some(least)) if is_later(least) => unsupported("minVersion", least),
        _ => Ok(()),
    }
}

/// Returns the text with the members added that the document model requires and the file lacks, and with whole numbers
/// written as such.
fn completed<'a>(
    text: &'a str,
    survey: &Survey,
    context: &ImportContext<'_>,
) -> Result<Cow<'a, str>, ImportError> {
    if survey.patches.is_empty() {
        return Ok(Cow::Borrowed(text));
    }
    let length = text.len() + survey.patches.iter().map(SurveyPatch::longest).sum::<usize>();
    context.charge(&Place::Pointer(String::new()), length as u64)?;
    let mut patched = String::with_capacity(length);
    let mut from = 0;
    for patch in &survey.patches {
        match *patch {
            SurveyPatch::Member { at, member } => {
                patched.push_str(&text[from..at]);
                patched.push_str(member);
                from = at;
            }
            SurveyPatch::Whole { at, end, number } => {
                patched.push_str(&text[from..at]);
                patched.push_str(&number.to_string());
                from = end;
            }
        }
    }
    patched.push_str(&text[from..]);
    Ok(Cow::Owned(patched))
}

/// Returns the parser's error with a place instead of its line and column.
fn placed(error: &json::Error, text: &str, at: u64) -> ImportError {
    if error.is_io() {
        return ImportError::Cancelled;
    }
    let message = error.to_string();
    let reason = message.split(" at line ").next().unwrap_or(&message).to_owned();
    let end = offset(text, error.line(), error.column());
    if !error.is_data() && reason != "number out of range" {
        let reason = if error.is_eof() { "the text ends too early".to_owned() } else { reason };
        return ImportError::Invalid {
            place: Place::Byte(at + end as u64),
            code: code::INVALID_JSON,
            reason,
        };
    }
    let code = if reason.starts_with("missing field") {
        code::UNDEFINED_PROPERTY
    } else if reason == "number out of range" {
        code::VALUE_NOT_IN_RANGE
    } else if reason.starts_with("duplicate field") {
        code::DUPLICATE_PROPERTY
    } else {
        code::TYPE_MISMATCH
    };
    ImportError::Invalid { place: Place::Pointer(pointer_before(text.as_bytes(), end)), code, reason }
}

/// Returns the byte offset of a line and column, both counted from 1; at most the length of the text.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let before: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    (before + column).min(text.len())
}

/// Reads the text in pieces and polls the cancel flag between them.
struct CancellableReader<'a> {
    text: &'a [u8],
    context: &'a ImportContext<'a>,
    cancelled: bool,
}

impl Read for CancellableReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.cancelled |= self.context.work(buffer.len()).is_err();
        if self.cancelled {
            return Err(io::Error::other("cancelled"));
        }
        self.text.read(buffer)
    }
}
