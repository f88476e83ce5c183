//! Axes: positions of values in pixels.

use crate::amount;

/// Scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisScale {
    /// Linear, from zero.
    Linear,
    /// Logarithmic, for values that span more than a factor of about ten.
    Log,
}

/// Maps values to a range of pixels.
pub(super) struct ChartAxis {
    scale: AxisScale,
    low: f64,
    high: f64,
    from: i32,
    to: i32,
    unit: String,
}

impl ChartAxis {
    /// Returns an axis for all of `values` between the pixels `from` and `to`.
    pub(super) fn fit(
        values: impl Iterator<Item = f64>,
        scale: AxisScale,
        unit: &str,
        from: i32,
        to: i32,
    ) -> Self {
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for value in values.filter(|value| value.is_finite() && (scale == AxisScale::Linear || *value > 0.0))
        {
            low = low.min(value);
            high = high.max(value);
        }
        if high <= 0.0 {
            (low, high) = (1.0, 10.0);
        }
        match scale {
            AxisScale::Linear => (low, high) = (low.min(0.0), high * 1.05),
            // A margin on both sides, and at least a factor of four, so that similar values do not look far apart.
            AxisScale::Log => {
                (low, high) = (low / 1.25, high * 1.25);
                if high / low < 4.0 {
                    let middle = (low * high).sqrt();
                    (low, high) = (middle / 2.0, middle * 2.0);
                }
            }
        }
        Self { scale, low, high, from, to, unit: unit.to_owned() }
    }

    /// Returns the pixel of a value; the nearest end for a value outside, such as 0 on a logarithmic scale.
    pub(super) fn place(&self, value: f64) -> i32 {
        let part = match self.scale {
            AxisScale::Linear => (value - self.low) / (self.high - self.low),
            AxisScale::Log => (value.max(self.low) / self.low).ln() / (self.high / self.low).ln(),
        };
        self.from + (part.clamp(0.0, 1.0) * f64::from(self.to - self.from)).round() as i32
    }

    /// Returns the pixels of round values, with their labels; the label of a minor tick is empty.
    pub(super) fn ticks(&self) -> Vec<(i32, String)> {
        let within = |value: &f64| (self.low..=self.high).contains(value);
        let mut ticks = Vec::new();
        match self.scale {
            AxisScale::Linear => {
                // Round in the printed unit: 5 MiB, not 5,000,000 bytes.
                let size = amount::step(self.high, &self.unit);
                let rough = (self.high - self.low) / 5.0;
                let power = size * 10_f64.powf((rough / size).log10().floor());
                let step =
                    [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|step| *step >= rough);
                let step = step.unwrap_or(rough);
                let first = (self.low / step).ceil() as i64;
                for number in first..first + 12 {
                    let value = number as f64 * step;
                    ticks
                        .extend(within(&value).then(|| (self.place(value), amount::tick(value, &self.unit))));
                }
            }
            AxisScale::Log => {
                let few = self.high / self.low < 60.0;
                for power in self.low.log10().floor() as i32..=self.high.log10().ceil() as i32 {
                    for digit in 1..10 {
                        let value = f64::from(digit) * 10_f64.powi(power);
                        let named = digit == 1 || few && matches!(digit, 2 | 5);
                        let label = || if named { amount::tick(value, &self.unit) } else { String::new() };
                        ticks.extend(within(&value).then(|| (self.place(value), label())));
                    }
                }
            }
        }
        ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_labels_round_values_and_contains_all_values() {
        let log = ChartAxis::fit([900.0, 2e6].into_iter(), AxisScale::Log, "ns", 0, 1000);
        let named: Vec<String> =
            log.ticks().into_iter().map(|tick| tick.1).filter(|label| !label.is_empty()).collect();
        assert_eq!(named, ["1 µs", "10 µs", "100 µs", "1 ms"]);
        assert!(log.place(900.0) > 0 && log.place(2e6) < 1000);
        let decade = |from: f64| log.place(from * 10.0) - log.place(from);
        assert!((decade(1_000.0) - decade(10_000.0)).abs() <= 1);
        // A value that a logarithmic scale cannot show is at its end.
        assert_eq!(log.place(0.0), 0);

        let linear = ChartAxis::fit([0.0, 40.0].into_iter(), AxisScale::Linear, "count", 0, 420);
        assert_eq!(linear.ticks()[..2], [(0, "0".to_owned()), (100, "10".to_owned())]);
        let memory = ChartAxis::fit([5e7].into_iter(), AxisScale::Linear, "bytes", 0, 100);
        let named: Vec<String> = memory.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(named, ["0", "20 MiB", "40 MiB"]);
    }

    #[test]
    fn an_axis_without_positive_values_is_valid() {
        for scale in [AxisScale::Linear, AxisScale::Log] {
            let axis = ChartAxis::fit([0.0].into_iter(), scale, "ns", 0, 100);
            assert!(!axis.ticks().is_empty());
            assert!((0..=100).contains(&axis.place(0.0)));
        }
    }
}
