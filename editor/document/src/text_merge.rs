//! Merges two texts that came from one: edits of the old text are moved to the new one, which another program changed.
//!
//! A merge lists where the two texts differ. Everything outside of these parts is the same in both, so an edit there has its place in the
//! new text too. An edit that touches such a part does not fit, and makes the part larger: what it wrote is in the old text alone.

use dragonfly_anim::stage::splice::{TextSplice, TextSplices};
use std::collections::HashMap;
use std::ops::Range;

/// A part in which the texts differ: its bytes in the old text, and those in the new one.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Difference {
    old: Range<usize>,
    new: Range<usize>,
}

/// Where an old and a new text differ.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct TextMerge {
    /// In the order of the texts; they neither overlap nor touch.
    differences: Vec<Difference>,
}

impl TextMerge {
    /// Compares two texts by lines.
    pub(super) fn between(old: &str, new: &str) -> Self {
        let [old_lines, new_lines] = [old, new].map(|text| text.split_inclusive('\n').collect::<Vec<_>>());
        let [old_starts, new_starts] = [&old_lines, &new_lines].map(|lines| starts(lines));
        let bytes = |lines: Lines| Difference {
            old: old_starts[lines.old.start]..old_starts[lines.old.end],
            new: new_starts[lines.new.start]..new_starts[lines.new.end],
        };
        Self { differences: different_lines(&old_lines, &new_lines).into_iter().map(bytes).collect() }
    }

    /// Returns the replacements of the old text as replacements of the new one; the byte of the old text at which the first one does not
    /// fit, where it fails.
    pub(super) fn mapped(&self, splices: &TextSplices) -> Result<TextSplices, usize> {
        let mut mapped = Vec::with_capacity(splices.list().len());
        for splice in splices.list() {
            let range = &splice.range;
            if self.differences.iter().any(|part| touches(part, range)) {
                return Err(range.start);
            }
            // All parts that end before it have moved it.
            let before = self.differences.iter().rfind(|part| part.old.end <= range.start);
            let moved = |at: usize| before.map_or(at, |part| at - part.old.end + part.new.end);
            mapped
                .push(TextSplice { range: moved(range.start)..moved(range.end), text: splice.text.clone() });
        }
        TextSplices::new(mapped).ok_or_else(|| splices.list().first().map_or(0, |splice| splice.range.start))
    }

    /// Follows replacements of the old text that were made in both texts.
    pub(super) fn follow(&mut self, splices: &TextSplices) {
        for part in &mut self.differences {
            let shift = shifted(splices, part.old.start) as isize - part.old.start as isize;
            part.old = part.old.start.saturating_add_signed(shift)..part.old.end.saturating_add_signed(shift);
            part.new = part.new.start.saturating_add_signed(shift)..part.new.end.saturating_add_signed(shift);
        }
    }

    /// Follows replacements that were made in the old text only, which is `old` afterwards. Returns whether it has the same there as the
    /// new text by now: both sides made the same change.
    pub(super) fn diverge(&mut self, splices: &TextSplices, old: &str, new: &str) -> bool {
        // From the last to the first, so that the places of the others stay.
        for splice in splices.list().iter().rev() {
            self.add(splice);
        }
        self.differences.retain(|part| {
            let [a, b] = [old.get(part.old.clone()), new.get(part.new.clone())];
            a.is_none() || a != b
        });
        let mut shift = 0_isize;
        splices.list().iter().all(|splice| {
            let start = splice.range.start.saturating_add_signed(shift);
            shift += splice.text.len() as isize - splice.range.len() as isize;
            let range = start..start + splice.text.len();
            !self.differences.iter().any(|part| part.old.start <= range.end && part.old.end >= range.start)
        })
    }

    fn add(&mut self, splice: &TextSplice) {
        let first = self.differences.partition_point(|part| part.old.end < splice.range.start);
        let last = self.differences.partition_point(|part| part.old.start <= splice.range.end);
        let shift = splice.text.len() as isize - splice.range.len() as isize;
        let before = first.checked_sub(1).and_then(|index| self.differences.get(index)).cloned();
        let to_new = |at: usize| before.as_ref().map_or(at, |part| at - part.old.end + part.new.end);
        let merged = match self.differences.get(first..last).unwrap_or_default() {
            [] => Difference {
                old: splice.range.start..splice.range.end,
                new: to_new(splice.range.start)..to_new(splice.range.end),
            },
            touched => {
                let [start, end] = [&touched[0], &touched[touched.len() - 1]];
                let lead = start.old.start.saturating_sub(splice.range.start);
                let tail = splice.range.end.saturating_sub(end.old.end);
                Difference {
                    old: start.old.start.min(splice.range.start)..end.old.end.max(splice.range.end),
                    new: start.new.start - lead..end.new.end + tail,
                }
            }
        };
        let merged =
            Difference { old: merged.old.start..merged.old.end.saturating_add_signed(shift), ..merged };
        self.differences.splice(first..last.max(first), [merged]);
        for part in &mut self.differences[first + 1..] {
            part.old = part.old.start.saturating_add_signed(shift)..part.old.end.saturating_add_signed(shift);
        }
    }
}

/// Returns whether a replacement of `range` has no certain place beside a difference.
fn touches(part: &Difference, range: &Range<usize>) -> bool {
    let apart = range.end <= part.old.start || range.start >= part.old.end;
    // Where the new text inserted something, what is inserted at the same place could be before or behind it.
    let is_same_place = part.old.is_empty() && *range == part.old;
    !apart || is_same_place
}

/// Returns where a byte of the old text is after replacements of it, none of which contains it.
fn shifted(splices: &TextSplices, at: usize) -> usize {
    let before = splices.list().iter().filter(|splice| splice.range.end <= at);
    before.fold(at, |at, splice| at + splice.text.len() - splice.range.len())
}

/// Lines of the old text, and those of the new one in their place.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Lines {
    old: Range<usize>,
    new: Range<usize>,
}

/// Returns the byte at which each line begins, and that behind the last one.
fn starts(lines: &[&str]) -> Vec<usize> {
    let mut starts = vec![0];
    let mut at = 0;
    starts.extend(lines.iter().map(|line| {
        at += line.len();
        at
    }));
    starts
}

/// Returns the lines that differ. Lines that occur once in both texts are anchors; between them, common starts and ends are cut off,
/// until no anchor is left.
fn different_lines(old: &[&str], new: &[&str]) -> Vec<Lines> {
    let mut found = Vec::new();
    let mut open = vec![Lines { old: 0..old.len(), new: 0..new.len() }];
    while let Some(part) = open.pop() {
        let part = trimmed(old, new, part);
        if part.old.is_empty() && part.new.is_empty() {
            continue;
        }
        let anchors = anchors(&old[part.old.clone()], &new[part.new.clone()]);
        if anchors.is_empty() {
            found.push(part);
            continue;
        }
        let (mut old_from, mut new_from) = (part.old.start, part.new.start);
        for (a, b) in anchors {
            let (a, b) = (part.old.start + a, part.new.start + b);
            open.push(Lines { old: old_from..a, new: new_from..b });
            (old_from, new_from) = (a + 1, b + 1);
        }
        open.push(Lines { old: old_from..part.old.end, new: new_from..part.new.end });
    }
    found.sort_by_key(|lines| (lines.old.start, lines.new.start));
    // Parts that touch are one.
    let mut joined: Vec<Lines> = Vec::with_capacity(found.len());
    for lines in found {
        match joined.last_mut() {
            Some(last) if last.old.end == lines.old.start && last.new.end == lines.new.start => {
                (last.old.end, last.new.end) = (lines.old.end, lines.new.end);
            }
            _ => joined.push(lines),
        }
    }
    joined
}

/// Cuts off the lines that are the same at the start and at the end.
fn trimmed(old: &[&str], new: &[&str], part: Lines) -> Lines {
    let (a, b) = (&old[part.old.clone()], &new[part.new.clone()]);
    let head = a.iter().zip(b).take_while(|(a, b)| a == b).count();
    let tail = a[head..].iter().rev().zip(b[head..].iter().rev()).take_while(|(a, b)| a == b).count();
    Lines { old: part.old.start + head..part.old.end - tail, new: part.new.start + head..part.new.end - tail }
}

/// Returns lines that occur once in each text, as many as are in the same order in both.
fn anchors(old: &[&str], new: &[&str]) -> Vec<(usize, usize)> {
    let mut count: HashMap<&str, [usize; 4]> = HashMap::new();
    for (side, lines) in [old, new].into_iter().enumerate() {
        for (at, line) in lines.iter().enumerate() {
            let entry = count.entry(line).or_default();
            entry[side] += 1;
            entry[2 + side] = at;
        }
    }
    let mut pairs: Vec<(usize, usize)> =
        count.into_values().filter(|[a, b, ..]| (*a, *b) == (1, 1)).map(|[_, _, a, b]| (a, b)).collect();
    pairs.sort_unstable();
    longest_ascending(&pairs)
}

/// Returns the longest list of pairs, in their order, whose second numbers ascend.
fn longest_ascending(pairs: &[(usize, usize)]) -> Vec<(usize, usize)> {
    // For each length the pair with the smallest last number, and for each pair the one before it.
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = Vec::with_capacity(pairs.len());
    for (index, pair) in pairs.iter().enumerate() {
        let length = ends.partition_point(|&end| pairs[end].1 < pair.1);
        before.push(length.checked_sub(1).map(|last| ends[last]));
        if length == ends.len() {
            ends.push(index);
        } else {
            ends[length] = index;
        }
    }
    let mut list: Vec<(usize, usize)> = std::iter::successors(ends.last().copied(), |&index| before[index])
        .map(|index| pairs[index])
        .collect();
    list.reverse();
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    /// Returns a text of lines that are named by letters, some of them several times.
    fn lines(random: &mut Random, count: usize) -> Vec<String> {
        (0..count).map(|_| format!("line {}\n", random.bits() % 30)).collect()
    }

    /// Returns the differences as texts of both sides, after a check that everything else is the same.
    fn parts(merge: &TextMerge, old: &str, new: &str) -> Vec<(String, String)> {
        let (mut a, mut b, mut found) = (0, 0, Vec::new());
        for part in &merge.differences {
            assert_eq!(old[a..part.old.start], new[b..part.new.start]);
            found.push((old[part.old.clone()].to_owned(), new[part.new.clone()].to_owned()));
            (a, b) = (part.old.end, part.new.end);
        }
        assert_eq!(old[a..], new[b..]);
        found
    }

    #[test]
    fn texts_are_the_same_outside_of_the_parts_in_which_they_differ() {
        let mut random = Random::new(seed(95));
        for _ in 0..500 {
            let old = lines(&mut random, 25);
            let mut new = old.clone();
            for _ in 0..random.bits() % 6 {
                let at = (random.bits() % new.len() as u64) as usize;
                match random.bits() % 3 {
                    0 => _ = new.remove(at),
                    1 => new.insert(at, "added\n".to_owned()),
                    _ => new[at] = "changed\n".to_owned(),
                }
            }
            let [old, new] = [old.concat(), new.concat()];
            parts(&TextMerge::between(&old, &new), &old, &new);
        }
        let merge = TextMerge::between("a\nb\nc\nd\n", "a\nB\nc\nd\ne\n");
        let texts = [("b\n", "B\n"), ("", "e\n")].map(|(a, b)| (a.to_owned(), b.to_owned()));
        assert_eq!(parts(&merge, "a\nb\nc\nd\n", "a\nB\nc\nd\ne\n"), texts);
    }

    #[test]
    fn random_edits_of_the_old_text_that_fit_do_the_same_to_the_new_text_and_the_parts_follow_both() {
        let mut random = Random::new(seed(96));
        let mut fitting = [0; 2];
        for _ in 0..400 {
            let mut old = lines(&mut random, 12).concat();
            let mut new = old.replacen("line 3\n", "line three\nand more\n", 1).replacen("line 7\n", "", 2);
            let mut merge = TextMerge::between(&old, &new);
            for _ in 0..12 {
                let start = (random.bits() % (old.len() as u64 + 1)) as usize;
                let end = (start + (random.bits() % 9) as usize).min(old.len());
                let text = ["", "x", "line 9\n"][(random.bits() % 3) as usize].to_owned();
                let removed = old[start..end].to_owned();
                let splices = TextSplices::new(vec![TextSplice { range: start..end, text }]).expect("one");
                match merge.mapped(&splices) {
                    Ok(mapped) => {
                        assert_eq!(&new[mapped.list()[0].range.clone()], removed);
                        (old, new) = (splices.apply(&old), mapped.apply(&new));
                        merge.follow(&splices);
                        fitting[0] += 1;
                    }
                    Err(_) => {
                        old = splices.apply(&old);
                        merge.diverge(&splices, &old, &new);
                        fitting[1] += 1;
                    }
                }
                parts(&merge, &old, &new);
            }
        }
        assert!(fitting[0] > 1000 && fitting[1] > 100, "{fitting:?}");
    }

    #[test]
    fn the_same_change_on_both_sides_leaves_no_difference() {
        let (old, new) = ("a\nb\nc\n", "a\nB\nc\n");
        let mut merge = TextMerge::between(old, new);
        let splices = TextSplices::new(vec![TextSplice { range: 2..3, text: "B".to_owned() }]).expect("one");
        assert_eq!(merge.mapped(&splices), Err(2));
        assert!(merge.diverge(&splices, "a\nB\nc\n", new) && merge.differences.is_empty());
    }
}
