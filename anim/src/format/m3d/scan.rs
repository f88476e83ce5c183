//! Labels and numbers, by their position in the text.

use super::check as code;
use crate::format::decimal::parse_number;
use crate::format::text::{Lexicon, TextScanner, TextToken};
use crate::format::{ImportError, Place};
use glam::Vec3;

/// Reads labels, which the format never compares, and numbers.
pub(super) struct M3dScanner<'a> {
    scanner: TextScanner<'a>,
}

impl<'a> M3dScanner<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { scanner: TextScanner::new(bytes, &Lexicon::WORDS) }
    }

    /// Returns whether there is no token in a text.
    pub(super) fn blank(text: &'a [u8]) -> bool {
        Self::new(text).peek().is_none()
    }

    /// Returns the offset of the next byte.
    pub(super) fn at(&self) -> usize {
        self.scanner.at()
    }

    /// Returns the number of bytes that are left.
    pub(super) fn left(&self) -> usize {
        self.scanner.left()
    }

    /// Continues at another offset.
    pub(super) fn go_to(&mut self, at: usize) {
        self.scanner.go_to(at);
    }

    pub(super) fn place(&self, at: usize) -> Place {
        self.scanner.place(at)
    }

    pub(super) fn invalid(&self, at: usize, code: &'static str, reason: impl Into<String>) -> ImportError {
        self.scanner.invalid(at, code, reason)
    }

    pub(super) fn peek(&mut self) -> Option<TextToken<'a>> {
        self.scanner.peek()
    }

    /// Returns the next token, which is a name.
    pub(super) fn word(&mut self, what: &str) -> Result<TextToken<'a>, ImportError> {
        self.scanner.need(what)
    }

    /// Skips a label: any token that is no number.
    #[inline]
    pub(super) fn label(&mut self, what: &str) -> Result<TextToken<'a>, ImportError> {
        let token = self.scanner.need(what)?;
        if !is_number(token) {
            return Ok(token);
        }
        let reason = format!("the number {} where the label of {what} was expected", token.shown());
        Err(self.scanner.invalid(token.at, code::LABEL_MISSING, reason))
    }

    /// Returns `N` numbers.
    #[inline]
    pub(super) fn floats<const N: usize>(&mut self, what: &str) -> Result<[f32; N], ImportError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.scanner.float(what)?;
        }
        Ok(numbers)
    }

    /// Skips a label, and returns `N` numbers after it.
    #[inline]
    pub(super) fn labelled<const N: usize>(&mut self, what: &str) -> Result<[f32; N], ImportError> {
        self.label(what)?;
        self.floats(what)
    }

    /// Skips a label, and returns the color after it.
    pub(super) fn color(&mut self, what: &str) -> Result<Vec3, ImportError> {
        Ok(Vec3::from(self.labelled::<3>(what)?).clamp(Vec3::ZERO, Vec3::splat(1e6)))
    }

    /// Returns a whole number of at most `limit`, and its token.
    pub(super) fn whole(&mut self, what: &str, limit: u64) -> Result<(u64, TextToken<'a>), ImportError> {
        let token = self.scanner.need(what)?;
        self.scanner.go_to(token.at);
        Ok((self.scanner.whole(what, limit)?, token))
    }

    /// Skips a label, and returns the number of items after it; each needs at least `bytes` bytes of text.
    pub(super) fn count(&mut self, what: &str, bytes: usize) -> Result<(usize, TextToken<'a>), ImportError> {
        self.label(what)?;
        let (count, token) = self.whole(what, u64::from(u32::MAX))?;
        self.enough(count, bytes, token, what)?;
        Ok((count as usize, token))
    }

    /// Refuses a count that needs more text than there is.
    fn enough(&self, count: u64, bytes: usize, token: TextToken<'_>, what: &str) -> Result<(), ImportError> {
        let possible = (self.scanner.left() / bytes) as u64;
        if count <= possible {
            return Ok(());
        }
        let reason = format!("{what} is {count}, the text after it is too short for more than {possible}");
        Err(self.scanner.invalid(token.at, crate::format::text::UNEXPECTED_END, reason))
    }
}

/// Returns whether a token is a number.
#[inline]
pub(super) fn is_number(token: TextToken<'_>) -> bool {
    matches!(token.text[0], b'0'..=b'9' | b'-' | b'+' | b'.') && parse_number(token.text).is_some()
}
