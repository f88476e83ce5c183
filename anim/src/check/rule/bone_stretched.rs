//! Translations that make a bone longer or shorter than at rest.
//!
//! ```text
//! length = |translation|                     from the parent's origin to the bone's
//! stretch = |length(key) / length(rest) − 1|   reported above 5 %, the worst key of a track
//! ```
//!
//! Roots have no length. A translation that turns without changing its length is not reported.

use crate::check::channels::{channel_path, keys};
use crate::check::{Findings, PathKind, TakeContext};

/// Fraction of the rest length.
const THRESHOLD: f32 = 0.05;

/// Bones shorter than this fraction of the longest are at their parent's origin, and have no length to keep.
const SHORTEST: f32 = 1e-3;

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    let with_parents = of.skeleton.bones.iter().filter(|bone| bone.parent.is_some());
    let longest = with_parents.map(|bone| bone.rest.translation.length()).fold(0.0, f32::max);
    for (number, track) in of.take.tracks.iter().enumerate() {
        let bone = of.skeleton.bones.get(track.bone as usize).filter(|bone| bone.parent.is_some());
        let Some(rest) = bone.map(|bone| bone.rest.translation.length()) else { continue };
        if rest.is_nan() || rest <= SHORTEST * longest {
            continue;
        }
        let stretch = |translation: glam::Vec3| (translation.length() / rest - 1.0).abs();
        let worst = keys(&track.translation)
            .filter(|(_, _, translation)| stretch(*translation) > THRESHOLD)
            .max_by(|a, b| stretch(a.2).total_cmp(&stretch(b.2)));
        if let Some((key, time, translation)) = worst.filter(|(_, _, translation)| translation.is_finite()) {
            let text = || format!("at {time} s: length {}, at rest {rest}", translation.length());
            findings.add(|| (channel_path(of, number, 0).then(PathKind::Key, key, ""), text()));
        }
    }
}
