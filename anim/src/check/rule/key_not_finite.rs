//! Non-finite keys, which sampling replaces.

use crate::check::column::columns;
use crate::check::{Findings, Kind, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    for column in columns(of) {
        let per_key = column.values_per_key();
        for (key, time) in column.times.iter().enumerate() {
            let mut values = key * per_key..(key + 1) * per_key;
            if !time.is_finite() || !values.all(|index| column.is_finite(index)) {
                let text = || format!("at {time} s: the time or a value is NaN or infinite");
                findings.add(|| (column.place(of).then(Kind::Key, key, ""), text()));
            }
        }
    }
    for (number, morph) in of.take.morphs.iter().enumerate() {
        if !morph.times.iter().chain(morph.weights.iter()).all(|value| value.is_finite()) {
            let text = || "a time or a weight is NaN or infinite".to_owned();
            findings.add(|| (of.place().then(Kind::MorphTrack, number, ""), text()));
        }
    }
}
