//! Tracks whose bone does not exist.

use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        if track.bone as usize >= of.skeleton.len() {
            let text = || format!("there is no bone {}; the skeleton has {}", track.bone, of.skeleton.len());
            findings.add(|| (of.path().then(PathKind::Track, number, ""), text()));
        }
    }
}
