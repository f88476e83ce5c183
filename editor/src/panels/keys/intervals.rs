//! The selected keys of one channel as intervals of time, so that a hundred thousand keys cost as much as two.

use dragonfly_document::edit::SAME_TIME;
use std::ops::Range;

/// Closed intervals of time, ascending, none of which touch; a single key is an interval without length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intervals(Vec<[f32; 2]>);

/// All of time.
pub const WHOLE: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];

/// Returns the indices of the keys between two times, ends included.
pub fn keys_between(times: &[f32], [from, to]: [f32; 2]) -> Range<usize> {
    let first = times.partition_point(|&time| time < from - SAME_TIME);
    let end = times.partition_point(|&time| time <= to + SAME_TIME);
    first..end.max(first)
}

impl Intervals {
    /// Returns one interval; nothing where it ends before it starts or is not a number.
    pub fn one([from, to]: [f32; 2]) -> Self {
        if from <= to { Self(vec![[from, to]]) } else { Self::default() }
    }

    /// Returns an empty set of intervals.
    pub const fn none() -> Self {
        Self(Vec::new())
    }

    /// Returns the intervals of single keys, in any order.
    pub fn singles(times: impl IntoIterator<Item = f32>) -> Self {
        let mut all: Vec<[f32; 2]> =
            times.into_iter().filter(|time| time.is_finite()).map(|time| [time, time]).collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        all.dedup_by(|later, earlier| later[0] - earlier[0] <= SAME_TIME);
        Self(all)
    }

    /// Returns the intervals that cover stretches in any order.
    pub fn of(stretches: impl IntoIterator<Item = [f32; 2]>) -> Self {
        let mut all: Vec<[f32; 2]> = stretches.into_iter().filter(|[from, to]| from <= to).collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut merged: Vec<[f32; 2]> = Vec::with_capacity(all.len());
        for next in all {
            match merged.last_mut() {
                Some(last) if next[0] <= last[1] + 2.0 * SAME_TIME => last[1] = last[1].max(next[1]),
                _ => merged.push(next),
            }
        }
        Self(merged)
    }

    /// Returns whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the intervals.
    pub fn stretches(&self) -> &[[f32; 2]] {
        &self.0
    }

    /// Returns the first interval that does not end before `time`.
    pub(super) fn at(&self, time: f32) -> Option<[f32; 2]> {
        self.0.get(self.0.partition_point(|[_, to]| to + SAME_TIME < time)).copied()
    }

    /// Returns whether a key at `time` seconds is selected.
    pub fn holds(&self, time: f32) -> bool {
        self.at(time).is_some_and(|[from, _]| time >= from - SAME_TIME)
    }

    /// Adds an interval.
    pub fn add(&mut self, stretch: [f32; 2]) {
        *self = Self::of(self.0.iter().copied().chain([stretch]));
    }

    /// Removes the keys of an interval.
    pub fn remove(&mut self, stretch: [f32; 2], times: &[f32]) {
        let gone = keys_between(times, stretch);
        let mut kept = Vec::with_capacity(self.0.len() + 1);
        for &[from, to] in &self.0 {
            let keys = keys_between(times, [from, to]);
            if keys.end <= gone.start || keys.start >= gone.end {
                kept.push([from, to]);
                continue;
            }
            // The remaining intervals end at keys, so that they contain the same keys even if others are inserted in
            // the gap later.
            if keys.start < gone.start {
                kept.push([from.max(times[keys.start]), times[gone.start - 1]]);
            }
            if keys.end > gone.end {
                kept.push([times[gone.end], to.min(times[keys.end - 1])]);
            }
        }
        *self = Self(kept);
    }

    /// Returns the indices of the selected keys, as ascending ranges of neighbors.
    pub fn keys<'a>(&'a self, times: &'a [f32]) -> impl Iterator<Item = Range<usize>> + 'a {
        self.0.iter().map(|&stretch| keys_between(times, stretch)).filter(|range| !range.is_empty())
    }

    /// Returns the number of selected keys.
    pub fn count(&self, times: &[f32]) -> usize {
        self.keys(times).map(|range| range.len()).sum()
    }

    /// Removes intervals without keys, and joins those with nothing but selected keys between them.
    pub fn tidy(&mut self, times: &[f32]) {
        let mut kept: Vec<([f32; 2], usize)> = Vec::with_capacity(self.0.len());
        for &stretch in &self.0 {
            let keys = keys_between(times, stretch);
            if keys.is_empty() {
                continue;
            }
            match kept.last_mut() {
                Some((last, end)) if *end >= keys.start => (last[1], *end) = (stretch[1], keys.end),
                _ => kept.push((stretch, keys.end)),
            }
        }
        self.0 = kept.into_iter().map(|(stretch, _)| stretch).collect();
    }

    /// Returns the index of the first key from `index` on that is selected; if `selected` is false, of the first that
    /// is not.
    pub fn next(&self, times: &[f32], index: usize, selected: bool) -> Option<usize> {
        let time = *times.get(index)?;
        match (self.at(time), selected) {
            (None, true) => None,
            (None, false) => Some(index),
            (Some([from, _]), true) if time >= from - SAME_TIME => Some(index),
            (Some([from, to]), true) => {
                let found = index + times[index..].partition_point(|&time| time < from - SAME_TIME);
                (found < times.len() && times[found] <= to + SAME_TIME)
                    .then_some(found)
                    .or_else(|| (found < times.len()).then(|| self.next_far(times, found)).flatten())
            }
            (Some([from, _]), false) if time < from - SAME_TIME => Some(index),
            (Some([_, to]), false) => {
                let found = index + times[index..].partition_point(|&time| time <= to + SAME_TIME);
                // Tidy intervals have an unselected key between them; any others are few and are searched one by one.
                let mut found = found;
                while let Some(&time) = times.get(found) {
                    match self.at(time) {
                        Some([from, to]) if time >= from - SAME_TIME => {
                            found += times[found..].partition_point(|&time| time <= to + SAME_TIME);
                        }
                        _ => return Some(found),
                    }
                }
                None
            }
        }
    }

    /// Returns the next selected key where the interval in between had none.
    fn next_far(&self, times: &[f32], index: usize) -> Option<usize> {
        let first = self.0.partition_point(|[_, to]| to + SAME_TIME < times[index]);
        self.0[first..]
            .iter()
            .map(|&stretch| keys_between(times, stretch))
            .find(|keys| !keys.is_empty())
            .map(|keys| keys.start.max(index))
    }

    /// Returns the times of the first and the last selected key, seconds.
    pub fn extent(&self, times: &[f32]) -> Option<[f32; 2]> {
        let first = self.keys(times).next()?;
        let last =
            self.0.iter().rev().map(|&stretch| keys_between(times, stretch)).find(|keys| !keys.is_empty())?;
        Some([times[first.start], times[last.end - 1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f32; 6] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5];

    #[test]
    fn removing_a_key_in_the_middle_splits_the_interval() {
        let mut all = Intervals::one(WHOLE);
        all.remove([0.2, 0.2], &TIMES);
        assert_eq!(all.keys(&TIMES).collect::<Vec<_>>(), [0..2, 3..6]);
        all.add([0.15, 0.25]);
        all.tidy(&TIMES);
        assert_eq!(all.stretches().len(), 1, "nothing but selected keys lies between them");
        assert_eq!(all.count(&TIMES), 6);
    }

    #[test]
    fn the_next_key_is_the_one_that_a_linear_search_finds() {
        let seed = dragonfly_kit::random::seed(7);
        let mut random = dragonfly_kit::random::Random::new(seed);
        for _ in 0..2000 {
            let stretches: Vec<[f32; 2]> = (0..random.below(4))
                .map(|_| {
                    let from = random.between(-0.1, 0.6);
                    [from, from + random.between(0.0, 0.3)]
                })
                .collect();
            let intervals = Intervals::of(stretches);
            for index in 0..TIMES.len() {
                for selected in [true, false] {
                    let slow = (index..TIMES.len()).find(|&at| intervals.holds(TIMES[at]) == selected);
                    assert_eq!(
                        intervals.next(&TIMES, index, selected),
                        slow,
                        "seed {seed} {intervals:?} {index} {selected}"
                    );
                }
            }
        }
    }
}
