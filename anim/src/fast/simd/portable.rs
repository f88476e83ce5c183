//! The vectors of every machine: arrays, and loops short enough for a compiler to vectorize.

use super::kernel::{Kernel, Simd};
use super::pair::TwoRows;
use super::rows::TwoVectors;
use super::vector::{Float4, Float8, Word8};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Instructions that every machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Portable;

impl Simd for Portable {
    const IS_WIDE: bool = false;
    type F8 = Array8;
    type F4 = Array4;
    type U8 = Words8;
    type Rows = TwoVectors<Array8>;
    type Many = Array8;
    type Pair = TwoRows<Array8>;

    #[inline(always)]
    fn call<K: Kernel>(part: K) -> K::Output {
        run(part)
    }
}

/// Runs `kernel` with these vectors. A separate function, so that callers at another level do not save the registers
/// that this one needs.
#[inline(never)]
pub(super) fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Portable>()
}

/// Eight numbers.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Array8([f32; 8]);

/// Four numbers.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Array4([f32; 4]);

/// Eight words.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Words8([u32; 8]);

/// Whether a multiply-add is one instruction of the target, not a function call.
const FUSED: bool = cfg!(any(target_arch = "aarch64", target_feature = "fma"));

#[inline(always)]
fn mul_add(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Creates a `$new` from the lanes that `$lane` gives for the index `$at`.
macro_rules! lanes {
    ($new:ident, $zero:expr, $at:ident => $lane:expr) => {{
        let mut lanes = $zero;
        let mut $at = 0;
        while $at < lanes.len() {
            lanes[$at] = $lane;
            $at += 1;
        }
        $new(lanes)
    }};
}

/// An operator, lane by lane.
macro_rules! operator {
    ($vector:ident, $zero:expr, $trait:ident, $method:ident, $operator:tt) => {
        impl $trait for $vector {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                lanes!(Self, $zero, at => self.0[at] $operator other.0[at])
            }
        }
    };
}

operator!(Array8, [0.0; 8], Add, add, +);
operator!(Array8, [0.0; 8], Sub, sub, -);
operator!(Array8, [0.0; 8], Mul, mul, *);
operator!(Array8, [0.0; 8], Div, div, /);
operator!(Array4, [0.0; 4], Add, add, +);
operator!(Array4, [0.0; 4], Sub, sub, -);
operator!(Array4, [0.0; 4], Mul, mul, *);
operator!(Words8, [0; 8], BitAnd, bitand, &);
operator!(Words8, [0; 8], BitOr, bitor, |);

impl Neg for Array8 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        lanes!(Self, [0.0; 8], at => -self.0[at])
    }
}

impl Neg for Array4 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        lanes!(Self, [0.0; 4], at => -self.0[at])
    }
}

impl Add for Words8 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        lanes!(Self, [0; 8], at => self.0[at].wrapping_add(other.0[at]))
    }
}

impl Float8 for Array8 {
    type Word = Words8;
    type Half = Array4;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 8])
    }

    #[inline(always)]
    fn load(from: &[f32; 8]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        *to = self.0;
    }

    #[inline(always)]
    fn from_u16(from: &[u16; 8]) -> Self {
        lanes!(Self, [0.0; 8], at => f32::from(from[at]))
    }

    #[inline(always)]
    fn from_u8(from: &[u8; 8]) -> Self {
        lanes!(Self, [0.0; 8], at => f32::from(from[at]))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        lanes!(Self, [0.0; 8], at => mul_add(self.0[at], factor.0[at], addend.0[at]))
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        lanes!(Self, [0.0; 8], at => mul_add(-self.0[at], factor.0[at], addend.0[at]))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        lanes!(Self, [0.0; 8], at => self.0[at].sqrt())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        lanes!(Self, [0.0; 8], at => if self.0[at] > other.0[at] { self.0[at] } else { other.0[at] })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        lanes!(Self, [0.0; 8], at => if self.0[at] < other.0[at] { self.0[at] } else { other.0[at] })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        lanes!(Self, [0.0; 8], at => self.0[at].abs())
    }

    #[inline(always)]
    fn sign(self) -> Self {
        lanes!(Self, [0.0; 8], at => f32::from_bits(self.0[at].to_bits() & SIGN))
    }

    #[inline(always)]
    fn flipped_by(self, sign: Self) -> Self {
        lanes!(Self, [0.0; 8], at => f32::from_bits(self.0[at].to_bits() ^ sign.0[at].to_bits()))
    }

    #[inline(always)]
    fn less(self, other: Self) -> Self {
        lanes!(Self, [0.0; 8], at => f32::from_bits(if self.0[at] < other.0[at] { u32::MAX } else { 0 }))
    }

    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        lanes!(Self, [0.0; 8], at => if self.0[at].to_bits() & SIGN != 0 { yes.0[at] } else { no.0[at] })
    }

    #[inline(always)]
    fn picked(self, lanes: &[u32; 8], others: Self) -> Self {
        lanes!(Self, [0.0; 8], at => if lanes[at] & SIGN != 0 { self.0[lanes[at] as usize % 8] } else { others.0[at] })
    }

    #[inline(always)]
    fn any(self) -> bool {
        let mut bits = 0;
        for lane in self.0 {
            bits |= lane.to_bits();
        }
        bits & SIGN != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        let mut bits = u32::MAX;
        for lane in self.0 {
            bits &= lane.to_bits();
        }
        bits & SIGN != 0
    }

    #[inline(always)]
    fn to_bits(self) -> Words8 {
        lanes!(Words8, [0; 8], at => self.0[at].to_bits())
    }

    #[inline(always)]
    fn twice(from: &[f32; 4]) -> Self {
        Self::from_halves(from, from)
    }

    #[inline(always)]
    fn from_halves(low: &[f32; 4], high: &[f32; 4]) -> Self {
        Self([low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]])
    }

    #[inline(always)]
    fn joined(Array4([a, b, c, d]): Array4, Array4([e, f, g, h]): Array4) -> Self {
        Self([a, b, c, d, e, f, g, h])
    }

    #[inline(always)]
    fn store_halves(self, low: &mut [f32; 4], high: &mut [f32; 4]) {
        let [a, b, c, d, e, f, g, h] = self.0;
        (*low, *high) = ([a, b, c, d], [e, f, g, h]);
    }

    #[inline(always)]
    fn low(self) -> Array4 {
        Array4([self.0[0], self.0[1], self.0[2], self.0[3]])
    }

    #[inline(always)]
    fn high(self) -> Array4 {
        Array4([self.0[4], self.0[5], self.0[6], self.0[7]])
    }

    #[inline(always)]
    fn spread<const LANE: usize>(self) -> Self {
        let (low, high) = (self.0[LANE & 3], self.0[4 + (LANE & 3)]);
        Self([low, low, low, low, high, high, high, high])
    }

    #[inline(always)]
    fn keep_last(self) -> Self {
        Self([0.0, 0.0, 0.0, self.0[3], 0.0, 0.0, 0.0, self.0[7]])
    }

    #[inline(always)]
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        let [a, b, c, d] = [rows[0].0, rows[1].0, rows[2].0, rows[3].0];
        [
            Self([a[0], b[0], c[0], d[0], a[4], b[4], c[4], d[4]]),
            Self([a[1], b[1], c[1], d[1], a[5], b[5], c[5], d[5]]),
            Self([a[2], b[2], c[2], d[2], a[6], b[6], c[6], d[6]]),
            Self([a[3], b[3], c[3], d[3], a[7], b[7], c[7], d[7]]),
        ]
    }

    #[inline(always)]
    fn store_points([x, y, z]: [Self; 3], to: &mut [f32; 24]) {
        for (at, to) in to.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            *to = [x.0[at], y.0[at], z.0[at]];
        }
    }
}

/// The sign bit; in a mask, the bit that is set for true.
const SIGN: u32 = 1 << 31;

impl Float4 for Array4 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 4])
    }

    #[inline(always)]
    fn load(from: &[f32; 4]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; 4]) {
        *to = self.0;
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        lanes!(Self, [0.0; 4], at => mul_add(self.0[at], factor.0[at], addend.0[at]))
    }

    #[inline(always)]
    fn spread<const LANE: usize>(self) -> Self {
        Self([self.0[LANE & 3]; 4])
    }

    #[inline(always)]
    fn keep_last(self) -> Self {
        Self([0.0, 0.0, 0.0, self.0[3]])
    }

    #[inline(always)]
    fn transpose([Self(a), Self(b), Self(c), Self(d)]: [Self; 4]) -> [Self; 4] {
        [
            Self([a[0], b[0], c[0], d[0]]),
            Self([a[1], b[1], c[1], d[1]]),
            Self([a[2], b[2], c[2], d[2]]),
            Self([a[3], b[3], c[3], d[3]]),
        ]
    }
}

/// Returns four bytes of a half, as [`Word8::near`] does.
#[inline(always)]
fn word_of(half: u128, first: u8) -> u32 {
    // A rotation wraps around as the offsets do.
    if first < 125 { half.rotate_right(8 * u32::from(first & 15)) as u32 } else { cut_word_of(half, first) }
}

/// As [`word_of`], where some bytes may be zero because of their offset.
#[cold]
fn cut_word_of(half: u128, first: u8) -> u32 {
    let byte = |step: u8| {
        let from = first.wrapping_add(step);
        if from < 128 { (half >> (8 * u32::from(from & 15))) as u8 } else { 0 }
    };
    u32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)])
}

impl Word8 for Words8 {
    type Float = Array8;

    #[inline(always)]
    fn splat(value: u32) -> Self {
        Self([value; 8])
    }

    #[inline(always)]
    fn load(from: &[u32; 8]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut [u32; 8]) {
        *to = self.0;
    }

    #[inline(always)]
    fn shifted_right(self, count: Self) -> Self {
        lanes!(Self, [0; 8], at => self.0[at].checked_shr(count.0[at]).unwrap_or(0))
    }

    #[inline(always)]
    fn shifted_left(self, count: Self) -> Self {
        lanes!(Self, [0; 8], at => self.0[at].checked_shl(count.0[at]).unwrap_or(0))
    }

    #[inline(always)]
    fn gather(bytes: &[u8], offsets: Self) -> Self {
        let Some(last) = bytes.len().checked_sub(4) else { return Self([0; 8]) };
        lanes!(Self, [0; 8], at => {
            let from = (offsets.0[at] as usize).min(last);
            match bytes[from..].first_chunk() {
                Some(&word) => u32::from_le_bytes(word),
                None => 0,
            }
        })
    }

    #[inline(always)]
    fn from_u16(from: &[u16; 8]) -> Self {
        lanes!(Self, [0; 8], at => u32::from(from[at]))
    }

    #[inline(always)]
    fn from_u8(from: &[u8; 8]) -> Self {
        lanes!(Self, [0; 8], at => u32::from(from[at]))
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        lanes!(Self, [0; 8], at => self.0[at] & !other.0[at])
    }

    #[inline(always)]
    fn near(bytes: &[u8], at: usize, second: u8, lanes: &[u8; 8]) -> Self {
        let Some(last) = bytes.len().checked_sub(32) else { return Self([0; 8]) };
        let chunk = bytes.get(at.min(last)..).unwrap_or_default();
        let (Some(low), Some(high)) =
            (chunk.first_chunk(), chunk.get(usize::from(second & 15)..).and_then(|high| high.first_chunk()))
        else {
            return Self([0; 8]);
        };
        let (low, high) = (u128::from_le_bytes(*low), u128::from_le_bytes(*high));
        lanes!(Self, [0; 8], lane => word_of(if lane < 4 { low } else { high }, lanes[lane]))
    }

    #[inline(always)]
    fn to_float(self) -> Array8 {
        lanes!(Array8, [0.0; 8], at => self.0[at] as i32 as f32)
    }

    #[inline(always)]
    fn as_float(self) -> Array8 {
        lanes!(Array8, [0.0; 8], at => f32::from_bits(self.0[at]))
    }
}
