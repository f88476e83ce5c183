//! The tables that decoding needs in addition to the bytes: one set per take, shared by all characters that play it.

use super::bits::BitReader;
use super::clock::FrameClock;
use super::head::{HeadBlock, HeadPair, LaneLayout, WideBlock};
use super::lane_groups::{LaneGroup, TrackSlot, groups, slots};
use super::stored::{PACKED, PARTS, Reference, SegmentHead, ValueRange, WHOLE, rotation_of};
use super::whole::WholeTrack;
use crate::data::Transform;
use crate::fast::simd::LANES;
use crate::fast::{PoseBlock, StillPose};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Everything about a compressed take but its keys.
#[derive(Clone, Debug)]
pub(super) struct Tables {
    pub(super) name: String,
    pub(super) clock: FrameClock,
    /// Seconds between two keys.
    pub(super) interval: f64,
    /// Its reciprocal.
    pub(super) keys_per_second: f64,
    pub(super) shift: u32,
    pub(super) bones: usize,
    pub(super) still: Arc<StillPose>,
    /// Rotations that move.
    pub(super) turning: Vec<LaneGroup>,
    /// Rotations that those of each two groups are relative to.
    pub(super) references: Vec<ReferencePair>,
    /// Translations and scales that move.
    pub(super) moving: [Vec<LaneGroup>; 2],
    /// Segment after segment, one for each two groups: of rotations, then translations, then scales.
    heads: Vec<HeadPair>,
    pub(super) segments: Vec<SegmentPlace>,
    /// Positions of the numbers of groups that are too wide for a [`HeadBlock`].
    pub(super) wide: Vec<WideBlock>,
    pub(super) whole: Vec<WholeTrack>,
}

/// The rotations that the components of two groups are relative to: of each row those of both.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct ReferencePair {
    pub(super) rows: [[[f32; LANES]; 2]; 4],
}

/// Position of the keys of a segment, in bytes from the first key.
#[derive(Clone, Copy, Debug)]
pub(super) struct SegmentPlace {
    pub(super) at: u32,
    /// Bytes of one key.
    pub(super) stride: u32,
}

impl Tables {
    /// Creates the tables of a take without keys, from the storage of its bones' channels and their constant poses.
    pub(super) fn new(
        clock: FrameClock,
        shift: u32,
        name: String,
        kinds: &[[u32; PARTS]],
        poses: &[Transform],
    ) -> Self {
        let mut base = vec![PoseBlock::IDENTITY; poses.len().div_ceil(LANES)];
        for (bone, &pose) in poses.iter().enumerate() {
            base[bone / LANES].set(bone, pose);
        }
        let [turning, translations, scales] = groups(kinds);
        let reference = |group: Option<&LaneGroup>| match group.and_then(|group| group.block) {
            Some(block) => base[block as usize].rotation,
            None => PoseBlock::IDENTITY.rotation,
        };
        let references = turning.chunks(2).map(|pair| {
            let (first, second) = (reference(pair.first()), reference(pair.get(1)));
            ReferencePair { rows: std::array::from_fn(|row| [first[row], second[row]]) }
        });
        let references = references.collect();
        let turns = |block: u32| turning.iter().any(|group| group.block == Some(block));
        let moves = |bone: usize| {
            kinds.get(bone).is_some_and(|kinds| kinds.iter().any(|&kind| kind == PACKED || kind == WHOLE))
        };
        Self {
            name,
            interval: clock.interval(),
            keys_per_second: 1.0 / clock.interval(),
            clock,
            shift,
            bones: poses.len(),
            still: Arc::new(StillPose::of_blocks(&base, moves, turns)),
            turning,
            references,
            moving: [translations, scales],
            heads: Vec::new(),
            segments: Vec::new(),
            wide: Vec::new(),
            whole: Vec::new(),
        }
    }

    /// Returns the constant pose of `bone`.
    pub(super) fn still_pose(&self, bone: usize) -> Transform {
        let (block, mut pose) = (bone / LANES, PoseBlock::IDENTITY);
        pose.translation = self.still.translation(block);
        pose.scale = self.still.scale(block);
        let turning = self.turning.iter().position(|group| group.block == Some(block as u32));
        if let Some(rotation) = turning.map(|group| self.reference(group)).or(self.still.rotation(block)) {
            pose.rotation = rotation;
        }
        pose.get(bone)
    }

    /// Returns every packed track, in the order in which tracks are stored.
    pub(super) fn slots(&self) -> Vec<TrackSlot> {
        let [translations, scales] = &self.moving;
        slots(&[self.turning.clone(), translations.clone(), scales.clone()])
    }

    /// Sets the rotation that the components of a track are relative to.
    pub(super) fn refer(&mut self, slot: &TrackSlot, reference: Reference) {
        let rotation = reference.rotation().to_array();
        let rows = &mut self.references[slot.group / 2].rows;
        (0..4).for_each(|axis| rows[axis][slot.group % 2][slot.lane] = rotation[axis]);
    }

    /// Returns the rotations that those of a group are relative to.
    fn reference(&self, group: usize) -> [[f32; LANES]; 4] {
        self.references[group / 2].rows.map(|pair| pair[group % 2])
    }

    /// Returns the heads of all groups in a segment and in those after it, in pairs; none past the end.
    #[inline(always)]
    pub(super) fn heads_of(&self, segment: usize) -> &[HeadPair] {
        let count = self.turning.len() + self.moving[0].len() + self.moving[1].len();
        self.heads.get(segment * count.div_ceil(2)..).unwrap_or(&[])
    }

    /// Returns the head of a track in a segment.
    fn head(&self, slot: &TrackSlot, segment: usize) -> HeadBlock {
        let before = [0, self.turning.len(), self.turning.len() + self.moving[0].len()];
        let index = before[slot.part] + slot.group;
        self.heads_of(segment)[index / 2].block(index % 2)
    }

    /// Adds a segment: the range and the head of every track. Returns the bits of one key.
    pub(super) fn add_segment(&mut self, tracks: &[(TrackSlot, ValueRange)], heads: &[SegmentHead]) -> u32 {
        let mut tracks = tracks.iter().zip(heads).peekable();
        let mut bit = 0;
        let counts = [self.turning.len(), self.moving[0].len(), self.moving[1].len()];
        let groups = (0..PARTS).flat_map(|part| (0..counts[part]).map(move |group| (part, group)));
        let mut blocks = Vec::new();
        for (part, group) in groups {
            let mut lanes = self.still_lanes(part, group);
            while let Some(((slot, range), head)) =
                tracks.next_if(|((slot, _), _)| (slot.part, slot.group) == (part, group))
            {
                lanes[slot.lane] = LaneLayout::new(bit, range, head);
                bit += head.width();
            }
            blocks.push(HeadBlock::new(&lanes, &mut self.wide));
        }
        let pair = |pair: &[HeadBlock]| HeadPair::new([&pair[0], pair.get(1).unwrap_or(&HeadBlock::NONE)]);
        self.heads.extend(blocks.chunks(2).map(pair));
        bit
    }

    /// Returns lanes without numbers: the constants of the group.
    fn still_lanes(&self, part: usize, group: usize) -> [LaneLayout; LANES] {
        let block = part.checked_sub(1).and_then(|vector| self.moving[vector][group].block);
        let rows = match block {
            Some(block) if part == 1 => self.still.translation(block as usize),
            Some(block) => self.still.scale(block as usize),
            None => [[0.0; LANES]; 3],
        };
        std::array::from_fn(|lane| LaneLayout { start: rows.map(|row| row[lane]), ..LaneLayout::default() })
    }

    fn groups(&self) -> impl Iterator<Item = &LaneGroup> {
        self.turning.iter().chain(self.moving.iter().flatten())
    }

    /// Returns the size of the tables in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.still.bytes()
            + size_of_val(self.turning.as_slice())
            + size_of_val(self.references.as_slice())
            + size_of_val(self.moving[0].as_slice())
            + size_of_val(self.moving[1].as_slice())
            + self.groups().map(|group| size_of_val(group.shared.as_slice())).sum::<usize>()
            + size_of_val(self.heads.as_slice())
            + size_of_val(self.segments.as_slice())
            + size_of_val(self.wide.as_slice())
            + size_of_val(self.whole.as_slice())
    }

    /// Returns the value of a key of a packed track by the plain formula, with which the fast one must agree; the
    /// fourth number of a vector is 0.
    pub(super) fn value(&self, bytes: &[u8], slot: &TrackSlot, key: u32) -> [f32; 4] {
        let segment = (key >> self.shift) as usize;
        let SegmentPlace { at, stride } = self.segments[segment];
        let row = at + stride * (key & ((1 << self.shift) - 1));
        let lane = self.head(slot, segment).lane(slot.lane, &self.wide);
        let mut bits = BitReader::new(bytes, row as usize).after(lane.bit);
        let value = Vec3::from_array([0, 1, 2].map(|axis| {
            let number = bits.take(lane.widths[axis]).unwrap_or(0);
            lane.start[axis] + lane.step[axis] * number as f32
        }));
        if slot.part == 0 {
            let reference = self.reference(slot.group);
            let reference = Quat::from_array([0, 1, 2, 3].map(|axis| reference[axis][slot.lane]));
            return rotation_of(reference, value).to_array();
        }
        value.extend(0.0).to_array()
    }
}
