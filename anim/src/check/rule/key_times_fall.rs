//! Descending key times: the key search assumes ascending ones and does not find them.

use crate::check::measure::neighbors;
use crate::check::{Findings, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    neighbors(of, |path, before, after| {
        if after < before {
            findings.add(|| (path(), format!("at {after} s, after one at {before} s")));
        }
    });
}
