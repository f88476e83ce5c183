//! The operations that a set of instructions must have: on vectors of eight and of four numbers.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Number of lanes of the wide vectors.
pub const LANES: usize = 8;

/// Eight `f32`. Halves are lanes 0..4 and lanes 4..8.
///
/// A mask is a vector whose lanes have all bits set (true) or none (false).
pub trait Float8:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The words of the same set of instructions.
    type Word: Word8<Float = Self>;
    /// Vector of one half.
    type Half: Float4;

    /// Returns the same number eight times.
    fn splat(value: f32) -> Self;
    /// Loads from memory, lane by lane.
    fn load(from: &[f32; 8]) -> Self;
    /// Stores to memory, lane by lane.
    fn store(self, to: &mut [f32; 8]);
    /// Loads three vectors from memory.
    #[inline(always)]
    fn load_three(from: &[[f32; 8]; 3]) -> [Self; 3] {
        [Self::load(&from[0]), Self::load(&from[1]), Self::load(&from[2])]
    }
    /// Loads four vectors from memory.
    #[inline(always)]
    fn load_four(from: &[[f32; 8]; 4]) -> [Self; 4] {
        [Self::load(&from[0]), Self::load(&from[1]), Self::load(&from[2]), Self::load(&from[3])]
    }
    /// Stores three vectors to memory.
    #[inline(always)]
    fn store_three([a, b, c]: [Self; 3], to: &mut [[f32; 8]; 3]) {
        a.store(&mut to[0]);
        b.store(&mut to[1]);
        c.store(&mut to[2]);
    }
    /// Stores four vectors to memory.
    #[inline(always)]
    fn store_four([a, b, c, d]: [Self; 4], to: &mut [[f32; 8]; 4]) {
        a.store(&mut to[0]);
        b.store(&mut to[1]);
        c.store(&mut to[2]);
        d.store(&mut to[3]);
    }
    /// Converts whole numbers 0..=65,535 to floats, exactly.
    fn from_u16(from: &[u16; 8]) -> Self;
    /// Converts whole numbers 0..=255 to floats, exactly.
    fn from_u8(from: &[u8; 8]) -> Self;

    /// Returns `self * factor + addend`, rounded once where the level has fused multiply-add.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Returns `addend - self * factor`, rounded once where the level has fused multiply-add.
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self;
    /// Returns the square root, correctly rounded; NaN for numbers below zero.
    fn sqrt(self) -> Self;
    /// Returns the larger; `other` where either is NaN.
    fn max(self, other: Self) -> Self;
    /// Returns the smaller; `other` where either is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns the absolute value.
    fn abs(self) -> Self;

    /// Returns the sign bit alone: 0.0 or -0.0.
    fn sign(self) -> Self;
    /// Negates those lanes where the bits of `sign` are set; `sign` is the result of [`Self::sign`].
    fn flipped_by(self, sign: Self) -> Self;
    /// Returns the mask `self < other`; false for NaN.
    fn less(self, other: Self) -> Self;
    /// Returns `yes` where the mask `self` is set, and `no` elsewhere.
    fn select(self, yes: Self, no: Self) -> Self;
    /// Returns in each lane the number of lane `lanes[lane] % 8` of `self`, where the highest bit of `lanes[lane]` is
    /// set, and that of `others` elsewhere.
    fn picked(self, lanes: &[u32; 8], others: Self) -> Self;
    /// Returns whether any lane of the mask `self` is set.
    fn any(self) -> bool;
    /// Returns whether every lane of the mask `self` is set.
    fn all(self) -> bool;
    /// Returns the bits as words.
    fn to_bits(self) -> Self::Word;

    /// Loads the same four numbers into both halves.
    fn twice(from: &[f32; 4]) -> Self;
    /// Loads each half from its own place.
    fn from_halves(low: &[f32; 4], high: &[f32; 4]) -> Self;
    /// Returns a vector of two halves.
    fn joined(low: Self::Half, high: Self::Half) -> Self;
    /// Stores each half to its own place.
    fn store_halves(self, low: &mut [f32; 4], high: &mut [f32; 4]);
    /// Returns the low half.
    fn low(self) -> Self::Half;
    /// Returns the high half.
    fn high(self) -> Self::Half;
    /// Broadcasts in each half its own number `LANE` (0..=3) to all four lanes.
    fn spread<const LANE: usize>(self) -> Self;
    /// Keeps in each half the last number, with zero elsewhere.
    fn keep_last(self) -> Self;
    /// Returns the transposed rows: row `k` of the result has number `k` of each of the four low halves, then number
    /// `k` of each of the high ones.
    ///
    /// Four vectors with one coordinate of eight items each become four with all coordinates of two items each: item
    /// `k` and item `k + 4`. Applied twice it changes nothing.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// Stores eight x, y and z to memory as eight points: x y z x y z …
    fn store_points(rows: [Self; 3], to: &mut [f32; 24]);
}

/// Four `f32`.
pub trait Float4:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// Returns the same number four times.
    fn splat(value: f32) -> Self;
    /// Loads from memory, lane by lane.
    fn load(from: &[f32; 4]) -> Self;
    /// Stores to memory, lane by lane.
    fn store(self, to: &mut [f32; 4]);
    /// Returns `self * factor + addend`, rounded once where the level has fused multiply-add.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Broadcasts number `LANE` (0..=3) to all four lanes.
    fn spread<const LANE: usize>(self) -> Self;
    /// Keeps the last number, with zero elsewhere.
    fn keep_last(self) -> Self;
    /// Returns the transposed rows: row `k` of the result has number `k` of each.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
}

/// Eight words of 32 bits.
pub trait Word8: Copy + Debug + Add<Output = Self> + BitAnd<Output = Self> + BitOr<Output = Self> {
    /// The floats of the same set of instructions.
    type Float;

    /// Returns the same word eight times.
    fn splat(value: u32) -> Self;
    /// Loads from memory, lane by lane.
    fn load(from: &[u32; 8]) -> Self;
    /// Stores to memory, lane by lane.
    fn store(self, to: &mut [u32; 8]);
    /// Shifts to the right, each lane by its own count; 0 from 32 on.
    fn shifted_right(self, count: Self) -> Self;
    /// Shifts to the left, each lane by its own count; 0 from 32 on.
    fn shifted_left(self, count: Self) -> Self;
    /// Loads the four bytes from each lane's offset on, the lowest first.
    ///
    /// An offset past the last whole word reads the last whole word; all zero when `bytes` has fewer than four bytes.
    fn gather(bytes: &[u8], offsets: Self) -> Self;
    /// Converts whole numbers 0..=65,535 to words.
    fn from_u16(from: &[u16; 8]) -> Self;
    /// Converts whole numbers 0..=255 to words.
    fn from_u8(from: &[u8; 8]) -> Self;
    /// Returns the bits that are set here and not in `other`.
    fn without(self, other: Self) -> Self;
    /// Loads four bytes into each lane, the lowest first: in lanes 0..4 from byte `at + lanes[lane]` on, in lanes 4..8
    /// from byte `at + second % 16 + lanes[lane]` on.
    ///
    /// Each half can reach sixteen bytes: offsets of 16 to 127 wrap around within them, and a byte at an offset of 128
    /// or more is zero. An `at` past the last 32 bytes is clamped to their first; all lanes are zero when `bytes` has
    /// fewer than 32 bytes.
    fn near(bytes: &[u8], at: usize, second: u8, lanes: &[u8; 8]) -> Self;
    /// Converts whole numbers below 2³¹ to floats, rounded to nearest.
    fn to_float(self) -> Self::Float;
    /// Returns the same bits as floats; a mask stays a mask.
    fn as_float(self) -> Self::Float;
}
