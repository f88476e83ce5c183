//! Several tracks for one bone.

use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    let mut first = vec![None; of.skeleton.len()];
    for (number, track) in of.take.tracks.iter().enumerate() {
        let Some(slot) = first.get_mut(track.bone as usize) else { continue };
        if let Some(earlier) = *slot {
            let text = || format!("track {earlier} belongs to bone {} too", track.bone);
            findings.add(|| (of.path().then(PathKind::Track, number, ""), text()));
        } else {
            *slot = Some(number);
        }
    }
}
