//! Two keys at the same time: which of them counts is undefined.

use super::neighbours;
use crate::check::{Findings, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    neighbours(of, |place, before, after| {
        if after == before {
            findings.add(|| (place(), format!("at {after} s, as the one before it")));
        }
    });
}
