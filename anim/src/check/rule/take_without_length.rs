//! Takes of length zero.

use crate::check::{Findings, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    if of.take.length == 0.0 {
        let keys = of.take.keys();
        findings.add(|| (of.path(), format!("0 s long, with {keys} keys")));
    }
}
