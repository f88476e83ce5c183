//! Descending key times: the key search assumes ascending ones and does not find them.

use super::neighbours;
use crate::check::{Findings, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    neighbours(of, |place, before, after| {
        if after < before {
            findings.add(|| (place(), format!("at {after} s, after one at {before} s")));
        }
    });
}
