//! Several tracks for one bone.

use crate::check::{Findings, Kind, TakeOf};

pub(crate) fn look(of: &TakeOf<'_>, findings: &mut Findings) {
    let mut first = vec![None; of.skeleton.len()];
    for (number, track) in of.take.tracks.iter().enumerate() {
        let Some(slot) = first.get_mut(track.bone as usize) else { continue };
        if let Some(earlier) = *slot {
            let text = || format!("track {earlier} is of bone {} as well", track.bone);
            findings.add(|| (of.place().then(Kind::Track, number, ""), text()));
        } else {
            *slot = Some(number);
        }
    }
}
