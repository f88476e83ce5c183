//! Two keys at the same time: which of them counts is undefined.

use crate::check::measure::neighbors;
use crate::check::{Findings, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    neighbors(of, |path, before, after| {
        if after == before {
            findings.add(|| (path(), format!("at {after} s, as the one before it")));
        }
    });
}
