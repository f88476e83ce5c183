//! A sampled curve beyond its ends.

use super::KeyValue;

/// Returns the samples with `margin` more at either end: the curve reflected about its end, in time and in value, as
/// `scipy.signal` does for `filtfilt` (`padtype='odd'`). A margin longer than the curve reflects it repeatedly.
///
/// ```text
/// extended(-i)    = 2 * x(0) - extended(i)
/// extended(m + i) = 2 * x(m) - extended(m - i)          m: the last sample
/// ```
///
/// Each value has the sign nearer to the one before ([`KeyValue::near`]).
pub fn extended<T: KeyValue>(samples: &[T], margin: usize) -> Vec<T> {
    let (Some(&first), Some(&last)) = (samples.first(), samples.last()) else { return Vec::new() };
    let mut all = vec![first; samples.len() + 2 * margin];
    all[margin..margin + samples.len()].copy_from_slice(samples);
    let end = margin + samples.len() - 1;
    for distance in 1..=margin {
        // Within one length of the curve both are samples; beyond it, they are values set before.
        if samples.len() > 1 {
            all[end + distance] = all[end - distance].reflected(last);
            all[margin - distance] = all[margin + distance].reflected(first);
        }
    }
    for at in 1..all.len() {
        all[at] = all[at].near(all[at - 1]);
    }
    all
}
