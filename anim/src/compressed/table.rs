//! What decoding needs beside the bytes: one set of tables a take, shared by all characters that play it.

use super::frames::Clock;
use super::grid::{WHOLE_BITS, rotation_from};
use super::stored::{Head, PARTS, Range, Reference, odd_zero, rotation_of};
use crate::data::Transform;
use crate::fast::PoseBlock;
use crate::fast::simd::LANES;
use glam::{Quat, Vec3};

/// Everything about a compressed take but its keys.
#[derive(Clone, Debug)]
pub(super) struct Tables {
    pub(super) name: String,
    pub(super) clock: Clock,
    /// Seconds.
    pub(super) interval: f64,
    pub(super) shift: u32,
    pub(super) bones: usize,
    /// What stands still.
    pub(super) base: Vec<PoseBlock>,
    /// Of rotations, translations, scales: the blocks in which any of eight bones moves.
    pub(super) parts: [Moving; PARTS],
    pub(super) segments: Vec<SegmentPlace>,
    pub(super) whole: Vec<WholeTrack>,
    /// Of each track, in the order in which they are stored: part, place in the list of blocks, lane.
    tracks: Vec<(usize, usize, usize)>,
}

/// The blocks in which rotations, or translations, or scales move.
#[derive(Clone, Debug, Default)]
pub(super) struct Moving {
    pub(super) blocks: Vec<MovingBlock>,
    /// Segment after segment, one a block.
    pub(super) heads: Vec<HeadBlock>,
}

impl Moving {
    /// The heads of all blocks in two segments; none past the end.
    #[inline(always)]
    pub(super) fn heads_of(&self, segment: usize, next: usize) -> (&[HeadBlock], &[HeadBlock]) {
        let count = self.blocks.len();
        let of = |segment: usize| self.heads.get(segment * count..(segment + 1) * count).unwrap_or(&[]);
        (of(segment), of(next))
    }
}

/// Eight bones of which any moves.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct MovingBlock {
    /// Rotations: what the components are relative to.
    pub(super) reference: [[f32; LANES]; 4],
    pub(super) low: [[f32; LANES]; 3],
    pub(super) extent: [[f32; LANES]; 3],
    /// Position in the pose.
    pub(super) block: usize,
}

/// [`Head`]s of eight tracks.
#[derive(Clone, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct HeadBlock {
    /// Bits of even keys (5 bits for each component, x lowest), then of odd keys.
    pub(super) bits: [u32; LANES],
    /// Where the numbers of a lane begin among those of an even key.
    pub(super) even_at: [u32; LANES],
    /// Likewise of an odd key.
    pub(super) odd_at: [u32; LANES],
    /// Place, and extent in the low byte.
    pub(super) place: [[u16; LANES]; 3],
    pub(super) extent: [[u8; LANES]; 3],
    /// How many bytes must be looked at for the numbers of an even key, and of an odd one.
    pub(super) reads: [Reads; 2],
}

/// How the three numbers of a key can be read in eight lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Reads {
    /// Four bytes hold all three.
    #[default]
    One,
    /// Four bytes hold the first two.
    Two,
    /// Each needs its own.
    Three,
}

impl Reads {
    fn of(bits: [u8; 3]) -> Self {
        // A number can begin in the last bit of its first byte.
        const HELD: u32 = 32 - 7;
        let [x, y, z] = bits.map(u32::from);
        match (x + y <= HELD, x + y + z <= HELD) {
            (_, true) => Self::One,
            (true, _) => Self::Two,
            _ => Self::Three,
        }
    }
}

/// Where the keys of a segment lie, in bits from the first byte.
#[derive(Clone, Copy, Debug)]
pub(super) struct SegmentPlace {
    pub(super) even: u32,
    pub(super) even_stride: u32,
    pub(super) odd: u32,
    pub(super) odd_stride: u32,
}

/// A track whose keys are stored whole.
#[derive(Clone, Copy, Debug)]
pub(super) struct WholeTrack {
    pub(super) bone: usize,
    pub(super) part: usize,
    /// Of the first key, in bytes.
    pub(super) offset: usize,
}

impl WholeTrack {
    pub(super) fn bytes_per_key(&self) -> usize {
        if self.part == 0 { 8 } else { 12 }
    }

    /// The value of a key; of a vector the fourth number is 0. Zero where the bytes end.
    pub(super) fn value(&self, bytes: &[u8], key: u32) -> [f32; 4] {
        let at = self.offset + self.bytes_per_key() * key as usize;
        let rest = bytes.get(at..).unwrap_or(&[]);
        if self.part == 0 {
            let word = u64::from_le_bytes(rest.first_chunk().copied().unwrap_or_default());
            let number = |at: u32| (word >> (2 + at * WHOLE_BITS)) as u32 & ((1 << WHOLE_BITS) - 1);
            return rotation_from(word as u32 & 3, [0, 1, 2].map(number), WHOLE_BITS).to_array();
        }
        let words: [u8; 12] = rest.first_chunk().copied().unwrap_or_default();
        let number = |at: usize| f32::from_le_bytes([words[at], words[at + 1], words[at + 2], words[at + 3]]);
        [number(0), number(4), number(8), 0.0]
    }
}

impl Tables {
    pub(super) fn new(clock: Clock, shift: u32, name: String, bones: usize) -> Self {
        let (base, parts) = (Vec::new(), Default::default());
        let (segments, whole, tracks) = (Vec::new(), Vec::new(), Vec::new());
        Self { name, clock, interval: clock.interval(), shift, bones, base, parts, segments, whole, tracks }
    }

    /// Puts in what stands still: a pose a bone.
    pub(super) fn put_constants(&mut self, poses: &[Transform]) {
        self.base = vec![PoseBlock::IDENTITY; poses.len().div_ceil(LANES)];
        for (bone, &pose) in poses.iter().enumerate() {
            self.base[bone / LANES].set(bone, pose);
        }
    }

    /// Adds a track; bones ascend within a part.
    pub(super) fn add_track(&mut self, bone: usize, part: usize, reference: Reference, range: Range) {
        let (block, lane) = (bone / LANES, bone % LANES);
        let base = &self.base[block];
        let blocks = &mut self.parts[part].blocks;
        if blocks.last().is_none_or(|last| last.block != block) {
            blocks.push(MovingBlock::still(block, part, base));
        }
        let place = blocks.len() - 1;
        let moving = &mut blocks[place];
        if part == 0 {
            let rotation = reference.rotation().to_array();
            (0..4).for_each(|axis| moving.reference[axis][lane] = rotation[axis]);
        }
        for axis in 0..3 {
            moving.low[axis][lane] = range.low[axis];
            moving.extent[axis][lane] = range.extent[axis];
        }
        self.tracks.push((part, place, lane));
    }

    /// Makes room for the heads of one more segment.
    pub(super) fn begin_segment(&mut self) {
        for part in &mut self.parts {
            part.heads.extend(part.blocks.iter().map(|_| HeadBlock::default()));
        }
    }

    /// Puts in the head of a track in the segment begun last.
    pub(super) fn put_head(&mut self, track: usize, head: &Head, even_at: u32, odd_at: u32) {
        let (part, place, lane) = self.tracks[track];
        let part = &mut self.parts[part];
        let first = part.heads.len() - part.blocks.len();
        let heads = &mut part.heads[first + place];
        let bits = head.even_bits.into_iter().chain(head.odd_bits);
        heads.bits[lane] = bits.rev().fold(0, |bits, width| bits << 5 | u32::from(width));
        heads.reads[0] = heads.reads[0].max(Reads::of(head.even_bits));
        heads.reads[1] = heads.reads[1].max(Reads::of(head.odd_bits));
        (heads.even_at[lane], heads.odd_at[lane]) = (even_at, odd_at);
        for axis in 0..3 {
            heads.place[axis][lane] = u16::from(head.place[axis]) << 8 | u16::from(head.extent[axis]);
            heads.extent[axis][lane] = head.extent[axis];
        }
    }

    /// Bytes that the tables take.
    pub(super) fn bytes(&self) -> usize {
        let parts = self
            .parts
            .iter()
            .map(|part| size_of_val(part.blocks.as_slice()) + size_of_val(part.heads.as_slice()));
        size_of_val(self.base.as_slice())
            + size_of_val(self.segments.as_slice())
            + size_of_val(self.whole.as_slice())
            + size_of_val(self.tracks.as_slice())
            + parts.sum::<usize>()
    }

    /// The tracks that are packed: part and bone.
    pub(super) fn packed(&self) -> impl Iterator<Item = (usize, usize, Track<'_>)> {
        self.tracks.iter().map(|&(part, place, lane)| {
            let bone = self.parts[part].blocks[place].block * LANES + lane;
            (part, bone, Track { tables: self, part, place, lane })
        })
    }
}

impl MovingBlock {
    fn still(block: usize, part: usize, base: &PoseBlock) -> Self {
        let low = match part {
            0 => [[0.0; LANES]; 3],
            1 => base.translation,
            _ => base.scale,
        };
        Self { reference: base.rotation, low, extent: [[0.0; LANES]; 3], block }
    }
}

/// One track, decoded a key at a time: the plain way, which the fast one must agree with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track<'a> {
    tables: &'a Tables,
    part: usize,
    place: usize,
    lane: usize,
}

impl Track<'_> {
    /// The value of a key; of a vector the fourth number is 0.
    pub(super) fn value(&self, bytes: &[u8], key: u32) -> [f32; 4] {
        let moving = &self.tables.parts[self.part].blocks[self.place];
        let components = self.components(bytes, key);
        if self.part == 0 {
            let reference = Quat::from_array([0, 1, 2, 3].map(|axis| moving.reference[axis][self.lane]));
            return rotation_of(reference, components).to_array();
        }
        components.extend(0.0).to_array()
    }

    fn components(&self, bytes: &[u8], key: u32) -> Vec3 {
        let (start, step, head) = self.head(key);
        if key.is_multiple_of(2) {
            let segment = &self.tables.segments[(key >> self.tables.shift) as usize];
            let inside = (key & ((1 << self.tables.shift) - 1)) / 2;
            let at = segment.even + inside * segment.even_stride;
            return start + step * numbers(bytes, at + head.even_at[self.lane], head.bits[self.lane]);
        }
        let before = self.components(bytes, key - 1);
        let last = self.tables.clock.frames - 1;
        let after = if key < last { self.components(bytes, key + 1) } else { before };
        let segment = &self.tables.segments[(key >> self.tables.shift) as usize];
        let inside = (key & ((1 << self.tables.shift) - 1)) / 2;
        let at = segment.odd + inside * segment.odd_stride;
        let bits = head.bits[self.lane] >> 15;
        let zero = Vec3::from_array([0, 5, 10].map(|shift| odd_zero((bits >> shift & 31) as u8)));
        (before * 0.5 + after * 0.5) + step * (numbers(bytes, at + head.odd_at[self.lane], bits) - zero)
    }

    fn head(&self, key: u32) -> (Vec3, Vec3, &HeadBlock) {
        let part = &self.tables.parts[self.part];
        let heads = &part.heads[(key >> self.tables.shift) as usize * part.blocks.len() + self.place];
        let moving = &part.blocks[self.place];
        let three = |rows: &[[f32; LANES]; 3]| Vec3::from_array([0, 1, 2].map(|axis| rows[axis][self.lane]));
        let range = Range { low: three(&moving.low), extent: three(&moving.extent) };
        let bits = [0, 5, 10].map(|shift| (heads.bits[self.lane] >> shift & 31) as u8);
        let place = [0, 1, 2].map(|axis| (heads.place[axis][self.lane] >> 8) as u8);
        let extent = [0, 1, 2].map(|axis| heads.extent[axis][self.lane]);
        let head = Head { place, extent, even_bits: bits, odd_bits: [0; 3] };
        let [x, y, z] = [0, 1, 2].map(|axis| head.start_and_step(&range, axis));
        (Vec3::new(x.0, y.0, z.0), Vec3::new(x.1, y.1, z.1), heads)
    }
}

/// Three numbers one after the other from bit `at` on; five bits of `widths` say how wide each is.
fn numbers(bytes: &[u8], at: u32, widths: u32) -> Vec3 {
    let mut at = at as usize;
    Vec3::from_array([0, 5, 10].map(|shift| {
        let width = widths >> shift & 31;
        let rest = bytes.get(at / 8..).unwrap_or(&[]);
        let word = u32::from_le_bytes(rest.first_chunk().copied().unwrap_or_default());
        let number = (word >> (at % 8)) & ((1 << width) - 1);
        at += width as usize;
        number as f32
    }))
}
