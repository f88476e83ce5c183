//! Finds the keys that a list of key sets selects.

use super::super::op::ChannelAddress;
use super::super::slot::TakeId;
use super::{EditError, Transaction, finite};
use crate::edit::target::{BoneRef, KeySet, Property, SAME_TIME};
use std::collections::HashMap;

/// Key sets that name the same channels, with all their times.
struct KeyGroup<'a> {
    bones: &'a [BoneRef],
    properties: &'a [Property],
    /// Seconds, sorted at the end.
    at: Vec<f32>,
    /// Sets with a range.
    ranges: Vec<&'a KeySet>,
}

impl Transaction {
    /// Returns the selected keys: each channel with any, and their positions, ascending. Takes time in proportion to
    /// the sets and to the selected keys.
    pub(crate) fn keys(
        &self,
        take: TakeId,
        sets: &[KeySet],
    ) -> Result<Vec<(ChannelAddress, Vec<u32>)>, EditError> {
        let mut found: Vec<(ChannelAddress, Vec<u32>)> = Vec::new();
        let mut indices: HashMap<(u32, Property), usize> = HashMap::new();
        for group in groups(sets)? {
            for address in self.channels(take, (group.bones, group.properties))? {
                let times = self.slot(take).times(address.bone, address.property);
                let index = *indices.entry((address.bone, address.property)).or_insert_with(|| {
                    found.push((address, Vec::new()));
                    found.len() - 1
                });
                let keys = &mut found[index].1;
                held_at(times, &group.at, keys);
                for set in &group.ranges {
                    held_between(times, set, keys);
                }
            }
        }
        for (_, keys) in &mut found {
            if !keys.is_sorted_by(|a, b| a < b) {
                keys.sort_unstable();
                keys.dedup();
            }
        }
        found.retain(|(_, keys)| !keys.is_empty());
        if found.is_empty() { Err(EditError::Nothing("no key is selected")) } else { Ok(found) }
    }
}

/// Groups consecutive sets of the same channels, so that many sets with one time each cost no more
/// than one set with many times.
fn groups(sets: &[KeySet]) -> Result<Vec<KeyGroup<'_>>, EditError> {
    let mut groups: Vec<KeyGroup<'_>> = Vec::new();
    for set in sets {
        for number in set.at.iter().flatten().chain(&set.from).chain(&set.to) {
            finite("a time", *number)?;
        }
        let same = |group: &&mut KeyGroup<'_>| group.bones == set.bones && group.properties == set.properties;
        let group = match groups.last_mut().filter(same) {
            Some(_) => groups.last_mut(),
            None => {
                let (bones, properties) = (&set.bones, &set.properties);
                groups.push(KeyGroup { bones, properties, at: Vec::new(), ranges: Vec::new() });
                groups.last_mut()
            }
        };
        let Some(group) = group else { continue };
        match &set.at {
            Some(at) if set.from.is_none() && set.to.is_none() => group.at.extend(at),
            _ => group.ranges.push(set),
        }
    }
    for group in &mut groups {
        if !group.at.is_sorted() {
            group.at.sort_unstable_by(f32::total_cmp);
        }
    }
    Ok(groups)
}

/// Adds the positions of the keys at the `wanted` times, which ascend, to `keys`.
fn held_at(times: &[f32], wanted: &[f32], keys: &mut Vec<u32>) {
    let mut from = 0;
    for &wanted in wanted {
        from += first(&times[from..], |time| time < wanted - 2.0 * SAME_TIME);
        for (key, &time) in times.iter().enumerate().skip(from) {
            if time > wanted + 2.0 * SAME_TIME {
                break;
            }
            if (wanted - time).abs() <= SAME_TIME {
                keys.push(key as u32);
            }
        }
    }
}

/// Adds the positions of the keys of a set with a range to `keys`.
fn held_between(times: &[f32], set: &KeySet, keys: &mut Vec<u32>) {
    let begin = set.from.map_or(0, |from| times.partition_point(|&time| time < from - SAME_TIME));
    let end = set.to.map_or(times.len(), |to| times.partition_point(|&time| time <= to + SAME_TIME));
    match &set.at {
        None => keys.extend(begin as u32..end.max(begin) as u32),
        Some(at) => {
            let mut at = at.clone();
            at.sort_unstable_by(f32::total_cmp);
            let mut held = Vec::new();
            held_at(times, &at, &mut held);
            keys.extend(held.into_iter().filter(|&key| (begin..end).contains(&(key as usize))));
        }
    }
}

/// Returns how many of the ascending `times` satisfy `is_before`. The number is usually small, so the search starts at
/// the front.
fn first(times: &[f32], is_before: impl Fn(f32) -> bool) -> usize {
    let mut reach = 1;
    while reach < times.len() && is_before(times[reach]) {
        reach *= 2;
    }
    let end = (reach + 1).min(times.len());
    times[..end].partition_point(|&time| is_before(time))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn the_search_finds_exactly_the_keys_that_a_key_set_contains() {
        let first = seed(12);
        for number in first..first + 300 {
            let mut random = Random::new(number);
            let mut time = 0.0;
            let times: Vec<f32> = (0..random.below(60))
                .map(|_| {
                    time += random.choice(&[2e-5, 4e-5, 1e-4, 0.01, 0.5]);
                    time
                })
                .collect();
            let any = |random: &mut Random| match random.below(3) {
                0 if !times.is_empty() => times[random.below(times.len())] + random.between(-6e-5, 6e-5),
                _ => random.between(-0.1, 2.0),
            };
            let count = random.below(20);
            let set = KeySet {
                at: (random.below(2) == 0).then(|| (0..count).map(|_| any(&mut random)).collect()),
                from: (random.below(3) == 0).then(|| any(&mut random)),
                to: (random.below(3) == 0).then(|| any(&mut random)),
                ..KeySet::default()
            };
            let sets = [set.clone()];
            let [group] = &groups(&sets).unwrap()[..] else { panic!("one group") };
            let mut keys = Vec::new();
            held_at(&times, &group.at, &mut keys);
            for set in &group.ranges {
                held_between(&times, set, &mut keys);
            }
            keys.sort_unstable();
            keys.dedup();
            let wanted: Vec<u32> =
                (0..times.len() as u32).filter(|&key| set.holds(times[key as usize])).collect();
            assert_eq!(keys, wanted, "seed {number}: {set:?} {times:?}");
        }
    }
}
