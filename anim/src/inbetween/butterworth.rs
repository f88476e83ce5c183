//! Smoothing by a Butterworth filter without delay.

use super::{KeyValue, extended};
use std::f64::consts::{FRAC_PI_2, PI};

/// A digital low-pass filter of Butterworth: sections of second order, one of first order where the order is odd.
#[derive(Clone, Debug, PartialEq)]
pub struct Butterworth {
    sections: Vec<Section>,
    order: usize,
}

/// One section: `y(i) = b0 x(i) + b1 x(i-1) + b2 x(i-2) - a1 y(i-1) - a2 y(i-2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Butterworth {
    /// Largest order.
    pub const LARGEST_ORDER: usize = 8;

    /// Returns the filter of an order, 1 to [`Self::LARGEST_ORDER`], with its cutoff as a part of half the sample rate, more than 0 and
    /// less than 1: at that frequency one pass lets 0.707 of the amplitude through. `None` outside of that.
    ///
    /// The analog poles `exp(iπ (2k + n + 1) / 2n)`, scaled by the warped cutoff `tan(π/2 * cutoff)`, go to the digital filter by the
    /// bilinear transform, as `scipy.signal.butter` does.
    pub fn low_pass(order: usize, cutoff: f64) -> Option<Self> {
        let fits = (1..=Self::LARGEST_ORDER).contains(&order) && cutoff > 0.0 && cutoff < 1.0;
        if !fits {
            return None;
        }
        let warped = libm::tan(FRAC_PI_2 * cutoff);
        let squared = warped * warped;
        let pair = |at: usize| {
            // Twice the damping of a pair of conjugate poles.
            let damping = 2.0 * libm::sin(PI * (2 * at + 1) as f64 / (2 * order) as f64);
            let scale = 1.0 / (1.0 + damping * warped + squared);
            let gain = squared * scale;
            let a = [2.0 * (squared - 1.0) * scale, (1.0 - damping * warped + squared) * scale];
            Section { b: [gain, 2.0 * gain, gain], a }
        };
        let mut sections: Vec<Section> = (0..order / 2).map(pair).collect();
        if order % 2 == 1 {
            let scale = 1.0 / (1.0 + warped);
            let gain = warped * scale;
            sections.push(Section { b: [gain, gain, 0.0], a: [(warped - 1.0) * scale, 0.0] });
        }
        Some(Self { sections, order })
    }

    /// Returns the number of samples by which the curve is extended at either end, the same as in SciPy.
    fn margin(&self) -> usize {
        3 * (self.order + 1)
    }

    /// Filters numbers in place. The state at the start is that of a signal that was always as the first one.
    fn pass(&self, numbers: &mut [[f64; 4]]) {
        for section in &self.sections {
            let Some(&first) = numbers.first() else { return };
            let Section { b, a } = section;
            // The gain of each section at frequency 0 is 1, so with constant input the output is the input.
            let mut state = [first.map(|x| (1.0 - b[0]) * x), first.map(|x| (b[2] - a[1]) * x)];
            for sample in numbers.iter_mut() {
                for lane in 0..4 {
                    let x = sample[lane];
                    let y = b[0] * x + state[0][lane];
                    state[0][lane] = b[1] * x - a[0] * y + state[1][lane];
                    state[1][lane] = b[2] * x - a[1] * y;
                    sample[lane] = y;
                }
            }
        }
    }
}

/// Returns evenly spaced samples without the frequencies above the cutoff of `filter`.
///
/// The filter runs forwards and backwards over the [`extended`] curve, so nothing is delayed and the amplitude at the cutoff is
/// halved; as `scipy.signal.filtfilt`.
#[doc(alias("low-pass", "filtfilt", "zero phase"))]
pub fn butterworth<T: KeyValue>(samples: &[T], filter: &Butterworth) -> Vec<T> {
    let margin = filter.margin();
    let mut numbers: Vec<[f64; 4]> = extended(samples, margin).into_iter().map(KeyValue::numbers).collect();
    for _ in 0..2 {
        filter.pass(&mut numbers);
        numbers.reverse();
    }
    let inner = numbers.iter().skip(margin);
    samples.iter().zip(inner).map(|(&sample, &numbers)| T::of_numbers(numbers, sample)).collect()
}
