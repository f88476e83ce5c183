//! The arrangement of tracks in groups of eight lanes that are decoded together.
//!
//! Usually a group is a block of the pose: eight neighboring bones, of which those that move have a track. Where only
//! few bones of several blocks move, their tracks share a group, and its results are scattered one by one. Writing and
//! reading use the same arrangement, so none of it is stored: this function is part of the format.

use super::stored::{PACKED, PARTS};
use crate::fast::simd::LANES;

/// Cost of decoding a group, and additional cost of scattering one of its lanes: of rotations, and of vectors. In
/// instructions, roughly.
const COSTS: [(usize, usize); 2] = [(138, 15), (85, 12)];

/// Tracks that are decoded together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LaneGroup {
    /// Bone of each lane; [`NONE`] where a lane has no track.
    pub(super) bones: [u32; LANES],
    /// Block of the pose whose lanes these are; `None` where they are from several.
    pub(super) block: Option<u32>,
    /// The blocks that share the group; none where the group is a block.
    pub(super) shared: Vec<SharedBlock>,
}

/// A block of the pose of which some lanes are in a group with lanes of other blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SharedBlock {
    pub(super) block: u32,
    /// For each lane of the block: [`PICKED`] and the lane of the group; 0 for a lane that is not in it.
    pub(super) lanes: [u32; LANES],
}

/// Marks a lane that is in the group.
const PICKED: u32 = 1 << 31;

impl SharedBlock {
    /// Returns the blocks of `bones`.
    fn all(bones: &[u32; LANES]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (lane, bone) in (0..).zip(bones).filter(|&(_, &bone)| bone != NONE) {
            let (block, place) = (bone / LANES as u32, *bone as usize % LANES);
            if all.last().is_none_or(|last| last.block != block) {
                all.push(Self { block, lanes: [0; LANES] });
            }
            if let Some(last) = all.last_mut() {
                last.lanes[place] = PICKED | lane;
            }
        }
        all
    }
}

/// Marks a lane without a bone.
pub(super) const NONE: u32 = u32::MAX;

/// Position of a track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TrackSlot {
    pub(super) part: usize,
    pub(super) group: usize,
    pub(super) lane: usize,
    pub(super) bone: usize,
}

/// Returns the groups of rotations, translations and scales, from the storage of each bone's channels. Those that are
/// blocks of the pose come first.
pub(super) fn groups(kinds: &[[u32; PARTS]]) -> [Vec<LaneGroup>; PARTS] {
    [0, 1, 2].map(|part| {
        let moves = |bone: &usize| kinds[*bone][part] == PACKED;
        arranged((0..kinds.len()).filter(moves), COSTS[part.min(1)])
    })
}

/// Returns every track in the order in which tracks are stored: group after group, lane after lane.
pub(super) fn slots(groups: &[Vec<LaneGroup>; PARTS]) -> Vec<TrackSlot> {
    let mut slots = Vec::new();
    for (part, groups) in groups.iter().enumerate() {
        for (group, LaneGroup { bones, .. }) in groups.iter().enumerate() {
            let lanes = bones.iter().enumerate().filter(|&(_, &bone)| bone != NONE);
            slots.extend(lanes.map(|(lane, &bone)| TrackSlot { part, group, lane, bone: bone as usize }));
        }
    }
    slots
}

fn arranged(bones: impl Iterator<Item = usize>, (group, lane): (usize, usize)) -> Vec<LaneGroup> {
    let mut blocks: Vec<LaneGroup> = Vec::new();
    for bone in bones {
        let block = Some((bone / LANES) as u32);
        if blocks.last().is_none_or(|last| last.block != block) {
            blocks.push(LaneGroup { bones: [NONE; LANES], block, shared: Vec::new() });
        }
        if let Some(last) = blocks.last_mut() {
            last.bones[bone % LANES] = bone as u32;
        }
    }
    let count = |block: &LaneGroup| block.bones.iter().filter(|&&bone| bone != NONE).count();
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by_key(|&at| count(&blocks[at]));
    // Finds out how many of the blocks, from the emptiest on, should share groups so that the cost is least.
    let (mut lanes, mut best, mut least) = (0, 0, blocks.len() * group);
    for (index, &at) in order.iter().enumerate() {
        lanes += count(&blocks[at]);
        let cost = (blocks.len() - index - 1 + lanes.div_ceil(LANES)) * group + lanes * lane;
        if cost < least {
            (best, least) = (index + 1, cost);
        }
    }
    let mut shares = vec![false; blocks.len()];
    order[..best].iter().for_each(|&at| shares[at] = true);
    let shared: Vec<u32> = (0..blocks.len())
        .filter(|&at| shares[at])
        .flat_map(|at| blocks[at].bones.into_iter().filter(|&bone| bone != NONE))
        .collect();
    let mut groups: Vec<LaneGroup> =
        blocks.into_iter().zip(shares).filter(|(_, shared)| !shared).map(|(block, _)| block).collect();
    groups.extend(shared.chunks(LANES).map(|bones| {
        let bones = std::array::from_fn(|lane| bones.get(lane).copied().unwrap_or(NONE));
        LaneGroup { bones, block: None, shared: SharedBlock::all(&bones) }
    }));
    groups
}

#[cfg(test)]
mod tests {
    use super::super::stored::DEFAULT;
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    fn kinds(bones: usize, moving: &[usize]) -> Vec<[u32; PARTS]> {
        let kind = |bone: usize| if moving.contains(&bone) { PACKED } else { DEFAULT };
        (0..bones).map(|bone| [DEFAULT, kind(bone), DEFAULT]).collect()
    }

    #[test]
    fn a_block_with_mostly_moving_bones_keeps_its_group_and_scattered_moving_bones_share_one() {
        let groups = groups(&kinds(40, &[0, 1, 2, 3, 4, 5, 6, 9, 17, 39]));
        assert!(groups[0].is_empty() && groups[2].is_empty());
        assert_eq!(groups[1].len(), 2);
        assert_eq!(groups[1][0].block, Some(0));
        assert_eq!((groups[1][1].block, &groups[1][1].bones[..4]), (None, &[9, 17, 39, NONE][..]));
    }

    #[test]
    fn every_moving_bone_has_exactly_one_slot() {
        let mut random = Random::new(seed(3));
        for _ in 0..200 {
            let share = random.unit();
            let moving: Vec<usize> = (0..70).filter(|_| random.unit() < share).collect();
            let mut bones: Vec<usize> =
                slots(&groups(&kinds(70, &moving))).iter().map(|place| place.bone).collect();
            bones.sort_unstable();
            assert_eq!(bones, moving);
        }
    }
}
