//! Removal of single values that are far from those around them.

use super::KeyValue;

/// Factor from the median deviation to the standard deviation of a normal distribution.
const TO_DEVIATION: f64 = 1.4826;

/// Returns the values with peaks replaced by the median of the values around them: the Hampel filter.
///
/// ```text
/// m(i) = the median of x(i - h) … x(i + h), each component for itself          h = window / 2
/// s(i) = 1.4826 * the median of |x(j) - m(i)| over the same values
/// y(i) = m(i) where |x(i) - m(i)| > threshold * s(i), otherwise x(i)
/// ```
///
/// `window` is a number of values, odd; an even one counts as the next. With a threshold of 0 every value becomes the median, as in
/// `scipy.signal.medfilt`. At the ends the window reaches as far to either side as to the end, so the first and the last value stay.
/// Values that are not replaced stay bit for bit.
#[doc(alias("outlier", "spike", "median", "hampel"))]
pub fn remove_peaks<T: KeyValue>(values: &[T], window: usize, threshold: f64) -> Vec<T> {
    let half = window / 2;
    let of = |at: usize| -> T {
        let value = values[at];
        let reach = half.min(at).min(values.len() - 1 - at);
        if reach == 0 {
            return value;
        }
        let around: Vec<[f64; 4]> =
            values[at - reach..=at + reach].iter().map(|other| other.near(value).numbers()).collect();
        let center: [f64; 4] = std::array::from_fn(|lane| median(around.iter().map(|numbers| numbers[lane])));
        let distance = |numbers: &[f64; 4]| {
            let squares = numbers.iter().zip(center).map(|(a, b)| (a - b) * (a - b));
            squares.sum::<f64>().sqrt()
        };
        let own = distance(&value.numbers());
        // Rounding is no deviation.
        let size = center.iter().map(|number| number * number).sum::<f64>().sqrt();
        let deviation = TO_DEVIATION * median(around.iter().map(distance));
        let peak = own > threshold * deviation && own > 1e-6 * size;
        if peak { T::of_numbers(center, value) } else { value }
    };
    (0..values.len()).map(of).collect()
}

/// Returns the middle one of an odd number of numbers.
fn median(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    let middle = numbers.len() / 2;
    *numbers.select_nth_unstable_by(middle, f64::total_cmp).1
}
