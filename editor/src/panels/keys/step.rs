//! From key to key: found by search in each channel, so that it costs nothing to have many.

use super::channel;
use crate::panels::state::State;
use dragonfly_anim::data::BoneIndex;

/// Seconds: nearer to the time than this is the key that is left.
const NEAR: f32 = 1e-4;

impl State {
    /// The next key after the time shown, or the last before it: of the selected bones, or of all.
    pub(in crate::panels) fn key_beside(&self, forward: bool) -> Option<f32> {
        self.key_beside_of(self.time(), forward)
    }

    /// The same, beside another time than the one shown.
    pub(in crate::panels) fn key_beside_of(&self, now: f32, forward: bool) -> Option<f32> {
        let take = self.take()?;
        let beside = |times: &[f32]| {
            if forward {
                times.get(times.partition_point(|&key| key <= now + NEAR)).copied()
            } else {
                times.partition_point(|&key| key < now - NEAR).checked_sub(1).map(|at| times[at])
            }
        };
        let of_bone =
            |bone: BoneIndex| channel::channels(take, bone).filter_map(|id| beside(channel::times(take, id)));
        let nearest = |found: &mut dyn Iterator<Item = f32>| {
            found.reduce(|a, b| if (a < b) == forward { a } else { b })
        };
        if self.selected().is_some() {
            return nearest(&mut self.selection.bones().iter().flat_map(|&bone| of_bone(bone)));
        }
        let bones = take.tracks.iter().flat_map(|track| of_bone(track.bone));
        let morphs = take.morphs.iter().filter_map(|morph| beside(&morph.times));
        nearest(&mut bones.chain(morphs))
    }

    /// The next marker, or the one before.
    pub(in crate::panels) fn marker_beside(&self, forward: bool) -> Option<f32> {
        let (now, mut times) = (self.time(), self.markers().iter().map(|marker| marker.time));
        if forward { times.find(|&time| time > now + NEAR) } else { times.rfind(|&time| time < now - NEAR) }
    }
}
