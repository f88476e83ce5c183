//! Smoothing by a Gaussian.

use super::{KeyValue, extended};

/// Number of standard deviations after which the kernel ends, as in SciPy.
const TRUNCATE: f64 = 4.0;

/// Returns the number of samples to either side that [`gaussian`] averages over.
pub fn gaussian_radius(sigma: f64) -> usize {
    if sigma > 0.0 { (TRUNCATE * sigma + 0.5) as usize } else { 0 }
}

/// Returns evenly spaced samples smoothed by a Gaussian; `sigma` is its standard deviation in samples. Zero changes nothing.
///
/// ```text
/// y(i) = Σ w(j) * x(i + j) / Σ w(j)        w(j) = exp(-j² / (2 sigma²)),  |j| ≤ 4 sigma
/// ```
///
/// As `scipy.ndimage.gaussian_filter1d` of the [`extended`] curve. The first and the last value stay, and so does a straight line.
#[doc(alias("blur", "low-pass"))]
pub fn gaussian<T: KeyValue>(samples: &[T], sigma: f64) -> Vec<T> {
    let radius = gaussian_radius(sigma);
    if radius == 0 {
        return samples.to_vec();
    }
    let weight = |distance: usize| {
        let distance = distance as f64 / sigma;
        libm::exp(-0.5 * distance * distance)
    };
    let kernel: Vec<f64> = (0..=radius).map(weight).collect();
    let sum = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
    let extended: Vec<[f64; 4]> = extended(samples, radius).into_iter().map(KeyValue::numbers).collect();
    let smooth = |(at, &sample): (usize, &T)| {
        let window = &extended[at..at + 2 * radius + 1];
        let mut total = window[radius].map(|number| number * kernel[0]);
        for (distance, weight) in kernel.iter().enumerate().skip(1) {
            let (before, after) = (&window[radius - distance], &window[radius + distance]);
            for lane in 0..4 {
                total[lane] += (before[lane] + after[lane]) * weight;
            }
        }
        T::of_numbers(total.map(|number| number / sum), sample)
    };
    samples.iter().enumerate().map(smooth).collect()
}
