//! Distributions of durations that keep the rare long ones.

use hdrhistogram::Histogram;
use std::time::Duration;

/// A histogram of durations from one nanosecond to one minute, with three significant digits (Tene's HDR histogram).
#[derive(Clone)]
pub struct Distribution(Histogram<u64>);

/// The recorded percentiles, with their names in the raw data.
pub const PERCENTILES: [(&str, f64); 4] = [("p50", 50.0), ("p90", 90.0), ("p99", 99.0), ("p99.9", 99.9)];

impl Default for Distribution {
    fn default() -> Self {
        Self::new()
    }
}

impl Distribution {
    /// Returns an empty distribution. Allocates all its memory, so that every call of `record` costs the same.
    pub fn new() -> Self {
        Self(Histogram::new_with_bounds(1, 60_000_000_000, 3).expect("the bounds are in order"))
    }

    /// Adds a duration, of at most one minute; longer ones count as one minute.
    pub fn record(&mut self, duration: Duration) {
        self.record_nanos(u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX));
    }

    /// Adds a duration in nanoseconds.
    pub fn record_nanos(&mut self, nanoseconds: u64) {
        self.0.saturating_record(nanoseconds.max(1));
    }

    /// Adds all durations of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.0.add(&other.0).expect("all have the same bounds");
    }

    /// Returns the number of durations.
    pub fn count(&self) -> u64 {
        self.0.len()
    }

    /// Returns the duration that `percent` of all do not exceed, in nanoseconds; 0 for an empty distribution.
    pub fn percentile(&self, percent: f64) -> u64 {
        if self.0.is_empty() { 0 } else { self.0.value_at_percentile(percent) }
    }

    /// Returns the longest duration in nanoseconds; 0 for an empty distribution.
    pub fn max(&self) -> u64 {
        self.0.max()
    }

    /// Returns the mean in nanoseconds.
    pub fn mean(&self) -> f64 {
        self.0.mean()
    }
}
