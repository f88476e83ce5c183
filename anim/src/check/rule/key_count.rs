//! Times without values, and values without times.

use crate::check::column::columns;
use crate::check::{Findings, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    for column in columns(of) {
        let (times, values) = (column.times.len(), column.len());
        if times.checked_mul(column.values_per_key()) != Some(values) {
            findings.add(|| (column.place(of), format!("{values} values for {times} keys")));
        }
    }
}
