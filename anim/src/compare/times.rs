//! The times at which two takes are compared.

use crate::data::Take;

/// Longest time between two samples, seconds: a 120th, so that a curve cannot bulge unseen between two keys.
pub const LONGEST_GAP: f32 = 1.0 / 120.0;

/// Largest number of bones × samples of one comparison. Above it, samples between keys are left out first; if that is
/// not enough, key times are left out evenly.
pub const MOST_SAMPLES: usize = 50_000_000;

/// Returns the times at which takes with `bones` bones are compared, ascending, without repetition; at least one.
pub fn sample_times(first: &Take, second: &Take, bones: usize) -> Vec<f32> {
    sample_times_within(first, second, bones, MOST_SAMPLES)
}

/// Returns `count` times at even distances, from the start of the earlier take to the end of the later one, ascending; at least one.
pub fn even_times(first: &Take, second: &Take, count: usize) -> Vec<f32> {
    let start = f64::from(first.start.min(second.start));
    let length = f64::from(first.end().max(second.end())) - start;
    let last = count.max(1) - 1;
    let step = if last > 0 { length / last as f64 } else { 0.0 };
    (0..=last).map(|at| (start + step * at as f64) as f32).collect()
}

/// Returns the times as [`sample_times`] does, for at most `most` bones × samples.
pub(super) fn sample_times_within(first: &Take, second: &Take, bones: usize, most: usize) -> Vec<f32> {
    let mut keys = Vec::new();
    for take in [first, second] {
        for track in &take.tracks {
            let channels = [&track.translation.times, &track.rotation.times, &track.scale.times];
            channels.into_iter().for_each(|times| keys.extend_from_slice(times));
        }
        take.morphs.iter().for_each(|track| keys.extend_from_slice(&track.times));
        keys.extend([take.start, take.end()]);
    }
    keys.retain(|time| time.is_finite());
    keys.sort_by(f32::total_cmp);
    keys.dedup();
    let most = (most / bones.max(1)).max(2);
    let steps = |from: f32, to: f32| (((to - from) / LONGEST_GAP).ceil()).clamp(1.0, 1e9) as usize;
    let wanted: usize =
        keys.windows(2).fold(1, |sum: usize, pair| sum.saturating_add(steps(pair[0], pair[1])));
    if wanted <= most {
        let mut times = Vec::with_capacity(wanted);
        for pair in keys.windows(2) {
            let count = steps(pair[0], pair[1]);
            times.extend((0..count).map(|step| pair[0] + (pair[1] - pair[0]) * (step as f32 / count as f32)));
        }
        times.extend(keys.last());
        return times;
    }
    if keys.len() > most {
        let last = keys.len() - 1;
        keys = (0..most).map(|index| keys[index * last / (most - 1)]).collect();
    }
    keys
}
