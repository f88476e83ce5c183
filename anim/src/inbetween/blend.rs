//! Keys that move toward or away from their neighbors.

use super::KeyValue;
use std::ops::Range;

/// The target toward which [`blend_keys`] moves keys.
///
/// The neighbors of a key are the keys before and after the unbroken row of chosen keys that it belongs to. Where such a row is at the
/// end of the channel, its own first or last key takes the place of the missing one. `u` is the part of the time between the two
/// neighbors that has passed at the key, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlendTarget<'a, T> {
    /// The value this part of the way from the neighbor before to the one after: 0 is the one before, 1 the one after (breakdown,
    /// tween).
    Between(f64),
    /// Away from the straight line between the neighbors (push); with a factor of -1 onto it (pull).
    AwayFromLine,
    /// The straight line between the keys directly before and after, chosen or not (relax). The end keys of a channel stay.
    Average,
    /// The neighbor before.
    Previous,
    /// The neighbor after.
    Next,
    /// A slow start and a fast end between the neighbors: `u³` of the way.
    SlowStart,
    /// A fast start and a slow end between the neighbors: `1 - (1 - u)³` of the way.
    SlowEnd,
    /// These values, one for each chosen key: another pose, another take, the same curve at another time.
    Values(&'a [T]),
}

/// Returns the new values of the `chosen` keys, ascending positions in a channel with these `times` and `values`, one per key.
///
/// ```text
/// y = mix(x, target, factor)
/// ```
///
/// With a factor of 1 they are at the target, with 0 where they were, bit for bit. Larger factors go beyond, negative ones away.
#[doc(alias("breakdown", "tween", "push", "relax"))]
pub fn blend_keys<T: KeyValue>(
    times: &[f32],
    values: &[T],
    chosen: &[u32],
    target: BlendTarget<'_, T>,
    factor: f64,
) -> Vec<T> {
    let mut blended = Vec::with_capacity(chosen.len());
    for row in rows(chosen) {
        let (first, last) = (chosen[row.start] as usize, chosen[row.end - 1] as usize);
        let (before, after) = (first.saturating_sub(1), (last + 1).min(values.len() - 1));
        let line = |from: usize, to: usize, key: usize, ease: &dyn Fn(f64) -> f64| {
            T::mix(values[from], values[to], ease(passed(times, from, to, key)))
        };
        for at in row {
            let (key, value) = (chosen[at] as usize, values[chosen[at] as usize]);
            let wanted = match target {
                BlendTarget::Between(part) => T::mix(values[before], values[after], part),
                BlendTarget::AwayFromLine => {
                    let on_line = line(before, after, key, &|part| part);
                    blended.push(if factor == 0.0 { value } else { T::mix(on_line, value, 1.0 + factor) });
                    continue;
                }
                BlendTarget::Average if key == 0 || key + 1 == values.len() => value,
                BlendTarget::Average => line(key - 1, key + 1, key, &|part| part),
                BlendTarget::Previous => values[before],
                BlendTarget::Next => values[after],
                BlendTarget::SlowStart => line(before, after, key, &|part| part * part * part),
                BlendTarget::SlowEnd => {
                    line(before, after, key, &|part| 1.0 - (1.0 - part) * (1.0 - part) * (1.0 - part))
                }
                BlendTarget::Values(wanted) => wanted.get(at).copied().unwrap_or(value),
            };
            blended.push(T::mix(value, wanted, factor));
        }
    }
    blended
}

/// Returns the unbroken rows of `chosen`, as ranges of its positions.
fn rows(chosen: &[u32]) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    std::iter::from_fn(move || {
        let begin = start;
        let first = *chosen.get(begin)?;
        let follows = |&(at, &key): &(usize, &u32)| (key - first) as usize == at;
        start += chosen[begin..].iter().enumerate().take_while(follows).count();
        Some(begin..start)
    })
}

/// Returns the part of the time from one key to another that has passed at a third.
fn passed(times: &[f32], from: usize, to: usize, key: usize) -> f64 {
    let [from, to, at] = [from, to, key].map(|key| f64::from(times[key]));
    if to > from { (at - from) / (to - from) } else { 0.0 }
}
