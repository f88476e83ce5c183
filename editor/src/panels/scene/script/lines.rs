//! Bytes, characters and lines of a text.

use std::ops::Range;

/// Returns the number of characters before a byte; of the whole text for a byte past its end.
pub(super) fn characters_before(text: &str, at: usize) -> usize {
    let at = (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    text[..at].chars().count()
}

/// Returns the byte of a character; the length of the text past its end.
pub(super) fn byte_of(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}

/// Returns the number of the line of a byte, from 0.
pub(super) fn line_of(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    text.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count()
}

/// Returns the lines of a range of bytes, from 0, without the one that only its end touches.
pub(super) fn lines_of(text: &str, range: &Range<usize>) -> Range<usize> {
    let first = line_of(text, range.start);
    first..line_of(text, range.end.saturating_sub(1).max(range.start)) + 1
}

/// Returns a position after a text was replaced by another one: it stays at what it was at.
pub(super) fn moved_position(at: usize, old: &str, new: &str) -> usize {
    let Some(splice) = dragonfly_anim::stage::splice::TextSplice::between(old, new) else { return at };
    if at <= splice.range.start {
        at
    } else if at >= splice.range.end {
        at - splice.range.len() + splice.text.len()
    } else {
        splice.range.start + splice.text.len()
    }
}
