//! Repeated clicks at one position cycle through the bones behind each other.

use dragonfly_anim::data::BoneIndex;
use glam::Vec2;

/// Distance within which clicks are at the same position, points.
const SAME: f32 = 4.0;

/// Position of the last click, and the bone that it selected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClickCycle {
    last: Option<(Vec2, BoneIndex)>,
}

impl ClickCycle {
    /// Returns the bone that a click at `at`, points, selects from `hits`, the nearest first: the nearest, or after a
    /// click at the same position the one behind the last one selected, and after the farthest the nearest again. If
    /// the pose changed and the last one is not hit any more, the cycle starts again. `None` if nothing is hit.
    pub fn click(&mut self, at: Vec2, hits: &[BoneIndex]) -> Option<BoneIndex> {
        let before = self.last.filter(|(place, _)| place.distance(at) <= SAME);
        let behind = |(_, chosen): (Vec2, BoneIndex)| {
            let position = hits.iter().position(|&bone| bone == chosen)?;
            hits.get((position + 1) % hits.len()).copied()
        };
        let bone = before.and_then(behind).or(hits.first().copied());
        // The first position stays the reference, so that a slowly moving pointer does not carry it along.
        let place = before.map_or(at, |(place, _)| place);
        self.last = bone.map(|bone| (place, bone));
        bone
    }

    /// Starts the cycle again, because the selection changed in another way.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
