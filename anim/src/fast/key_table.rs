//! Key times with a table that finds the keys around any time in a few steps, without remembering the last one.

/// At least two key times, strictly ascending, and a table of search starts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct KeyTable {
    times: Vec<f32>,
    /// For each of equal pieces of the time from the first key to the last: the last key at or before it.
    table: Vec<u32>,
    pieces_per_second: f32,
}

/// A time between key `key` and the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KeyPosition {
    pub(super) key: usize,
    /// Fraction from `key` to the next, 0..=1.
    pub(super) mix: f32,
}

/// With more keys than these in one piece, bisection is faster than stepping.
const FEW: usize = 8;

impl KeyTable {
    /// Creates the table for `times`; `None` unless there are at least two, finite, strictly ascending, over a finite
    /// span.
    pub(super) fn new(times: Vec<f32>) -> Option<Self> {
        let (&first, &last) = (times.first()?, times.last()?);
        let ascends = times.windows(2).all(|pair| pair[0] < pair[1]) && times.len() >= 2;
        let pieces = times.len() - 1;
        let pieces_per_second = pieces as f32 / (last - first);
        if !ascends || !(last - first).is_finite() || !pieces_per_second.is_finite() {
            return None;
        }
        let mut key = 0;
        let table = (0..=pieces).map(|piece| {
            let start_key = first + piece as f32 / pieces_per_second;
            while key + 2 < times.len() && times[key + 1] <= start_key {
                key += 1;
            }
            key as u32
        });
        Some(Self { table: table.collect(), pieces_per_second, times })
    }

    /// Returns the times.
    pub(super) fn times(&self) -> &[f32] {
        &self.times
    }

    /// Returns the keys around `time`, clamped to the keys; NaN counts as before the first key. The same position as
    /// [`find_keys`](crate::sample::find_keys) returns, but at the end it is the last interval with `mix` 1.
    #[inline(always)]
    pub(super) fn find(&self, time: f32) -> KeyPosition {
        let times = self.times.as_slice();
        let [first, .., last] = times else { return KeyPosition { key: 0, mix: 0.0 } };
        // NaN becomes the first time.
        let time = time.max(*first).min(*last);
        let end = times.len() - 2;
        let piece = ((time - first) * self.pieces_per_second) as usize;
        let start_key = self.table.get(piece).map_or(end, |&key| key as usize);
        let key = self.step(start_key, time, piece);
        let (Some(&before), Some(&after)) = (times.get(key), times.get(key + 1)) else {
            return KeyPosition { key: 0, mix: 0.0 };
        };
        KeyPosition { key, mix: ((time - before) / (after - before)).clamp(0.0, 1.0) }
    }

    /// Returns the last key at or before `time`, at most the last but one, starting at a key near it.
    #[inline(always)]
    fn step(&self, start_key: usize, time: f32, piece: usize) -> usize {
        let (times, end) = (self.times.as_slice(), self.times.len() - 2);
        let mut key = start_key.min(end);
        // The table may be one key ahead by rounding.
        while key > 0 && times[key] > time {
            key -= 1;
        }
        let ahead = self.table.get(piece + 1).map_or(end, |&key| key as usize);
        if ahead > key + FEW {
            return times[..=end].partition_point(|&key| key <= time).saturating_sub(1);
        }
        while key < end && times[key + 1] <= time {
            key += 1;
        }
        key
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::find_keys;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_table_finds_the_same_keys_as_a_binary_search(
            mut times in prop::collection::vec(prop_oneof![-5_f32..5.0, 1.0_f32..1.01], 2..60),
            wanted in prop::collection::vec(-6_f32..6.0, 40),
        ) {
            times.sort_by(f32::total_cmp);
            times.dedup();
            prop_assume!(times.len() >= 2);
            let key_table = KeyTable::new(times.clone()).unwrap();
            for time in wanted.iter().copied().chain(times.iter().copied()).chain([f32::NAN, f32::INFINITY, -9e9]) {
                let (place, keys) = (key_table.find(time), find_keys(&times, time).unwrap());
                // At the last key, `find_keys` returns that key with mix 0, and the table the key before it with mix 1.
                let way = |key: usize, mix: f32| key as f32 + mix;
                prop_assert!((way(place.key, place.mix) - way(keys.before, keys.mix)).abs() < 1e-5, "{time}");
                prop_assert!(place.key + 1 < times.len() && (0.0..=1.0).contains(&place.mix));
            }
        }
    }

    #[test]
    fn only_ascending_finite_times_make_a_key_table() {
        for times in
            [vec![], vec![1.0], vec![1.0, 1.0], vec![2.0, 1.0], vec![0.0, f32::NAN], vec![f32::MIN, f32::MAX]]
        {
            assert!(KeyTable::new(times.clone()).is_none(), "{times:?}");
        }
        assert!(
            KeyTable::new(vec![0.0, 1e-45]).is_none(),
            "the number of pieces per second would be infinite"
        );
    }
}
