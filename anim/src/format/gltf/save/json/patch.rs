//! Exchanging spans of a text for others.

use std::ops::Range;

/// One exchange: the bytes in `span` of the file become `text`. An empty span inserts.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Patch {
    pub(in super::super) span: Range<usize>,
    pub(in super::super) text: String,
    /// JSON pointer of what is exchanged, for people.
    pub(in super::super) pointer: String,
}

impl Patch {
    pub(in super::super) fn new(
        span: Range<usize>,
        text: impl Into<String>,
        pointer: impl Into<String>,
    ) -> Self {
        Self { span, text: text.into(), pointer: pointer.into() }
    }
}

/// Puts patches in the order of the text; insertions at a place come before what is exchanged there, in the order
/// given. `false` when two would exchange the same byte.
#[must_use]
pub(in super::super) fn sort(patches: &mut [Patch]) -> bool {
    patches.sort_by_key(|patch| (patch.span.start, patch.span.end));
    patches.windows(2).all(|pair| pair[0].span.end <= pair[1].span.start)
}

/// The bytes in `range` of the file with the sorted `patches` made, all of which lie in it.
pub(in super::super) fn patched(file: &[u8], range: Range<usize>, patches: &[Patch]) -> Vec<u8> {
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
