//! Neighboring rotations of opposite sign: the same pose, but interpolation that ignores the sign goes the long way
//! round.

use crate::check::channels::{channel_path, keys};
use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        let mut before: Option<glam::Quat> = None;
        for (key, time, rotation) in keys(&track.rotation) {
            // Keys half a turn apart are on the border, where rounding decides.
            if before.is_some_and(|before| before.dot(rotation) < -1e-3) {
                let text = || format!("at {time} s: opposite hemisphere of the key before");
                findings.add(|| (channel_path(of, number, 1).then(PathKind::Key, key, ""), text()));
            }
            before = Some(rotation);
        }
    }
}
