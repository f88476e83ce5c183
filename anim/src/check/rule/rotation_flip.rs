//! Neighboring rotations of opposite sign: the same pose, but interpolation that ignores the sign goes the long way
//! round.

use crate::check::column::{channel_place, keys};
use crate::check::{Findings, Kind, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        let mut before: Option<glam::Quat> = None;
        for (key, time, rotation) in keys(&track.rotation) {
            // Keys half a turn apart are on the border, where rounding decides.
            if before.is_some_and(|before| before.dot(rotation) < -1e-3) {
                let text = || format!("at {time} s: opposite hemisphere of the key before");
                findings.add(|| (channel_place(of, number, 1).then(Kind::Key, key, ""), text()));
            }
            before = Some(rotation);
        }
    }
}
