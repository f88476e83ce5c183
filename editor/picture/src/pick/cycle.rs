//! Repeated clicks on one place go through what lies behind.

use dragonfly_anim::data::BoneIndex;
use glam::Vec2;

/// Clicks this near to each other are on one place, points.
const SAME: f32 = 4.0;

/// Remembers where the last click was and what it chose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClickCycle {
    last: Option<(Vec2, BoneIndex)>,
}

impl ClickCycle {
    /// A click at `at` points on `hits`, the nearest first. The nearest, or after a click on the same place the one behind
    /// what that chose, and from the last on to the first. The pose may have changed in between; what was chosen and is not
    /// there any more begins anew. `None` when nothing is hit.
    pub fn click(&mut self, at: Vec2, hits: &[BoneIndex]) -> Option<BoneIndex> {
        let before = self.last.filter(|(place, _)| place.distance(at) <= SAME);
        let behind = |(_, chosen): (Vec2, BoneIndex)| {
            let position = hits.iter().position(|&bone| bone == chosen)?;
            hits.get((position + 1) % hits.len()).copied()
        };
        let bone = before.and_then(behind).or(hits.first().copied());
        // The first place stays the place, so that a hand that creeps does not carry it along.
        let place = before.map_or(at, |(place, _)| place);
        self.last = bone.map(|bone| (place, bone));
        bone
    }

    /// The next click begins anew: something else was chosen meanwhile.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
