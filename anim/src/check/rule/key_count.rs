//! Times without values, and values without times.

use crate::check::channels::channels;
use crate::check::{Findings, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for channel in channels(of) {
        let (times, values) = (channel.times.len(), channel.len());
        if times.checked_mul(channel.values_per_key()) != Some(values) {
            findings.add(|| (channel.path(of), format!("{values} values for {times} keys")));
        }
    }
}
