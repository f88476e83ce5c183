//! Filters of keys at uneven times.

use super::{Butterworth, KeyValue, butterworth, gaussian, gaussian_radius, remove_peaks};

/// A filter of the values of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyFilter {
    /// Smooths by a Gaussian, see [`gaussian`].
    Gaussian {
        /// Standard deviation, seconds.
        sigma: f64,
    },
    /// Removes what is faster than a frequency, see [`butterworth`].
    Butterworth {
        /// Cutoff, Hz. At half the sample rate or more, nothing changes.
        cutoff: f64,
        /// Order, 1 to [`Butterworth::LARGEST_ORDER`].
        order: usize,
    },
    /// Removes single peaks, see [`remove_peaks`].
    Peaks {
        /// Number of keys that are looked at, odd.
        window: usize,
        /// Number of standard deviations from which on a key is a peak.
        threshold: f64,
    },
}

/// Even times over a channel: what a filter samples it at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformTimes {
    start: f64,
    rate: f64,
    count: usize,
}

impl UniformTimes {
    /// Largest number of samples.
    pub const LARGEST: usize = 1 << 20;

    /// Returns the times of `rate` samples per second from the first of the ascending `times` to the last, at least two. Without a
    /// rate they are as far apart as the keys, in the median, so on evenly set keys the samples are the keys. `None` where there are
    /// fewer than two keys, or more samples than [`Self::LARGEST`].
    pub fn over(times: &[f32], rate: Option<f64>) -> Option<Self> {
        let [first, .., last] = times else { return None };
        let [start, end] = [first, last].map(|&time| f64::from(time));
        let rate = rate.unwrap_or_else(|| 1.0 / median_distance(times));
        let steps = ((end - start) * rate - 1e-3).ceil().max(1.0);
        (steps < Self::LARGEST as f64).then(|| Self { start, rate, count: steps as usize + 1 })
    }

    /// Returns the number of samples per second.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Returns the number of samples.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the time of a sample, seconds. The last may be after the last key, where the channel keeps its value.
    pub fn at(&self, sample: usize) -> f32 {
        (self.start + sample as f64 / self.rate) as f32
    }

    /// Returns the value of sampled values at `time`: within a thousandth of a step the sample, elsewhere between two.
    fn value_at<T: KeyValue>(&self, samples: &[T], time: f32) -> T {
        let place = ((f64::from(time) - self.start) * self.rate).clamp(0.0, (self.count - 1) as f64);
        let nearest = place.round();
        if (place - nearest).abs() < 1e-3 {
            return samples[nearest as usize];
        }
        let before = place.floor();
        T::mix(samples[before as usize], samples[before as usize + 1], place - before)
    }
}

/// Returns the median distance of neighbors of the ascending `times`.
fn median_distance(times: &[f32]) -> f64 {
    let mut distances: Vec<f64> =
        times.windows(2).map(|pair| f64::from(pair[1]) - f64::from(pair[0])).collect();
    let middle = distances.len() / 2;
    distances.select_nth_unstable_by(middle, f64::total_cmp).1.max(1e-4)
}

/// Returns the filtered values of all keys of a channel; `None` where it has too few keys or too many samples, or the filter would
/// change nothing.
///
/// Filters that need even times sample the channel by `sample` at `uniform` times from its first key to its last, and the keys get the
/// values of the filtered samples at their times. [`KeyFilter::Peaks`] looks at the keys themselves, whatever their times.
pub fn filter_keys<T: KeyValue>(
    times: &[f32],
    values: &[T],
    filter: KeyFilter,
    uniform: Option<UniformTimes>,
    sample: impl Fn(f32) -> T,
) -> Option<Vec<T>> {
    let samples = |uniform: &UniformTimes| -> Vec<T> {
        let mut samples: Vec<T> = (0..uniform.count).map(|at| sample(uniform.at(at))).collect();
        for at in 1..samples.len() {
            samples[at] = samples[at].near(samples[at - 1]);
        }
        samples
    };
    let (uniform, filtered) = match filter {
        KeyFilter::Peaks { window, threshold } => return Some(remove_peaks(values, window, threshold)),
        KeyFilter::Gaussian { sigma } => {
            let uniform = uniform?;
            let sigma = sigma * uniform.rate;
            if gaussian_radius(sigma) == 0 {
                return None;
            }
            (uniform, gaussian(&samples(&uniform), sigma))
        }
        KeyFilter::Butterworth { cutoff, order } => {
            let uniform = uniform?;
            let filter = Butterworth::low_pass(order, 2.0 * cutoff / uniform.rate)?;
            (uniform, butterworth(&samples(&uniform), &filter))
        }
    };
    Some(times.iter().map(|&time| uniform.value_at(&filtered, time)).collect())
}
