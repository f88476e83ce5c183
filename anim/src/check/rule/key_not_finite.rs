//! Non-finite keys, which sampling replaces.

use crate::check::channels::channels;
use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for channel in channels(of) {
        let per_key = channel.values_per_key();
        for (key, time) in channel.times.iter().enumerate() {
            let mut values = key * per_key..(key + 1) * per_key;
            if !time.is_finite() || !values.all(|index| channel.is_finite(index)) {
                let text = || format!("at {time} s: the time or a value is NaN or infinite");
                findings.add(|| (channel.path(of).then(PathKind::Key, key, ""), text()));
            }
        }
    }
    for (number, morph) in of.take.morphs.iter().enumerate() {
        if !morph.times.iter().chain(morph.weights.iter()).all(|value| value.is_finite()) {
            let text = || "a time or a weight is NaN or infinite".to_owned();
            findings.add(|| (of.path().then(PathKind::MorphTrack, number, ""), text()));
        }
    }
}
