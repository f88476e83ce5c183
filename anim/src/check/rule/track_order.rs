//! Tracks that are not at the position of their bone, where sampling expects them.

use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    let (tracks, bones) = (&of.take.tracks, of.skeleton.len());
    let named: std::collections::BTreeSet<u32> = tracks.iter().map(|track| track.bone).collect();
    // Tracks of missing bones, and duplicate tracks, have rules of their own.
    let each_once = named.len() == tracks.len() && named.iter().all(|&bone| (bone as usize) < bones);
    if !each_once {
        return;
    }
    if tracks.len() != bones {
        findings.add(|| (of.path(), format!("{} tracks for {bones} bones", tracks.len())));
    }
    for (number, track) in tracks.iter().enumerate().filter(|(number, track)| track.bone as usize != *number)
    {
        let text = || format!("the track of bone {} is not at the position of the bone", track.bone);
        findings.add(|| (of.path().then(PathKind::Track, number, ""), text()));
    }
}
