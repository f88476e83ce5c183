//! Keys that mirror a bone compared with its rest pose, so that it turns inside out on the way.

use crate::check::channels::{channel_path, keys};
use crate::check::measure::is_mirrored;
use crate::check::{Findings, PathKind, TakeContext};

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        let Some(bone) = of.skeleton.bones.get(track.bone as usize) else { continue };
        let at_rest = is_mirrored(bone.rest.scale);
        for (key, time, scale) in keys(&track.scale) {
            // A flat bone is neither mirrored nor unmirrored.
            if scale.min_element() != 0.0 && scale.max_element() != 0.0 && is_mirrored(scale) != at_rest {
                let text = || format!("at {time} s: scale {scale}, at rest {}", bone.rest.scale);
                findings.add(|| (channel_path(of, number, 2).then(PathKind::Key, key, ""), text()));
            }
        }
    }
}
