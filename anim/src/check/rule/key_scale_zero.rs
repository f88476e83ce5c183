//! Keys that flatten a bone and all its descendants, often used to hide something.

use crate::check::channels::{channel_path, keys};
use crate::check::measure::is_flat;
use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        for (key, time, scale) in keys(&track.scale).filter(|(_, _, scale)| is_flat(*scale)) {
            let text = || format!("at {time} s: scale {scale}");
            findings.add(|| (channel_path(of, number, 2).then(PathKind::Key, key, ""), text()));
        }
    }
}
