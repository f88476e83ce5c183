//! Search of the two keys around a time, and the fraction between them.
//!
//! Thesis §2.1.5.2: "two key-frames are selected, one just before the current time and one directly after".
//!
//! ```text
//! before = the last key with  times[before] <= time
//! after  = before + 1
//! mix    = (time - times[before]) / (times[after] - times[before])
//! ```

/// The keys around a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keys {
    /// The last key at or before the time; the first key when the time is before all.
    pub before: usize,
    /// The next key; the same key as `before` where the time is outside all keys.
    pub after: usize,
    /// Fraction of the time from `before` to `after`, 0 ≤ mix ≤ 1; 0 on a key and outside the keys.
    pub mix: f32,
}

impl Keys {
    /// Returns keys for a time exactly on one key, or outside the keys.
    pub(crate) fn on(key: usize) -> Self {
        Self { before: key, after: key, mix: 0.0 }
    }
}

/// Finds the keys around `time` seconds in ascending `times`, by binary search; `None` when there is no key.
///
/// NaN counts as before the first key. Times that do not ascend give some key, never a panic.
#[allow(clippy::neg_cmp_op_on_partial_ord, reason = "the negation is how NaN is caught")]
pub fn find_keys(times: &[f32], time: f32) -> Option<Keys> {
    let (&first, &last) = (times.first()?, times.last()?);
    // Written so that a NaN on either side returns here.
    if !(time > first) {
        return Some(Keys::on(0));
    }
    if !(time < last) {
        return Some(Keys::on(times.len() - 1));
    }
    let before = times.partition_point(|&key| key <= time).saturating_sub(1);
    Some(between(times, before, time))
}

fn between(times: &[f32], before: usize, time: f32) -> Keys {
    let after = (before + 1).min(times.len() - 1);
    Keys { before, after, mix: mix_factor(times[before], times[after], time) }
}

/// The place of the last search, so that one for a time a little later needs no search.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeyCursor {
    before: usize,
}

impl KeyCursor {
    /// Finds the keys around `time` seconds, as [`find_keys`] does. It is quick where `time` is at most two keys after
    /// the last one.
    pub(crate) fn find(&mut self, times: &[f32], time: f32) -> Option<Keys> {
        let near = times.get(self.before..).unwrap_or_default();
        let found = near.windows(2).take(3).position(|pair| pair[0] <= time && time < pair[1]);
        let is_first = times.first() == Some(&time);
        let keys = match found {
            Some(further) if !is_first => between(times, self.before + further, time),
            _ => find_keys(times, time)?,
        };
        self.before = keys.before;
        Some(keys)
    }
}

/// Returns `(time - before) / (after - before)`, 0..=1; 0 where that is undefined (both keys at the same time).
pub(crate) fn mix_factor(before: f32, after: f32, time: f32) -> f32 {
    let span = after - before;
    let mix = if span.is_finite() {
        (time - before) / span
    } else {
        // The difference of very distant keys exceeds the range of f32; half of it does not.
        (time * 0.5 - before * 0.5) / (after * 0.5 - before * 0.5)
    };
    // NaN fails both comparisons.
    if mix >= 1.0 {
        1.0
    } else if mix > 0.0 {
        mix
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(before: usize, after: usize, mix: f32) -> Option<Keys> {
        Some(Keys { before, after, mix })
    }

    #[test]
    fn a_time_between_two_keys_finds_both_keys_and_the_fraction_between_them() {
        let times = [0.0, 1.0, 3.0, 4.0];
        assert_eq!(find_keys(&times, 0.25), keys(0, 1, 0.25));
        assert_eq!(find_keys(&times, 1.5), keys(1, 2, 0.25));
        assert_eq!(find_keys(&times, 3.75), keys(2, 3, 0.75));
    }

    #[test]
    fn a_time_on_a_key_finds_that_key_with_mix_zero() {
        let times = [0.5, 1.0, 3.0, 4.0];
        assert_eq!(find_keys(&times, 0.5), keys(0, 0, 0.0));
        assert_eq!(find_keys(&times, 1.0), keys(1, 2, 0.0));
        assert_eq!(find_keys(&times, 4.0), keys(3, 3, 0.0));
    }

    #[test]
    fn a_time_outside_the_keys_finds_the_nearest_key() {
        let times = [0.5, 1.0];
        for time in [0.0, -7.0, f32::NEG_INFINITY, f32::NAN] {
            assert_eq!(find_keys(&times, time), keys(0, 0, 0.0), "{time}");
        }
        for time in [1.5, f32::MAX, f32::INFINITY] {
            assert_eq!(find_keys(&times, time), keys(1, 1, 0.0), "{time}");
        }
        assert_eq!(find_keys(&[], 0.0), None);
        assert_eq!(find_keys(&[2.0], 3.0), keys(0, 0, 0.0));
    }

    #[test]
    fn keys_whose_distance_overflows_f32_are_still_mixed() {
        assert_eq!(find_keys(&[f32::MIN, f32::MAX], 0.0), keys(0, 1, 0.5));
    }

    #[test]
    fn a_cursor_finds_what_the_search_finds() {
        let times = [0.0, 0.5, 0.75, 1.0, 2.0, 3.0, 3.5, 7.0];
        for step in [1_u16, 3, 20, 400] {
            let mut cursor = KeyCursor::default();
            for at in (0..1000_u16).step_by(usize::from(step)).chain([0, 700, 300]) {
                let time = f32::from(at) * 0.01 - 1.0;
                assert_eq!(cursor.find(&times, time), find_keys(&times, time), "{time}");
            }
            assert_eq!(cursor.find(&times, f32::NAN), find_keys(&times, f32::NAN));
            assert_eq!(cursor.find(&times[..2], 0.25), find_keys(&times[..2], 0.25), "of another channel");
            assert_eq!(cursor.find(&[], 0.25), None);
        }
    }

    #[test]
    fn the_fraction_between_two_keys_is_zero_where_it_is_undefined() {
        let hostile = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        for (before, after, time) in [
            (1.0, 1.0, 1.0),
            (0.0, hostile[0], 1.0),
            (hostile[0], 1.0, 0.0),
            (hostile[2], 1.0, 0.0),
            (hostile[2], hostile[1], 0.0),
        ] {
            assert_eq!(mix_factor(before, after, time), 0.0, "{before} {after} {time}");
        }
        assert_eq!(mix_factor(0.0, 1.0, 2.0), 1.0, "keys out of order");
    }

    #[test]
    fn keys_at_one_time_and_unordered_keys_give_existing_keys_and_a_valid_fraction() {
        for times in [vec![1.0, 1.0, 1.0], vec![0.0, 1.0, 1.0, 2.0], vec![3.0, f32::NAN, 1.0, 5.0]] {
            for step in 0..=60 {
                let found = find_keys(&times, step as f32 * 0.1).unwrap();
                assert!(found.after < times.len() && (0.0..=1.0).contains(&found.mix), "{times:?} {found:?}");
            }
        }
    }
}
