//! The data needed to decode the numbers of eight lanes in one segment.
//!
//! The three numbers of a lane are consecutive, and so are the lanes. Each lane has two words of four bytes; one starts
//! with the byte of the first bit of x, the other with that of z:
//!
//! ```text
//! first word    | others' bits | x | y | z …           |
//! second word   | … y | z | others' bits               |
//! bit           0                                     32
//! ```
//!
//! Numbers are masked in place and not shifted: the step is divided by the resulting power of two. That is exact.

use super::stored::{SegmentHead, ValueRange};
use crate::fast::simd::LANES;

/// Bits of a word that numbers may occupy: the sign bit stays free.
const HELD: u32 = 31;
/// Bits of numbers that four lanes can reach.
const SEEN: u32 = 128;
/// Marks lanes that are read from a [`WideBlock`].
const WIDE: u8 = u8::MAX;

/// Positions and scales of the numbers of eight lanes in a key.
#[derive(Clone, Debug)]
pub(super) struct HeadBlock {
    pub(super) start: [[f32; LANES]; 3],
    /// Ones at the bits of a component's number in its word.
    pub(super) masks: [[u32; LANES]; 3],
    /// The highest 16 bits of floats: the step, divided by two to the power of the first bit of the number.
    pub(super) step: [[u16; LANES]; 3],
    /// The first byte of each lane's two words, counted from `at`, or for lanes 4..8 from `second`.
    pub(super) words: [[u8; LANES]; 2],
    /// Bytes from the start of the key to the first word of all; for wide lanes, the index of their [`WideBlock`].
    pub(super) at: u32,
    /// Bytes from there to the first word of lanes 4..8, at most 15; or [`WIDE`].
    pub(super) second: u8,
}

/// Two blocks in the layout of memory: of each row the numbers of both, so that a wide register loads them at once.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct HeadPair {
    pub(super) start: [[[f32; LANES]; 2]; 3],
    pub(super) masks: [[[u32; LANES]; 2]; 3],
    pub(super) step: [[[u16; LANES]; 2]; 3],
    pub(super) words: [[[u8; LANES]; 2]; 2],
    pub(super) at: [u32; 2],
    pub(super) second: [u8; 2],
}

impl HeadPair {
    pub(super) fn new([a, b]: [&HeadBlock; 2]) -> Self {
        Self {
            start: std::array::from_fn(|axis| [a.start[axis], b.start[axis]]),
            masks: std::array::from_fn(|axis| [a.masks[axis], b.masks[axis]]),
            step: std::array::from_fn(|axis| [a.step[axis], b.step[axis]]),
            words: std::array::from_fn(|word| [a.words[word], b.words[word]]),
            at: [a.at, b.at],
            second: [a.second, b.second],
        }
    }

    /// Returns one of the blocks.
    pub(super) fn block(&self, half: usize) -> HeadBlock {
        HeadBlock {
            start: self.start.map(|rows| rows[half % 2]),
            masks: self.masks.map(|rows| rows[half % 2]),
            step: self.step.map(|rows| rows[half % 2]),
            words: self.words.map(|rows| rows[half % 2]),
            at: self.at[half % 2],
            second: self.second[half % 2],
        }
    }

    /// Returns whether the numbers of the lanes of a block are read from a [`WideBlock`].
    #[inline(always)]
    pub(super) fn is_wide(&self, half: usize) -> bool {
        self.second[half % 2] == WIDE
    }
}

/// Bits from the start of the key to each number, for lanes whose numbers are too wide for a [`HeadBlock`].
#[derive(Clone, Debug)]
pub(super) struct WideBlock {
    pub(super) bits: [[u32; LANES]; 3],
}

/// One lane in a plain form.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LaneLayout {
    /// Bits from the start of the key to its first number.
    pub(super) bit: u32,
    /// Bits of each number.
    pub(super) widths: [u32; 3],
    pub(super) start: [f32; 3],
    pub(super) step: [f32; 3],
}

impl LaneLayout {
    pub(super) fn new(bit: u32, range: &ValueRange, head: &SegmentHead) -> Self {
        let [x, y, z] = [0, 1, 2].map(|axis| head.start_and_step(range, axis));
        let (start, step) = ([x.0, y.0, z.0], [x.1, y.1, z.1]);
        Self { bit, widths: head.bits.map(u32::from), start, step }
    }

    /// Returns the bit at which each of the lane's numbers begins, counted from the start of the key, and the end of
    /// the last number.
    fn edges(&self) -> [u32; 4] {
        let [x, y, z] = self.widths;
        [self.bit, self.bit + x, self.bit + x + y, self.bit + x + y + z]
    }

    /// Returns the bit at which each of the lane's two words begins, counted from the start of the key.
    fn words(&self) -> [u32; 2] {
        let [x, _, z, _] = self.edges();
        [x / 8 * 8, z / 8 * 8]
    }

    fn has_numbers(&self) -> bool {
        self.widths != [0; 3]
    }
}

/// Index of the word of each component.
const WORD: [usize; 3] = [0, 0, 1];

impl HeadBlock {
    /// Creates a block of `lanes`, which are in the order of their bits, except that lanes without numbers may be
    /// anywhere.
    pub(super) fn new(lanes: &[LaneLayout; LANES], wide: &mut Vec<WideBlock>) -> Self {
        let start = [0, 1, 2].map(|axis| lanes.map(|lane| lane.start[axis]));
        let mut block = Self { start, ..Self::NONE };
        let halves = [&lanes[..4], &lanes[4..]].map(|half| {
            let mut lanes = half.iter().filter(|lane| lane.has_numbers());
            let first = lanes.next()?;
            Some((first.words()[0], lanes.next_back().unwrap_or(first).edges()[3]))
        });
        let first = halves[0].or(halves[1]).map_or(0, |(begin, _)| begin / 8);
        let second = halves[1].map_or(first, |(begin, _)| begin / 8);
        let held = |lane: &LaneLayout| {
            let ([_, _, z, end], [first, second]) = (lane.edges(), lane.words());
            z - first <= HELD && end - second <= HELD
        };
        let seen = halves.iter().flatten().all(|(begin, end)| end - begin <= SEEN);
        let from = if lanes.iter().all(held) && seen && second - first < 16 {
            (block.at, block.second) = (first, (second - first) as u8);
            Some([first * 8, second * 8])
        } else {
            (block.at, block.second) = (wide.len() as u32, WIDE);
            let bits = [0, 1, 2].map(|axis| lanes.map(|lane| lane.edges()[axis]));
            wide.push(WideBlock { bits });
            None
        };
        for (index, lane) in lanes.iter().enumerate().filter(|(_, lane)| lane.has_numbers()) {
            block.put(index, lane, from.map(|from| from[index / 4]));
        }
        block
    }

    /// Stores a lane whose words are counted from bit `from` on; `None` for a lane of a wide block.
    fn put(&mut self, index: usize, lane: &LaneLayout, from: Option<u32>) {
        let (edges, words) = (lane.edges(), lane.words());
        if let Some(from) = from {
            (0..2).for_each(|word| self.words[word][index] = ((words[word] - from) / 8) as u8);
        }
        for axis in 0..3 {
            let begin = if from.is_some() { edges[axis] - words[WORD[axis]] } else { edges[axis] % 8 };
            self.masks[axis][index] = ((1 << lane.widths[axis]) - 1) << begin;
            self.step[axis][index] = scaled(lane.step[axis], begin);
        }
    }

    /// A block of lanes without numbers.
    pub(super) const NONE: Self = Self {
        start: [[0.0; LANES]; 3],
        masks: [[0; LANES]; 3],
        step: [[0; LANES]; 3],
        words: [[0; LANES]; 2],
        at: 0,
        second: 0,
    };

    /// Returns whether the numbers of the lanes are read from a [`WideBlock`].
    fn is_wide(&self) -> bool {
        self.second == WIDE
    }

    /// Returns a lane of this block.
    pub(super) fn lane(&self, index: usize, wide: &[WideBlock]) -> LaneLayout {
        let masks = [0, 1, 2].map(|axis| self.masks[axis][index]);
        let bit = if self.is_wide() {
            wide[self.at as usize].bits[0][index]
        } else {
            let half = if index < 4 { 0 } else { u32::from(self.second) };
            (self.at + half + u32::from(self.words[0][index])) * 8
                + if masks[0] != 0 { masks[0].trailing_zeros() } else { self.first_bit(index) }
        };
        let step = |axis: usize| {
            let scale = if masks[axis] == 0 { 1.0 } else { (1_u32 << masks[axis].trailing_zeros()) as f32 };
            f32::from_bits(u32::from(self.step[axis][index]) << 16) * scale
        };
        LaneLayout {
            bit,
            widths: masks.map(u32::count_ones),
            start: [0, 1, 2].map(|axis| self.start[axis][index]),
            step: [0, 1, 2].map(step),
        }
    }

    /// Returns the bit of its first word at which a lane's numbers begin, for a lane whose x has no bits.
    fn first_bit(&self, index: usize) -> u32 {
        let [_, y, z] = [0, 1, 2].map(|axis| self.masks[axis][index]);
        if y != 0 { y.trailing_zeros() } else { z.trailing_zeros() % 32 }
    }
}

/// Returns the highest 16 bits of `step / 2^edge`, for numbers that are masked in place and so are `2^edge` times too
/// large.
fn scaled(step: f32, edge: u32) -> u16 {
    ((step / (1_u32 << edge) as f32).to_bits() >> 16) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn a_head_block_with_narrow_or_wide_lanes_returns_the_lanes_it_was_built_from() {
        let mut random = Random::new(seed(17));
        let mut wide = Vec::new();
        for round in 0..2000 {
            let most = if round % 2 == 0 { 8.99 } else { 22.99 };
            let mut bit = random.between(0.0, 300.0) as u32;
            let lanes: [LaneLayout; LANES] = std::array::from_fn(|_| {
                let widths = [0; 3]
                    .map(|_: u32| if random.unit() < 0.2 { 0 } else { random.between(0.0, most) as u32 });
                let step = widths.map(|width| if width == 0 { 0.0 } else { 0.75 });
                let lane = LaneLayout { bit, widths, start: [1.0, 2.0, 3.0], step };
                bit += widths.iter().sum::<u32>();
                lane
            });
            let block = HeadBlock::new(&lanes, &mut wide);
            assert!(block.is_wide() == (block.second > 15));
            let pair = HeadPair::new(if round % 4 < 2 {
                [&block, &HeadBlock::NONE]
            } else {
                [&HeadBlock::NONE, &block]
            });
            let half = usize::from(round % 4 >= 2);
            assert_eq!(pair.is_wide(half), block.is_wide());
            let block = pair.block(half);
            for (index, lane) in lanes.iter().enumerate() {
                let back = block.lane(index, &wide);
                let bit = if lane.widths == [0; 3] { back.bit } else { lane.bit };
                assert_eq!(back, LaneLayout { bit, ..*lane });
            }
        }
        assert!(!wide.is_empty());
    }
}
