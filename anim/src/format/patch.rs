//! Replaces parts of a text, and puts blocks of it into another order.

use std::ops::Range;

/// Replacements of ranges of a text; an empty range inserts.
#[derive(Default)]
pub(super) struct TextPatches {
    list: Vec<(Range<usize>, Vec<u8>)>,
}

impl TextPatches {
    /// Replaces a range. No two ranges may overlap.
    pub(super) fn replace(&mut self, range: Range<usize>, text: impl Into<Vec<u8>>) {
        self.list.push((range, text.into()));
    }

    /// Returns whether nothing is replaced.
    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Adds the replacements of another list.
    pub(super) fn extend(&mut self, other: Self) {
        self.list.extend(other.list);
    }

    /// Returns the bytes in a range of the text with all replacements, which are in this range.
    pub(super) fn apply(mut self, text: &[u8], range: Range<usize>) -> Vec<u8> {
        self.list.sort_by_key(|(range, _)| (range.start, range.end));
        let more: usize = self.list.iter().map(|(_, text)| text.len()).sum();
        let mut out = Vec::with_capacity(range.len() + more);
        let mut from = range.start;
        for (range, new) in self.list {
            out.extend_from_slice(&text[from..range.start]);
            out.extend(new);
            from = range.end;
        }
        out.extend_from_slice(&text[from..range.end]);
        out
    }

    /// Puts `blocks` into the places of the old ones, which ascend. Further blocks are inserted at `end`, each after
    /// `separator`; places for which there is no block are removed, with the blanks before them.
    pub(super) fn place(
        &mut self,
        text: &[u8],
        places: &[Range<usize>],
        blocks: Vec<Vec<u8>>,
        end: usize,
        separator: &str,
    ) {
        let mut more = Vec::new();
        let count = blocks.len();
        for (index, block) in blocks.into_iter().enumerate() {
            match places.get(index) {
                Some(place) if text[place.clone()] == block[..] => {}
                Some(place) => self.replace(place.clone(), block),
                None => {
                    more.extend_from_slice(separator.as_bytes());
                    more.extend(block);
                }
            }
        }
        for place in places.iter().skip(count) {
            let blanks =
                text[..place.start].iter().rev().take_while(|byte| byte.is_ascii_whitespace()).count();
            self.replace(place.start - blanks..place.end, "");
        }
        if !more.is_empty() {
            self.replace(end..end, more);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_replaced_in_any_order_of_the_list() {
        let mut patches = TextPatches::default();
        patches.replace(4..5, "E");
        patches.replace(1..1, "xyz");
        patches.replace(2..3, "");
        assert!(!patches.is_empty());
        assert_eq!(patches.apply(b"abcdefgh", 1..6), b"xyzbdEf");
    }

    #[test]
    fn blocks_move_are_added_and_removed() {
        let text = b"h A1 B2 C3 end";
        let places = [2..4, 5..7, 8..10];
        let placed = |blocks: &[&str]| {
            let mut patches = TextPatches::default();
            let blocks = blocks.iter().map(|block| block.as_bytes().to_vec()).collect();
            patches.place(text, &places, blocks, 10, "\n");
            String::from_utf8(patches.apply(text, 0..text.len())).unwrap()
        };
        assert_eq!(placed(&["A1", "B2", "C3"]), "h A1 B2 C3 end");
        assert_eq!(placed(&["B2", "A1", "C3"]), "h B2 A1 C3 end");
        assert_eq!(placed(&["B2"]), "h B2 end");
        assert_eq!(placed(&[]), "h end");
        assert_eq!(placed(&["A1", "B2", "C3", "D4", "E"]), "h A1 B2 C3\nD4\nE end");
    }
}
