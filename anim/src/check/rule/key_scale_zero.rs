//! Keys that flatten a bone and all its descendants, often used to hide something.

use super::is_flat;
use crate::check::column::{channel_place, keys};
use crate::check::{Findings, Kind, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        for (key, time, scale) in keys(&track.scale).filter(|(_, _, scale)| is_flat(*scale)) {
            let text = || format!("at {time} s: scale {scale}");
            findings.add(|| (channel_place(of, number, 2).then(Kind::Key, key, ""), text()));
        }
    }
}
