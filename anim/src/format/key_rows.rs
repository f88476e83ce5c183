//! Lists of keys in a text, one row for each key: rows are replaced, added and removed.

use super::patch::TextPatches;
use std::ops::Range;

/// A row as it is in the file.
#[derive(Clone, Debug)]
pub(super) struct OldRow {
    /// From its first token to the end of its last one.
    pub(super) range: Range<usize>,
    /// Time in seconds.
    pub(super) time: f32,
}

/// A row that is added.
pub(super) struct NewRow {
    /// Time in seconds.
    pub(super) time: f32,
    /// Text from its first token to the end of its last one.
    pub(super) text: String,
}

/// Number of rows of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct RowCounts {
    pub(super) changed: usize,
    pub(super) added: usize,
    pub(super) removed: usize,
}

impl RowCounts {
    /// Returns whether there are none.
    pub(super) fn is_none(self) -> bool {
        self == Self::default()
    }
}

/// The rows of a list after an edit.
pub(super) struct RowEdits {
    /// The replacements in each old row, `None` for one that is removed.
    pub(super) kept: Vec<Option<TextPatches>>,
    /// In ascending order of their times.
    pub(super) added: Vec<NewRow>,
}

impl RowEdits {
    /// Finds the old row for each key that is wanted, and makes new rows for the others.
    ///
    /// `times` are those of all old rows, and `used` the numbers of those that are keys, in ascending order of their times.
    /// `edit` gets the number of an old row, of its key and of the wanted key, `make` that of the wanted key.
    pub(super) fn matched(
        times: &[f32],
        used: &[u32],
        wanted: &[f32],
        mut edit: impl FnMut(usize, usize, usize) -> TextPatches,
        mut make: impl FnMut(usize) -> String,
    ) -> Self {
        let key_at = |time: f32| used.binary_search_by(|&row| times[row as usize].total_cmp(&time)).ok();
        let mut kept: Vec<Option<TextPatches>> = times.iter().map(|_| None).collect();
        let mut added = Vec::new();
        for (number, &time) in wanted.iter().enumerate() {
            match key_at(time) {
                Some(key) => kept[used[key] as usize] = Some(edit(used[key] as usize, key, number)),
                None => added.push(NewRow { time, text: make(number) }),
            }
        }
        if used.len() < times.len() {
            // Rows without effect, at the time of a later row that is kept, stay.
            for (row, &time) in times.iter().enumerate() {
                let is_kept = key_at(time).is_some_and(|key| kept[used[key] as usize].is_some());
                if is_kept {
                    kept[row].get_or_insert_default();
                }
            }
        }
        Self { kept, added }
    }

    /// Returns the number of rows afterwards.
    pub(super) fn len(&self) -> usize {
        self.kept.iter().flatten().count() + self.added.len()
    }
}

/// Edits a list that has rows, and keeps at least one or gets a new one.
///
/// A new row comes before the first row that is later. Between rows that were neighbors everything stays; elsewhere the text between the
/// first two rows is used, or `separator` where there is only one.
pub(super) fn rewrite(
    text: &[u8],
    rows: &[OldRow],
    RowEdits { kept, added: new }: RowEdits,
    separator: &str,
    patches: &mut TextPatches,
) -> RowCounts {
    let counts = RowCounts {
        changed: kept.iter().flatten().filter(|row| !row.is_empty()).count(),
        added: new.len(),
        removed: kept.iter().filter(|row| row.is_none()).count(),
    };
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return counts };
    if counts.added == 0 && counts.removed == 0 {
        kept.into_iter().flatten().for_each(|row| patches.extend(row));
        return counts;
    }
    let separator = match rows {
        [one, two, ..] => &text[one.range.end..two.range.start],
        _ => separator.as_bytes(),
    };
    let mut out = Vec::with_capacity(last.range.end - first.range.start);
    // The number of the old row that was written last; none for a new one.
    let (mut before, mut is_first): (Option<usize>, bool) = (None, true);
    let mut new = new.into_iter().peekable();
    let mut push = |bytes: &[u8], old: Option<usize>| {
        match (old, before) {
            _ if is_first => {}
            (Some(old), Some(before)) if old == before + 1 => {
                out.extend_from_slice(&text[rows[before].range.end..rows[old].range.start]);
            }
            _ => out.extend_from_slice(separator),
        }
        out.extend_from_slice(bytes);
        (before, is_first) = (old, false);
    };
    for (index, (row, kept)) in rows.iter().zip(kept).enumerate() {
        let Some(kept) = kept else { continue };
        while let Some(earlier) = new.next_if(|new| new.time < row.time) {
            push(earlier.text.as_bytes(), None);
        }
        push(&kept.apply(text, row.range.clone()), Some(index));
    }
    for later in new {
        push(later.text.as_bytes(), None);
    }
    patches.replace(first.range.start..last.range.end, out);
    counts
}

/// Returns a number as C and C++ read it: the shortest text that is this number.
pub(super) fn number(value: f32) -> String {
    let size = value.abs();
    if value == 0.0 {
        // Without a sign: some programs do not read that.
        "0".to_owned()
    } else if (1e-5..1e9).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "[0 a, 1 b,  2 c]";

    fn edited(kept: [Option<&str>; 3], new: &[(f32, &str)]) -> String {
        let rows = [(1..4, 0.0), (6..9, 1.0), (12..15, 2.0)].map(|(range, time)| OldRow { range, time });
        let kept = kept.iter().zip(&rows).map(|(text, row)| {
            let mut patches = TextPatches::default();
            let text = (*text)?;
            if !text.is_empty() {
                patches.replace(row.range.end - 1..row.range.end, text);
            }
            Some(patches)
        });
        let new = new.iter().map(|&(time, text)| NewRow { time, text: text.to_owned() }).collect();
        let mut patches = TextPatches::default();
        let edits = RowEdits { kept: kept.collect(), added: new };
        rewrite(TEXT.as_bytes(), &rows, edits, "|", &mut patches);
        String::from_utf8(patches.apply(TEXT.as_bytes(), 0..TEXT.len())).unwrap()
    }

    #[test]
    fn rows_keep_what_is_between_them_unless_one_comes_or_goes() {
        let keep = Some("");
        assert_eq!(edited([keep, keep, keep], &[]), TEXT);
        assert_eq!(edited([keep, Some("x"), keep], &[]), "[0 a, 1 x,  2 c]");
        assert_eq!(edited([keep, None, keep], &[]), "[0 a, 2 c]");
        assert_eq!(edited([None, keep, Some("y")], &[]), "[1 b,  2 y]");
        assert_eq!(edited([keep, keep, keep], &[(-1.0, "-1 q"), (0.5, "h")]), "[-1 q, 0 a, h, 1 b,  2 c]");
        assert_eq!(edited([keep, None, None], &[(3.0, "3 d"), (4.0, "4 e")]), "[0 a, 3 d, 4 e]");
        assert_eq!(edited([None, None, None], &[(3.0, "3 d")]), "[3 d]");
    }

    #[test]
    fn numbers_are_the_shortest_that_read_back() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-0.1, "-0.1"),
            (1e-7, "1e-7"),
            (123_456.79, "123456.79"),
            (3e38, "3e38"),
        ] {
            assert_eq!(number(value), text);
            assert_eq!(text.parse::<f32>().unwrap(), value);
        }
    }
}
