//! Rotation keys that are not of unit length, and would scale.

use crate::check::channels::{channel_path, keys};
use crate::check::measure::UNIT_TOLERANCE;
use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        for (key, time, rotation) in keys(&track.rotation) {
            let length = rotation.length();
            if length.is_finite() && (length - 1.0).abs() > UNIT_TOLERANCE {
                let text = || format!("at {time} s: length {length}");
                findings.add(|| (channel_path(of, number, 1).then(PathKind::Key, key, ""), text()));
            }
        }
    }
}
