//! What a set of instructions must offer: vectors of eight and of four numbers.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// The vectors of one set of instructions.
pub trait Simd: Copy + Debug {
    /// Eight numbers.
    type F8: Float8<Word = Self::U8, Half = Self::F4>;
    /// Four numbers.
    type F4: Float4;
    /// Eight words of 32 bits.
    type U8: Word8<Float = Self::F8>;
}

/// Eight `f32`. Where a method speaks of halves: lanes 0..4 and lanes 4..8.
///
/// A mask is a vector whose lanes have all bits set (yes) or none (no).
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
    /// One half.
    type Half: Float4;

    /// The same number eight times.
    fn splat(value: f32) -> Self;
    /// From memory, lane by lane.
    fn load(from: &[f32; 8]) -> Self;
    /// To memory, lane by lane.
    fn store(self, to: &mut [f32; 8]);
    /// Three vectors from memory.
    #[inline(always)]
    fn load_three(from: &[[f32; 8]; 3]) -> [Self; 3] {
        [Self::load(&from[0]), Self::load(&from[1]), Self::load(&from[2])]
    }
    /// Four vectors from memory.
    #[inline(always)]
    fn load_four(from: &[[f32; 8]; 4]) -> [Self; 4] {
        [Self::load(&from[0]), Self::load(&from[1]), Self::load(&from[2]), Self::load(&from[3])]
    }
    /// Three vectors to memory.
    #[inline(always)]
    fn store_three([a, b, c]: [Self; 3], to: &mut [[f32; 8]; 3]) {
        a.store(&mut to[0]);
        b.store(&mut to[1]);
        c.store(&mut to[2]);
    }
    /// Four vectors to memory.
    #[inline(always)]
    fn store_four([a, b, c, d]: [Self; 4], to: &mut [[f32; 8]; 4]) {
        a.store(&mut to[0]);
        b.store(&mut to[1]);
        c.store(&mut to[2]);
        d.store(&mut to[3]);
    }
    /// Whole numbers 0..=65,535 as floats, exactly.
    fn from_u16(from: &[u16; 8]) -> Self;
    /// Whole numbers 0..=255 as floats, exactly.
    fn from_u8(from: &[u8; 8]) -> Self;

    /// `self * factor + addend`, rounded once where the level has that.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `addend - self * factor`, likewise.
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self;
    /// The square root, correctly rounded; NaN for numbers below zero.
    fn sqrt(self) -> Self;
    /// The larger; `other` where either is NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller; `other` where either is NaN.
    fn min(self, other: Self) -> Self;
    /// Without its sign.
    fn abs(self) -> Self;

    /// The sign bit alone: 0.0 or -0.0.
    fn sign(self) -> Self;
    /// Negated in those lanes where the bits of `sign` are set; `sign` is the result of [`Self::sign`].
    fn flipped_by(self, sign: Self) -> Self;
    /// A mask: is `self < other`? No for NaN.
    fn less(self, other: Self) -> Self;
    /// `self` is a mask: `yes` where it is set, else `no`.
    fn select(self, yes: Self, no: Self) -> Self;
    /// `self` is a mask: is any lane set?
    fn any(self) -> bool;
    /// `self` is a mask: is every lane set?
    fn all(self) -> bool;
    /// The bits as words.
    fn to_bits(self) -> Self::Word;

    /// The same four numbers in both halves.
    fn twice(from: &[f32; 4]) -> Self;
    /// One half from each place.
    fn from_halves(low: &[f32; 4], high: &[f32; 4]) -> Self;
    /// One half to each place.
    fn store_halves(self, low: &mut [f32; 4], high: &mut [f32; 4]);
    /// The low half.
    fn low(self) -> Self::Half;
    /// The high half.
    fn high(self) -> Self::Half;
    /// In each half its own number `LANE` (0..=3) four times.
    fn spread<const LANE: usize>(self) -> Self;
    /// In each half the last number; zero elsewhere.
    fn keep_last(self) -> Self;
    /// Row `k` of the result: number `k` of each of the four low halves, then number `k` of each of the high ones.
    ///
    /// Four vectors that hold one coordinate of eight things become four that hold all coordinates of two things:
    /// thing `k` and thing `k + 4`. Applied twice it changes nothing.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// Eight x, y and z to memory as eight points: x y z x y z …
    fn store_points(rows: [Self; 3], to: &mut [f32; 24]);
}

/// Four `f32`.
pub trait Float4:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The same number four times.
    fn splat(value: f32) -> Self;
    /// From memory, lane by lane.
    fn load(from: &[f32; 4]) -> Self;
    /// To memory, lane by lane.
    fn store(self, to: &mut [f32; 4]);
    /// `self * factor + addend`, rounded once where the level has that.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Number `LANE` (0..=3) four times.
    fn spread<const LANE: usize>(self) -> Self;
    /// The last number; zero elsewhere.
    fn keep_last(self) -> Self;
}

/// Eight words of 32 bits.
pub trait Word8: Copy + Debug + Add<Output = Self> + BitAnd<Output = Self> + BitOr<Output = Self> {
    /// The floats of the same set of instructions.
    type Float;

    /// The same word eight times.
    fn splat(value: u32) -> Self;
    /// From memory, lane by lane.
    fn load(from: &[u32; 8]) -> Self;
    /// To memory, lane by lane.
    fn store(self, to: &mut [u32; 8]);
    /// Shifted to the right, each lane by its own count; 0 from 32 on.
    fn shifted_right(self, count: Self) -> Self;
    /// Shifted to the left, each lane by its own count; 0 from 32 on.
    fn shifted_left(self, count: Self) -> Self;
    /// The four bytes from each lane's offset on, the lowest first.
    ///
    /// An offset past the last whole word reads the last whole word; all zero when `bytes` holds fewer than four.
    fn gather(bytes: &[u8], offsets: Self) -> Self;
    /// Whole numbers 0..=65,535 as words.
    fn from_u16(from: &[u16; 8]) -> Self;
    /// Whole numbers 0..=255 as words.
    fn from_u8(from: &[u8; 8]) -> Self;
    /// The bits that are set here and not in `other`.
    fn without(self, other: Self) -> Self;
    /// Four bytes in each lane, the lowest first: in lanes 0..4 from byte `at + lanes[lane]` on, in lanes 4..8 from byte
    /// `at + second % 16 + lanes[lane]` on.
    ///
    /// Each half sees sixteen bytes: what would lie past them is taken from their beginning, and is zero from byte 128
    /// on. An `at` past the last 32 bytes is taken for their first; all zero when `bytes` holds fewer than 32.
    fn near(bytes: &[u8], at: usize, second: u8, lanes: &[u8; 8]) -> Self;
    /// Whole numbers below 2³¹ as floats, rounded to nearest.
    fn to_float(self) -> Self::Float;
    /// The same bits as floats; a mask stays a mask.
    fn as_float(self) -> Self::Float;
}
