//! Replaces each channel's keys by the fewest that the other channels allow.
//!
//! While the other channels stay as they are, whether two keys can be neighbors depends on nothing but the frames
//! between them. So the keys are nodes, the allowed gaps are edges of length one, and the fewest keys are the shortest
//! path from the start to the end of the channel.

use super::channel_keys::Gap;
use super::search::KeySearch;

/// Number of consecutive gaps that are not allowed after which longer ones are not tried: a longer gap is nearly always
/// worse.
const PATIENCE: usize = 4;

/// Largest amount of work, in bones moved on a frame, for all channels together: a few seconds. After that the
/// remaining channels stay as they are; minimizing them would remove only the last few percent of the keys.
const WORK: u64 = 20_000_000;

/// Optimizes every channel once, those with most keys first.
pub(super) fn minimize_keys(search: &mut KeySearch<'_>) {
    search.work = 0;
    let mut order: Vec<usize> = (0..search.columns.len()).collect();
    order.sort_by_key(|&column| std::cmp::Reverse(search.columns[column].count));
    for column in order {
        // Two keys or fewer cannot be improved: a first and a last that differ are needed.
        if search.columns[column].count > 2 && !search.is_closest(column) {
            shortest(search, column);
        }
    }
}

/// Computes the shortest path for one channel, and uses it when it has fewer keys than the channel.
fn shortest(search: &mut KeySearch<'_>, column: usize) {
    let first = search.columns[column].keys().next().unwrap_or(0);
    let last = search.columns[column].keys().last().unwrap_or(0);
    let keys: Vec<usize> = (first..=last).collect();
    // For each key: the fewest keys up to it, and the one before it on that path.
    let mut best: Vec<(usize, usize)> = vec![(usize::MAX, 0); keys.len()];
    best[0] = (1, 0);
    for from in 0..keys.len() {
        if search.work > WORK {
            return;
        }
        if best[from].0 == usize::MAX || !search.can_have_key(column, keys[from]) {
            continue;
        }
        let mut refused = 0;
        for to in from + 1..keys.len() {
            let gap = Gap { before: Some(keys[from]), after: Some(keys[to]) };
            if search.cost(column, gap).is_none() {
                refused += 1;
                if refused == PATIENCE {
                    break;
                }
                continue;
            }
            refused = 0;
            if best[from].0 + 1 < best[to].0 {
                best[to] = (best[from].0 + 1, from);
            }
        }
    }
    let (count, _) = best[keys.len() - 1];
    if count >= search.columns[column].count {
        return;
    }
    let mut path = vec![keys.len() - 1];
    while let Some(&at) = path.last()
        && at > 0
    {
        path.push(best[at].1);
    }
    let keys_kept: Vec<usize> = path.into_iter().rev().map(|at| keys[at]).collect();
    search.set_keys(column, &keys_kept);
}
