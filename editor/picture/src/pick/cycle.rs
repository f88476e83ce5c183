//! Cycling through overlapping bones by repeated clicks at one position.

use dragonfly_anim::data::BoneIndex;
use glam::Vec2;

/// Largest distance between clicks at one position, points.
const SAME: f32 = 4.0;

/// Position and result of the last click.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClickCycle {
    last: Option<(Vec2, BoneIndex)>,
}

impl ClickCycle {
    /// Returns the bone chosen by a click at `at` points on `hits`, nearest first: the nearest, or for a click at the
    /// same position the one after the last result, continuing at the first after the last. The pose may have changed
    /// in between; if the last result is no longer hit, the cycle starts again. `None` when nothing is hit.
    pub fn click(&mut self, at: Vec2, hits: &[BoneIndex]) -> Option<BoneIndex> {
        let before = self.last.filter(|(place, _)| place.distance(at) <= SAME);
        let behind = |(_, chosen): (Vec2, BoneIndex)| {
            let position = hits.iter().position(|&bone| bone == chosen)?;
            hits.get((position + 1) % hits.len()).copied()
        };
        let bone = before.and_then(behind).or(hits.first().copied());
        // The position of the first click is kept, so that small movements of the mouse do not add up.
        let place = before.map_or(at, |(place, _)| place);
        self.last = bone.map(|bone| (place, bone));
        bone
    }

    /// Restarts the cycle, because the selection has changed in another way.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
