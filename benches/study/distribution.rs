//! Many durations, kept without losing the rare long ones.

use hdrhistogram::Histogram;
use std::time::Duration;

/// Durations from one nanosecond to a minute, each kept to three significant digits (Tene's HDR histogram).
#[derive(Clone)]
pub struct Distribution(Histogram<u64>);

/// The percentiles that are written down, and what they are called there.
pub const PERCENTILES: [(&str, f64); 4] = [("p50", 50.0), ("p90", 90.0), ("p99", 99.0), ("p99.9", 99.9)];

impl Default for Distribution {
    fn default() -> Self {
        Self::new()
    }
}

impl Distribution {
    /// Allocates all it will ever need, so that recording costs the same each time.
    pub fn new() -> Self {
        Self(Histogram::new_with_bounds(1, 60_000_000_000, 3).expect("the bounds are in order"))
    }

    /// Adds one; what is longer than a minute counts as a minute.
    pub fn record(&mut self, duration: Duration) {
        self.record_nanos(u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX));
    }

    /// Adds one, in nanoseconds.
    pub fn record_nanos(&mut self, nanoseconds: u64) {
        self.0.saturating_record(nanoseconds.max(1));
    }

    /// Adds all of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.0.add(&other.0).expect("all have the same bounds");
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        self.0.len()
    }

    /// The duration that `percent` of all do not exceed, in nanoseconds; 0 of none.
    pub fn percentile(&self, percent: f64) -> u64 {
        if self.0.is_empty() { 0 } else { self.0.value_at_percentile(percent) }
    }

    /// The longest, in nanoseconds; 0 of none.
    pub fn max(&self) -> u64 {
        self.0.max()
    }

    /// The average, in nanoseconds.
    pub fn mean(&self) -> f64 {
        self.0.mean()
    }
}
