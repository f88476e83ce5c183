//! The times at which a combination of several channels is sampled.

use crate::data::{Channel, Interpolation};

/// Number of samples per second between two keys whose product is not linear; at most [`MOST_BETWEEN`] are made.
const PER_SECOND: f32 = 60.0;

/// Largest number of samples between two keys, so that the work stays in proportion to the number of keys.
const MOST_BETWEEN: f32 = 16.0;

/// The key times of the channels that are combined.
#[derive(Default)]
pub(super) struct SampleTimes {
    times: Vec<f32>,
    /// The last time before each key of a step channel.
    before_steps: Vec<f32>,
    /// Interpolations of the channels with more than one key.
    kinds: Vec<Interpolation>,
}

impl SampleTimes {
    /// Adds one channel.
    pub(super) fn add<T: Copy>(&mut self, channel: &Channel<T>) {
        self.times.extend_from_slice(&channel.times);
        if channel.interpolation == Interpolation::Step {
            self.before_steps.extend(channel.times.iter().skip(1).map(|time| time.next_down()));
        }
        if channel.len() > 1 {
            self.kinds.push(channel.interpolation);
        }
    }

    /// Returns the sample times, ascending, each once, and the interpolation of the samples: at every key; just before
    /// each step, where other channels do not step; and between, where the path from key to key is `bent` or a channel
    /// is curved.
    pub(super) fn all(mut self, bent: bool) -> (Vec<f32>, Interpolation) {
        let only_steps = self.kinds.iter().all(|&char_class| char_class == Interpolation::Step);
        if !only_steps {
            self.times.append(&mut self.before_steps);
        }
        self.times.retain(|time| time.is_finite());
        self.times.sort_by(f32::total_cmp);
        self.times.dedup();
        if only_steps {
            return (self.times, Interpolation::Step);
        }
        let straight =
            |&char_class: &Interpolation| matches!(char_class, Interpolation::Linear | Interpolation::Step);
        let bent = bent || !self.kinds.iter().all(straight);
        (if bent { with_times_between(&self.times) } else { self.times }, Interpolation::Linear)
    }
}

fn with_times_between(times: &[f32]) -> Vec<f32> {
    let mut all = Vec::with_capacity(times.len());
    for pair in times.windows(2) {
        let span = pair[1] - pair[0];
        let parts = (span * PER_SECOND).ceil().clamp(1.0, MOST_BETWEEN) as u16;
        all.extend((0..parts).map(|part| pair[0] + span * (f32::from(part) / f32::from(parts))));
    }
    all.extend(times.last());
    all.dedup();
    all
}
