//! Rotation keys that are not of unit length, and would scale.

use super::UNIT_TOLERANCE;
use crate::check::column::{channel_place, keys};
use crate::check::{Findings, Kind, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        for (key, time, rotation) in keys(&track.rotation) {
            let length = rotation.length();
            if length.is_finite() && (length - 1.0).abs() > UNIT_TOLERANCE {
                let text = || format!("at {time} s: length {length}");
                findings.add(|| (channel_place(of, number, 1).then(Kind::Key, key, ""), text()));
            }
        }
    }
}
