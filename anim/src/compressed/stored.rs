//! The content of a compressed take before it is written as bytes.

use super::clock::FrameClock;
use crate::data::{Interpolation, Transform};
use glam::{Quat, Vec3};

/// Rotation, translation, scale: the order in which channels are stored.
pub(super) const PARTS: usize = 3;
/// Largest number of bits of a number: whole numbers up to 2²⁴ are exact as `f32`.
pub(super) const MAX_BITS: u32 = 22;
/// The largest translation or factor: sums of a few of them are still finite.
pub(super) const LARGEST: f32 = 1e30;
/// Number of keys of a segment as a power of two.
pub(super) const SHIFTS: std::ops::RangeInclusive<u32> = 1..=16;

/// The content of a compressed take.
#[derive(Clone, Debug)]
pub(super) struct StoredTake {
    pub(super) name: String,
    pub(super) clock: FrameClock,
    /// A segment has `1 << shift` keys.
    pub(super) shift: u32,
    pub(super) grid: RoundingGrid,
    /// For each bone: rotation, translation, scale.
    pub(super) bones: Vec<[StoredChannel; PARTS]>,
}

/// Rounding of constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RoundingGrid {
    /// Bits of each of three components of a rotation; 32 means four whole floats.
    pub(super) rotation_bits: u32,
    /// Length of one step of a translation.
    pub(super) step: f32,
    /// Bits of a number of steps, sign included; 32 means a whole float.
    pub(super) translation_bits: u32,
}

/// Rotation, translation or scale of one bone.
#[derive(Clone, Debug)]
pub(super) enum StoredChannel {
    /// Identity: no rotation, no translation, scale 1.
    Default,
    /// One value at all times; a vector's fourth number is 0.
    Constant([f32; 4]),
    /// Numbers of few bits.
    PackedChannel(PackedChannel),
    /// One value per key, in single precision.
    Whole(Vec<[f32; 4]>),
}

impl StoredChannel {
    /// Returns the packed channel; `None` for the other kinds of storage.
    pub(super) fn packed(&self) -> Option<&PackedChannel> {
        if let Self::PackedChannel(packed) = self { Some(packed) } else { None }
    }

    /// Returns the code of the storage in the bytes.
    pub(super) fn kind(&self) -> u32 {
        match self {
            Self::Default => DEFAULT,
            Self::Constant(_) => CONSTANT,
            Self::PackedChannel(_) => PACKED,
            Self::Whole(_) => WHOLE,
        }
    }
}

pub(super) const DEFAULT: u32 = 0;
pub(super) const CONSTANT: u32 = 1;
pub(super) const PACKED: u32 = 2;
pub(super) const WHOLE: u32 = 3;

/// Three components in few bits.
#[derive(Clone, Debug)]
pub(super) struct PackedChannel {
    /// For a rotation: the rotation that the components are relative to.
    pub(super) reference: Reference,
    pub(super) range: ValueRange,
    pub(super) segments: Vec<TrackSegment>,
}

/// A rotation near all those of a track, in 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Reference(pub(super) [i8; 4]);

impl Reference {
    pub(super) const NONE: Self = Self([0, 0, 0, 127]);

    pub(super) fn near(rotation: Quat) -> Self {
        Self(rotation.to_array().map(|number| (number * 127.0).round() as i8))
    }

    /// Returns the rotation; the identity where all numbers are zero.
    pub(super) fn rotation(self) -> Quat {
        let [x, y, z, w] = self.0.map(f32::from);
        let rotation = Quat::from_xyzw(x, y, z, w);
        if rotation.length_squared() > 0.0 { rotation.normalize() } else { Quat::IDENTITY }
    }
}

/// Range of the components of a track over the whole take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueRange {
    pub(super) low: Vec3,
    pub(super) extent: Vec3,
}

/// One track in one segment.
#[derive(Clone, Debug, Default)]
pub(super) struct TrackSegment {
    pub(super) head: SegmentHead,
    /// The numbers of each key.
    pub(super) keys: Vec<[u32; 3]>,
}

/// Range of the components in one segment, and the bits of each; `[x, y, z]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SegmentHead {
    /// Start, as a fraction of the take's range.
    pub(super) place: [u8; 3],
    /// Extent, as a fraction of the take's range.
    pub(super) extent: [u8; 3],
    pub(super) bits: [u8; 3],
}

impl SegmentHead {
    /// Returns the head in a take of one segment, which spans the whole range: only the bits are stored then.
    pub(super) fn only(bits: [u8; 3]) -> Self {
        let (place, extent) = (bits.map(|bits| if bits == 0 { 127 } else { 0 }), [255; 3]);
        Self { place, extent, bits }
    }

    /// Returns start and step of component `axis`: the value of a key with the number `n` is `start + step n`.
    ///
    /// The step is rounded up to the 16 highest bits of a float, so that tables can store it in those.
    pub(super) fn start_and_step(&self, range: &ValueRange, axis: usize) -> (f32, f32) {
        let together = f32::from(u16::from(self.place[axis]) << 8 | u16::from(self.extent[axis]));
        let start = range.low[axis] + range.extent[axis] * (together * PER_PLACE);
        if self.bits[axis] == 0 {
            return (start, 0.0);
        }
        let numbers = (1_u32 << self.bits[axis].min(31)) - 1;
        let step = range.extent[axis] * (f32::from(self.extent[axis]) * PER_EXTENT) / numbers as f32;
        (start, f32::from_bits((step.to_bits() + 0xffff) & 0xffff_0000))
    }

    /// Returns the bits of all three components.
    pub(super) fn width(&self) -> u32 {
        self.bits.iter().map(|&bits| u32::from(bits)).sum()
    }
}

/// Unit of [`SegmentHead::place`] and [`SegmentHead::extent`], read as one number, as a fraction of a range.
pub(super) const PER_PLACE: f32 = 1.0 / 65_535.0;
/// Unit of [`SegmentHead::extent`] as a fraction of a range.
pub(super) const PER_EXTENT: f32 = 1.0 / 255.0;

/// Returns the rotation whose components relative to `reference` are `xyz`; its w is not negative there.
pub(super) fn rotation_of(reference: Quat, xyz: Vec3) -> Quat {
    reference * xyz.extend_to_unit()
}

trait ToUnit {
    fn extend_to_unit(self) -> Quat;
}

impl ToUnit for Vec3 {
    fn extend_to_unit(self) -> Quat {
        Quat::from_xyzw(self.x, self.y, self.z, (1.0 - self.length_squared()).max(0.0).sqrt())
    }
}

/// Returns the pose of a bone's constant channels; channels that move give the default.
pub(super) fn constant(parts: &[StoredChannel; PARTS]) -> Transform {
    let of = |part: &StoredChannel, default: [f32; 4]| {
        if let StoredChannel::Constant(value) = part { *value } else { default }
    };
    let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    Transform {
        rotation: Quat::from_array(of(&parts[0], [0.0, 0.0, 0.0, 1.0])),
        translation: three(of(&parts[1], [0.0; 4])),
        scale: three(of(&parts[2], [1.0; 4])),
    }
}

/// Interpolation of takes made from decoded keys.
pub(super) const BETWEEN: Interpolation = Interpolation::Linear;
