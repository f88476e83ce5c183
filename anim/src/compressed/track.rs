//! Three components of one track in as few bits as an error allows.
//!
//! Keys with an even number hold a value, those with an odd number what is missing from half way between their
//! neighbours, in the same steps:
//!
//! ```text
//! value[2i]     = start + step * number[2i]                            start, step: per segment and component
//! value[2i + 1] = (value[2i] + value[2i + 2]) / 2 + step * (number[2i + 1] - half of its range)
//! ```
//!
//! Movement is smooth, so the odd numbers are small. Any key needs two others at most, so any time can be decoded
//! from three keys.

use super::stored::{Head, MAX_EVEN_BITS, MAX_ODD_BITS, PER_EXTENT, PER_PLACE, Range, Segment, odd_zero};
use glam::{BVec3, Vec3};

/// A track of decoded values, and what makes them.
#[derive(Debug)]
pub(super) struct Coded {
    pub(super) range: Range,
    pub(super) segments: Vec<Segment>,
    /// What a decoder will get, one a key.
    pub(super) values: Vec<Vec3>,
}

/// What a track must be like.
pub(super) struct Wanted<'a> {
    /// One a key.
    pub(super) values: &'a [Vec3],
    /// Where the components lie; all of `values` are inside.
    pub(super) range: Range,
    /// Keys of a segment: `1 << shift`.
    pub(super) shift: u32,
    /// The step to begin with, coarser than needed, per component.
    pub(super) step: Vec3,
}

/// Steps become finer by this until the error is small enough.
const FINER: f32 = 0.707;
/// As often at most.
const TRIES: usize = 48;

/// Codes a track so that `error(key, value)` is at most 1 for every key, with few bits; `None` where that cannot be.
pub(super) fn code(wanted: &Wanted<'_>, mut error: impl FnMut(usize, Vec3) -> f32) -> Option<Coded> {
    let count = wanted.values.len();
    let length = 1 << wanted.shift;
    let mut values = wanted.values.to_vec();
    let mut segments: Vec<Segment> = (0..count.div_ceil(length)).map(|_| Segment::default()).collect();
    // From the last to the first: the last odd key of a segment needs the first key of the next one.
    for (index, segment) in segments.iter_mut().enumerate().rev() {
        let keys = index * length..count.min((index + 1) * length);
        *segment = Search { wanted, keys, values: &mut values, error: &mut error }.best()?;
    }
    Some(Coded { range: wanted.range, segments, values })
}

/// The search for the fewest bits of one segment.
struct Search<'a, E> {
    wanted: &'a Wanted<'a>,
    keys: std::ops::Range<usize>,
    /// Those after the segment are decoded already; those inside are overwritten.
    values: &'a mut [Vec3],
    error: &'a mut E,
}

impl<E: FnMut(usize, Vec3) -> f32> Search<'_, E> {
    fn best(&mut self) -> Option<Segment> {
        let (even, all) = (self.span(2), self.span(1));
        let mut bits = [0; 3];
        let mut step = self.wanted.step;
        let mut found = None;
        for _ in 0..TRIES {
            let next = std::array::from_fn(|axis| first_bits(even[axis], all[axis], step[axis]));
            if next != bits || found.is_none() {
                bits = next;
                found = self.attempt(bits);
                if found.is_some() {
                    break;
                }
            }
            if bits == [MAX_EVEN_BITS as u8; 3] {
                break;
            }
            step *= FINER;
        }
        let mut best = found?;
        // One bit less where that still does; the one that saves most first is the one tried first.
        let mut axis_failed = [false; 3];
        while let Some(axis) =
            (0..3).filter(|&axis| !axis_failed[axis] && bits[axis] > 0).max_by_key(|&axis| bits[axis])
        {
            let mut fewer = bits;
            fewer[axis] -= 1;
            match self.attempt(fewer) {
                Some(segment) if cost(&segment) < cost(&best) => (best, bits) = (segment, fewer),
                _ => axis_failed[axis] = true,
            }
        }
        self.attempt(bits)
    }

    /// Low and high end of every `every`th key.
    fn span(&self, every: usize) -> [(f32, f32); 3] {
        let keys = self.keys.clone().step_by(every).map(|key| self.wanted.values[key]);
        let (low, high) = keys.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        std::array::from_fn(|axis| (low[axis], high[axis]))
    }

    /// Codes the segment with `bits` for even keys; `None` where an error is too large.
    fn attempt(&mut self, bits: [u8; 3]) -> Option<Segment> {
        let range = &self.wanted.range;
        let mut head = Head { even_bits: bits, ..Head::default() };
        let even = self.span(2);
        for axis in 0..3 {
            let (place, extent) = place_and_extent(range, axis, even[axis], bits[axis]);
            (head.place[axis], head.extent[axis]) = (place, extent);
        }
        let from = [0, 1, 2].map(|axis| head.start_and_step(range, axis));
        let (start, step) = (Vec3::from_array(from.map(|at| at.0)), Vec3::from_array(from.map(|at| at.1)));
        let most = bits.map(|bits| ((1_u32 << bits) - 1) as f32);
        let mut keys = vec![[0_u32; 3]; self.keys.len()];
        for key in self.keys.clone().step_by(2) {
            let numbers = self.round(key, start, step, Vec3::ZERO, Vec3::from_array(most))?;
            keys[key - self.keys.start] = numbers.to_array().map(|number| number as u32);
        }
        let mut odd = vec![Vec3::ZERO; self.keys.len()];
        let (mut least, mut largest) = (Vec3::ZERO, Vec3::ZERO);
        for key in self.keys.clone().skip(1).step_by(2) {
            let before = self.values[key - 1];
            let after = self.values.get(key + 1).copied().unwrap_or(before);
            let middle = (before + after) * 0.5;
            let far = Vec3::splat(FARTHEST);
            let numbers = self.round(key, middle, step, -far, far)?;
            (least, largest) = (least.min(numbers), largest.max(numbers));
            odd[key - self.keys.start] = numbers;
        }
        for axis in 0..3 {
            head.odd_bits[axis] = odd_bits(least[axis], largest[axis])?;
        }
        for (key, numbers) in keys.iter_mut().zip(odd).skip(1).step_by(2) {
            *key = std::array::from_fn(|axis| (numbers[axis] + odd_zero(head.odd_bits[axis])) as u32);
        }
        Some(Segment { head, keys })
    }

    /// Steps from `start` to the value wanted at `key`, and there the value: the nearest, or where that is not near
    /// enough the first of its neighbours that is. Within a tolerance that several bones share, the corner that is
    /// nearest in numbers is not always the one nearest to see.
    fn round(&mut self, key: usize, start: Vec3, step: Vec3, least: Vec3, most: Vec3) -> Option<Vec3> {
        let away = self.wanted.values[key] - start;
        let first = nearest(away, step);
        let other = first + Vec3::select(step.cmpgt(Vec3::ZERO), (away - first * step).signum(), Vec3::ZERO);
        for corner in CORNERS {
            let numbers = Vec3::select(corner, other, first).max(least).min(most);
            self.values[key] = start + step * numbers;
            if (self.error)(key, self.values[key]) <= 1.0 {
                return Some(numbers);
            }
        }
        None
    }
}

/// Which components are rounded the other way.
const CORNERS: [BVec3; 8] = [
    BVec3::new(false, false, false),
    BVec3::new(true, false, false),
    BVec3::new(false, true, false),
    BVec3::new(false, false, true),
    BVec3::new(true, true, false),
    BVec3::new(true, false, true),
    BVec3::new(false, true, true),
    BVec3::new(true, true, true),
];
/// The largest odd number, either way.
const FARTHEST: f32 = ((1 << (MAX_ODD_BITS - 1)) - 1) as f32;

/// Steps to the nearest whole number; none where a step has no length.
fn nearest(distance: Vec3, step: Vec3) -> Vec3 {
    let numbers = distance / step;
    Vec3::select(step.cmpgt(Vec3::ZERO), numbers.round(), Vec3::ZERO)
}

/// Bits with which an even key can be told apart in steps of `step`.
fn first_bits(even: (f32, f32), all: (f32, f32), step: f32) -> u8 {
    let numbers = (even.1 - even.0) / step;
    let least = if all.1 - all.0 > step { 1.0 } else { 0.0 };
    // Not `ceil`: half a step of error either way is what rounding has anyway.
    (numbers + 1.0).log2().ceil().max(least).min(MAX_EVEN_BITS as f32) as u8
}

/// Bits that hold every number from `least` to `largest` beside a zero in the middle; `None` where there are too many.
fn odd_bits(least: f32, largest: f32) -> Option<u8> {
    if least == 0.0 && largest == 0.0 {
        return Some(0);
    }
    (1..=MAX_ODD_BITS as u8).find(|&bits| -least <= odd_zero(bits) && largest <= odd_zero(bits) - 1.0)
}

/// Where `span` lies in `range`: the smallest extent, and the largest start, that hold it.
fn place_and_extent(range: &Range, axis: usize, span: (f32, f32), bits: u8) -> (u8, u8) {
    let whole = range.extent[axis];
    if whole <= 0.0 {
        return (0, 0);
    }
    let low = ((span.0 - range.low[axis]) / whole).clamp(0.0, 1.0);
    let high = ((span.1 - range.low[axis]) / whole).clamp(0.0, 1.0);
    if bits == 0 {
        // No extent is needed, so both bytes tell the place of the middle.
        let together = ((low + high) * 0.5 / PER_PLACE).round() as u16;
        return ((together >> 8) as u8, together as u8);
    }
    for extent in 1..=255_u8 {
        let place = ((low / PER_PLACE - f32::from(extent)) / 256.0).floor().clamp(0.0, 255.0) as u8;
        let start = f32::from(u16::from(place) << 8 | u16::from(extent)) * PER_PLACE;
        if start + f32::from(extent) * PER_EXTENT >= high {
            return (place, extent);
        }
    }
    (0, 255)
}

/// Bits of all keys.
fn cost(segment: &Segment) -> usize {
    let odd = segment.keys.len() / 2;
    segment.head.even_width() as usize * (segment.keys.len() - odd) + segment.head.odd_width() as usize * odd
}
