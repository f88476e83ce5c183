//! Replaces ranges of a text.

use std::ops::Range;

/// One replacement: the bytes in `span` of the file become `text`. An empty span inserts.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct TextPatch {
    pub(in super::super) span: Range<usize>,
    pub(in super::super) text: String,
    /// JSON pointer of what is replaced, for users.
    pub(in super::super) pointer: String,
}

impl TextPatch {
    pub(in super::super) fn new(
        span: Range<usize>,
        text: impl Into<String>,
        pointer: impl Into<String>,
    ) -> Self {
        Self { span, text: text.into(), pointer: pointer.into() }
    }
}

/// Sorts patches by their position in the text; insertions at a position come before a replacement there, in the given
/// order. Returns `false` if two patches would replace the same byte.
#[must_use]
pub(in super::super) fn sort(patches: &mut [TextPatch]) -> bool {
    patches.sort_by_key(|patch| (patch.span.start, patch.span.end));
    patches.windows(2).all(|pair| pair[0].span.end <= pair[1].span.start)
}

/// Returns the bytes in `range` of the file with the sorted `patches` applied, all of which are in this range.
pub(in super::super) fn patched(file: &[u8], range: Range<usize>, patches: &[TextPatch]) -> Vec<u8> {
    let more: usize = patches.iter().map(|patch| patch.text.len()).sum();
    let mut out = Vec::with_capacity(range.len() + more);
    let mut from = range.start;
    for patch in patches {
        out.extend_from_slice(&file[from..patch.span.start]);
        out.extend_from_slice(patch.text.as_bytes());
        from = patch.span.end;
    }
    out.extend_from_slice(&file[from..range.end]);
    out
}
