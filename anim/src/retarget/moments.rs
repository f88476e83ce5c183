//! When the values of several channels together are written down.

use crate::data::{Channel, Interpolation};

/// Between two keys whose product is not a straight line, so many values a second are written down ...
const PER_SECOND: f32 = 60.0;

/// ... but not more than so many, so that the work stays in proportion to the keys.
const MOST_BETWEEN: f32 = 16.0;

/// The key times of channels whose values are combined.
#[derive(Default)]
pub(super) struct Moments {
    times: Vec<f32>,
    /// The last moment before each key of a step channel.
    before_steps: Vec<f32>,
    /// Of the channels with more than one key.
    kinds: Vec<Interpolation>,
}

impl Moments {
    /// One more channel that counts.
    pub(super) fn add<T: Copy>(&mut self, channel: &Channel<T>) {
        self.times.extend_from_slice(&channel.times);
        if channel.interpolation == Interpolation::Step {
            self.before_steps.extend(channel.times.iter().skip(1).map(|time| time.next_down()));
        }
        if channel.len() > 1 {
            self.kinds.push(channel.interpolation);
        }
    }

    /// When to sample, ascending, each once, and how the samples are combined: at every key; just before each step, where
    /// others do not step; and between, where the way from key to key is `bent` or a channel is curved.
    pub(super) fn all(mut self, bent: bool) -> (Vec<f32>, Interpolation) {
        let only_steps = self.kinds.iter().all(|&kind| kind == Interpolation::Step);
        if !only_steps {
            self.times.append(&mut self.before_steps);
        }
        self.times.retain(|time| time.is_finite());
        self.times.sort_by(f32::total_cmp);
        self.times.dedup();
        if only_steps {
            return (self.times, Interpolation::Step);
        }
        let straight = |&kind: &Interpolation| matches!(kind, Interpolation::Linear | Interpolation::Step);
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
