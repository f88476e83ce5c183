//! Encodes three components of one track in as few bits as an error allows.
//!
//! ```text
//! value = start + step * number          start, step: per segment and component
//! ```
//!
//! Each key is independent of the others, so any time can be decoded from two keys.

use super::stored::{MAX_BITS, PER_EXTENT, PER_PLACE, SegmentHead, TrackSegment, ValueRange};
use glam::{BVec3, Vec3};

/// An encoded track and its decoded values.
#[derive(Debug)]
pub(super) struct Coded {
    pub(super) range: ValueRange,
    pub(super) segments: Vec<TrackSegment>,
    /// Decoded values, one per key.
    pub(super) values: Vec<Vec3>,
}

/// Requirements for the encoding of a track.
pub(super) struct Wanted<'a> {
    /// The values, one per key.
    pub(super) values: &'a [Vec3],
    /// Range of the components; all of `values` are inside.
    pub(super) range: ValueRange,
    /// A segment has `1 << shift` keys.
    pub(super) shift: u32,
    /// The step to start with, coarser than needed, per component.
    pub(super) step: Vec3,
}

/// Factor by which steps become finer until the error is small enough.
const FINER: f32 = 0.707;
/// Largest number of such refinements.
const TRIES: usize = 48;

/// Encodes a track so that `error(key, value)` is at most 1 for every key, with few bits; `None` where that is
/// impossible.
pub(super) fn code(wanted: &Wanted<'_>, mut error: impl FnMut(usize, Vec3) -> f32) -> Option<Coded> {
    let count = wanted.values.len();
    let length = 1 << wanted.shift;
    let mut values = wanted.values.to_vec();
    let segments = (0..count.div_ceil(length)).map(|index| {
        let keys = index * length..count.min((index + 1) * length);
        BitSearch { wanted, keys, values: &mut values, error: &mut error }.best()
    });
    let segments = segments.collect::<Option<_>>()?;
    Some(Coded { range: wanted.range, segments, values })
}

/// The search for the fewest bits of one segment.
struct BitSearch<'a, E> {
    wanted: &'a Wanted<'a>,
    keys: std::ops::Range<usize>,
    /// Decoded values; those inside the segment are overwritten.
    values: &'a mut [Vec3],
    error: &'a mut E,
}

impl<E: FnMut(usize, Vec3) -> f32> BitSearch<'_, E> {
    fn best(&mut self) -> Option<TrackSegment> {
        let span = self.span();
        let mut bits = [0; 3];
        let mut step = self.wanted.step;
        let mut found = None;
        for _ in 0..TRIES {
            let next = std::array::from_fn(|axis| first_bits(span[axis], step[axis]));
            if next != bits || found.is_none() {
                bits = next;
                found = self.attempt(bits);
                if found.is_some() {
                    break;
                }
            }
            if bits == [MAX_BITS as u8; 3] {
                break;
            }
            step *= FINER;
        }
        let mut best = found?;
        // Reduces bits while the error allows it; the change that saves most, from the widest component, is tried
        // first.
        while let Some((fewer, segment)) = CHANGES.iter().find_map(|change| {
            let fewer = changed(bits, change)?;
            Some((fewer, self.attempt(fewer)?))
        }) {
            (best, bits) = (segment, fewer);
        }
        let decoded = self.decoded(&best);
        self.values[self.keys.clone()].copy_from_slice(&decoded);
        Some(best)
    }

    /// Returns the low and high end of the keys.
    fn span(&self) -> [(f32, f32); 3] {
        let keys = self.wanted.values[self.keys.clone()].iter();
        let (low, high) = keys.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &value| {
            (low.min(value), high.max(value))
        });
        std::array::from_fn(|axis| (low[axis], high[axis]))
    }

    /// Encodes the segment with `bits`; `None` where an error is too large.
    fn attempt(&mut self, bits: [u8; 3]) -> Option<TrackSegment> {
        let head = self.head(bits);
        let (start, step) = self.start_and_step(&head);
        let most = Vec3::from_array(bits.map(|bits| ((1_u32 << bits) - 1) as f32));
        let keys = self.keys.clone().map(|key| self.round(key, start, step, most));
        Some(TrackSegment { head, keys: keys.collect::<Option<_>>()? })
    }

    /// Returns the head with which all keys are within the numbers of `bits`.
    fn head(&self, bits: [u8; 3]) -> SegmentHead {
        if self.wanted.values.len() <= 1 << self.wanted.shift {
            return SegmentHead::only(bits);
        }
        let (mut head, span) = (SegmentHead { bits, ..SegmentHead::default() }, self.span());
        for axis in 0..3 {
            let (place, extent) = place_and_extent(&self.wanted.range, axis, span[axis], bits[axis]);
            (head.place[axis], head.extent[axis]) = (place, extent);
        }
        head
    }

    fn start_and_step(&self, head: &SegmentHead) -> (Vec3, Vec3) {
        let [x, y, z] = [0, 1, 2].map(|axis| head.start_and_step(&self.wanted.range, axis));
        (Vec3::new(x.0, y.0, z.0), Vec3::new(x.1, y.1, z.1))
    }

    /// Returns the decoded values for the keys of a segment.
    fn decoded(&self, segment: &TrackSegment) -> Vec<Vec3> {
        let (start, step) = self.start_and_step(&segment.head);
        let value = |numbers: &[u32; 3]| start + step * Vec3::from_array(numbers.map(|number| number as f32));
        segment.keys.iter().map(value).collect()
    }

    /// Returns the numbers for `key`: the nearest, or where its error is too large the first of its neighbors whose
    /// error is not. Within a tolerance that several bones share, the corner that is numerically nearest does not
    /// always have the smallest error.
    fn round(&mut self, key: usize, start: Vec3, step: Vec3, most: Vec3) -> Option<[u32; 3]> {
        let away = self.wanted.values[key] - start;
        let first = nearest(away, step);
        let other = first + Vec3::select(step.cmpgt(Vec3::ZERO), (away - first * step).signum(), Vec3::ZERO);
        CORNERS.into_iter().find_map(|corner| {
            let numbers = Vec3::select(corner, other, first).max(Vec3::ZERO).min(most);
            let near = (self.error)(key, start + step * numbers) <= 1.0;
            near.then(|| numbers.to_array().map(|number| number as u32))
        })
    }
}

/// Bits subtracted from the widest component, the second, and the last; each change saves at least one.
const CHANGES: [[i8; 3]; 9] = [
    [-1, 0, 0],
    [0, -1, 0],
    [0, 0, -1],
    [1, -1, -1],
    [-1, 1, -1],
    [-1, -1, 1],
    [1, -2, 0],
    [-2, 1, 0],
    [-2, 0, 1],
];

/// Returns the changed bits; `None` where a component would have too few or too many.
fn changed(bits: [u8; 3], change: &[i8; 3]) -> Option<[u8; 3]> {
    let mut order = [0, 1, 2];
    order.sort_by_key(|&axis| std::cmp::Reverse(bits[axis]));
    let mut changed = bits;
    for (axis, change) in order.into_iter().zip(change) {
        changed[axis] = bits[axis].checked_add_signed(*change).filter(|&bits| u32::from(bits) <= MAX_BITS)?;
    }
    Some(changed)
}

/// The components that are rounded in the other direction.
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
/// Returns each distance as a whole number of steps, rounded to nearest; 0 where a step has no length.
fn nearest(distance: Vec3, step: Vec3) -> Vec3 {
    let numbers = distance / step;
    Vec3::select(step.cmpgt(Vec3::ZERO), numbers.round(), Vec3::ZERO)
}

/// Returns the bits needed to distinguish keys in steps of `step`.
fn first_bits(span: (f32, f32), step: f32) -> u8 {
    let numbers = (span.1 - span.0) / step;
    let least = if span.1 - span.0 > step { 1.0 } else { 0.0 };
    // The number of steps itself is not rounded up: rounding to a step is off by half a step in either direction
    // anyway.
    libm::log2f(numbers + 1.0).ceil().max(least).min(MAX_BITS as f32) as u8
}

/// Returns the position of `span` in `range`: the smallest extent, and the largest start, that contain it.
fn place_and_extent(range: &ValueRange, axis: usize, span: (f32, f32), bits: u8) -> (u8, u8) {
    let whole = range.extent[axis];
    if whole <= 0.0 {
        return (0, 0);
    }
    let low = ((span.0 - range.low[axis]) / whole).clamp(0.0, 1.0);
    let high = ((span.1 - range.low[axis]) / whole).clamp(0.0, 1.0);
    if bits == 0 {
        // No extent is needed, so both bytes together store the position of the middle.
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
