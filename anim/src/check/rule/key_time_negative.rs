//! Keys before time 0, at which playing usually starts.

use crate::check::column::columns;
use crate::check::{Findings, Kind, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    for column in columns(of) {
        // Reported once per channel: the other keys before 0 follow.
        if let Some((key, time)) =
            column.times.iter().enumerate().find(|(_, time)| **time < 0.0 && time.is_finite())
        {
            findings.add(|| (column.place(of).then(Kind::Key, key, ""), format!("at {time} s")));
        }
    }
}
