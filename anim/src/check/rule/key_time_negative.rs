//! Keys before time 0, at which playing usually starts.

use crate::check::channels::channels;
use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for channel in channels(of) {
        // Only the first key of a channel is reported; further keys before 0 may follow it.
        if let Some((key, time)) =
            channel.times.iter().enumerate().find(|(_, time)| **time < 0.0 && time.is_finite())
        {
            findings.add(|| (channel.path(of).then(PathKind::Key, key, ""), format!("at {time} s")));
        }
    }
}
