//! Takes of length zero.

use crate::check::{Findings, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    if of.take.length == 0.0 {
        let keys = of.take.keys();
        findings.add(|| (of.place(), format!("0 s long, with {keys} keys")));
    }
}
