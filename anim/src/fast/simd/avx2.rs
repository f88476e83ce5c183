//! The vectors of x86-64 processors with AVX2 and FMA.
//!
//! The only file of the crate with `unsafe` code. Each use of it is one of three:
//!
//! * an instruction that needs AVX2 or FMA. The types here are private to [`super`]: other code can name them only as
//!   `S::F8` and its like inside [`Kernel::run`], which is called with them only by [`CpuSupport::run`], and a
//!   [`CpuSupport`] exists only if the processor has both;
//! * an unaligned load or store through a reference to an array of exactly as many bytes;
//! * the gather and [`Word8::near`], which keep their offsets within the slice.

use super::kernel::{Kernel, Simd};
use super::pair::TwoRows;
use super::rows::TwoVectors;
use super::vector::{Float4, Float8, Word8};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Proof that the processor has AVX2 and FMA.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct CpuSupport(());

impl CpuSupport {
    /// Detects the features of the processor.
    pub(super) fn detect() -> Option<Self> {
        (is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")).then_some(Self(()))
    }

    /// Runs `kernel` with these vectors.
    #[inline]
    pub(super) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        // SAFETY: `self` is proof that the processor has both features.
        unsafe { run(kernel) }
    }
}

/// Everything that is inlined into this function is compiled with AVX2 and FMA.
#[target_feature(enable = "avx2,fma")]
fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

/// The set of instructions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx2;

impl Simd for Avx2 {
    const IS_WIDE: bool = true;
    type F8 = F8;
    type F4 = F4;
    type U8 = U8;
    type Rows = TwoVectors<F8>;
    type Many = F8;
    type Pair = TwoRows<F8>;

    #[inline(always)]
    fn call<K: Kernel>(part: K) -> K::Output {
        // SAFETY: only a kernel that runs with these instructions can name this type, see the top of the file.
        unsafe { run(part) }
    }
}

/// Eight numbers in one register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F8(pub(super) __m256);

/// Four numbers in one register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F4(pub(super) __m128);

/// Eight words in one register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct U8(pub(super) __m256i);

/// An instruction on registers and constants only.
macro_rules! instruction {
    ($instruction:expr) => {
        // SAFETY: the types of this file, and of `avx512.rs` and `sixteen.rs`, can only be used where the processor has the
        // features, see the top of each.
        unsafe { $instruction }
    };
}

/// An instruction that reads or writes memory through a reference to an array.
macro_rules! memory {
    ($instruction:expr) => {
        // SAFETY: as for `instruction`; and the array of the reference has exactly the bytes that an unaligned
        // access of this width touches.
        unsafe { $instruction }
    };
}

pub(super) use {instruction, memory};

/// An operator as one instruction.
macro_rules! operator {
    ($vector:ident, $trait:ident, $method:ident, $instruction:ident) => {
        impl $trait for $vector {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(instruction!($instruction(self.0, other.0)))
            }
        }
    };
}

operator!(F8, Add, add, _mm256_add_ps);
operator!(F8, Sub, sub, _mm256_sub_ps);
operator!(F8, Mul, mul, _mm256_mul_ps);
operator!(F8, Div, div, _mm256_div_ps);
operator!(F4, Add, add, _mm_add_ps);
operator!(F4, Sub, sub, _mm_sub_ps);
operator!(F4, Mul, mul, _mm_mul_ps);
operator!(U8, Add, add, _mm256_add_epi32);
operator!(U8, BitAnd, bitand, _mm256_and_si256);
operator!(U8, BitOr, bitor, _mm256_or_si256);

impl Neg for F8 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(instruction!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Neg for F4 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(instruction!(_mm_xor_ps(self.0, _mm_set1_ps(-0.0))))
    }
}

impl Float8 for F8 {
    type Word = U8;
    type Half = F4;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(instruction!(_mm256_set1_ps(value)))
    }

    #[inline(always)]
    fn load(from: &[f32; 8]) -> Self {
        Self(memory!(_mm256_loadu_ps(from.as_ptr())))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        memory!(_mm256_storeu_ps(to.as_mut_ptr(), self.0));
    }

    #[inline(always)]
    fn from_u16(from: &[u16; 8]) -> Self {
        let words = memory!(_mm_loadu_si128(from.as_ptr().cast()));
        Self(instruction!(_mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(words))))
    }

    #[inline(always)]
    fn from_u8(from: &[u8; 8]) -> Self {
        let words = memory!(_mm_loadl_epi64(from.as_ptr().cast()));
        Self(instruction!(_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(words))))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(instruction!(_mm256_fmadd_ps(self.0, factor.0, addend.0)))
    }

    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        Self(instruction!(_mm256_fnmadd_ps(self.0, factor.0, addend.0)))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(instruction!(_mm256_sqrt_ps(self.0)))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(instruction!(_mm256_max_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(instruction!(_mm256_min_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(instruction!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }

    #[inline(always)]
    fn sign(self) -> Self {
        Self(instruction!(_mm256_and_ps(self.0, _mm256_set1_ps(-0.0))))
    }

    #[inline(always)]
    fn flipped_by(self, sign: Self) -> Self {
        Self(instruction!(_mm256_xor_ps(self.0, sign.0)))
    }

    #[inline(always)]
    fn less(self, other: Self) -> Self {
        Self(instruction!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)))
    }

    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        Self(instruction!(_mm256_blendv_ps(no.0, yes.0, self.0)))
    }

    #[inline(always)]
    fn picked(self, lanes: &[u32; 8], others: Self) -> Self {
        let lanes = U8::load(lanes);
        let picked = Self(instruction!(_mm256_permutevar8x32_ps(self.0, lanes.0)));
        lanes.as_float().select(picked, others)
    }

    #[inline(always)]
    fn any(self) -> bool {
        instruction!(_mm256_movemask_ps(self.0)) != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        instruction!(_mm256_movemask_ps(self.0)) == 0xFF
    }

    #[inline(always)]
    fn to_bits(self) -> U8 {
        U8(instruction!(_mm256_castps_si256(self.0)))
    }

    #[inline(always)]
    fn twice(from: &[f32; 4]) -> Self {
        let half = F4::load(from);
        Self(instruction!(_mm256_set_m128(half.0, half.0)))
    }

    #[inline(always)]
    fn from_halves(low: &[f32; 4], high: &[f32; 4]) -> Self {
        let (low, high) = (F4::load(low), F4::load(high));
        Self(instruction!(_mm256_set_m128(high.0, low.0)))
    }

    #[inline(always)]
    fn joined(low: F4, high: F4) -> Self {
        Self(instruction!(_mm256_set_m128(high.0, low.0)))
    }

    #[inline(always)]
    fn store_halves(self, low: &mut [f32; 4], high: &mut [f32; 4]) {
        F4(instruction!(_mm256_castps256_ps128(self.0))).store(low);
        F4(instruction!(_mm256_extractf128_ps::<1>(self.0))).store(high);
    }

    #[inline(always)]
    fn low(self) -> F4 {
        F4(instruction!(_mm256_castps256_ps128(self.0)))
    }

    #[inline(always)]
    fn high(self) -> F4 {
        F4(instruction!(_mm256_extractf128_ps::<1>(self.0)))
    }

    #[inline(always)]
    fn spread<const LANE: usize>(self) -> Self {
        Self(instruction!(match LANE {
            0 => _mm256_permute_ps::<0x00>(self.0),
            1 => _mm256_permute_ps::<0x55>(self.0),
            2 => _mm256_permute_ps::<0xAA>(self.0),
            _ => _mm256_permute_ps::<0xFF>(self.0),
        }))
    }

    #[inline(always)]
    fn keep_last(self) -> Self {
        Self(instruction!(_mm256_blend_ps::<0x88>(_mm256_setzero_ps(), self.0)))
    }

    #[inline(always)]
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        let [F8(a), F8(b), F8(c), F8(d)] = rows;
        let (ab_low, ab_high) = instruction!((_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b)));
        let (cd_low, cd_high) = instruction!((_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d)));
        [
            Self(instruction!(_mm256_shuffle_ps::<0x44>(ab_low, cd_low))),
            Self(instruction!(_mm256_shuffle_ps::<0xEE>(ab_low, cd_low))),
            Self(instruction!(_mm256_shuffle_ps::<0x44>(ab_high, cd_high))),
            Self(instruction!(_mm256_shuffle_ps::<0xEE>(ab_high, cd_high))),
        ]
    }

    #[inline(always)]
    fn store_points([F8(x), F8(y), F8(z)]: [Self; 3], to: &mut [f32; 24]) {
        // Of each half: x0 x2 y0 y2, y1 y3 z1 z3, z0 z2 x1 x3.
        let xy = instruction!(_mm256_shuffle_ps::<0x88>(x, y));
        let yz = instruction!(_mm256_shuffle_ps::<0xDD>(y, z));
        let zx = instruction!(_mm256_shuffle_ps::<0xD8>(z, x));
        // x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3.
        let first = Self(instruction!(_mm256_shuffle_ps::<0x88>(xy, zx)));
        let second = Self(instruction!(_mm256_shuffle_ps::<0xD8>(yz, xy)));
        let third = Self(instruction!(_mm256_shuffle_ps::<0xDD>(zx, yz)));
        if let [a, b, c, d, e, f] = to.as_chunks_mut::<4>().0 {
            first.store_halves(a, d);
            second.store_halves(b, e);
            third.store_halves(c, f);
        }
    }
}

impl Float4 for F4 {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(instruction!(_mm_set1_ps(value)))
    }

    #[inline(always)]
    fn load(from: &[f32; 4]) -> Self {
        Self(memory!(_mm_loadu_ps(from.as_ptr())))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; 4]) {
        memory!(_mm_storeu_ps(to.as_mut_ptr(), self.0));
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(instruction!(_mm_fmadd_ps(self.0, factor.0, addend.0)))
    }

    #[inline(always)]
    fn spread<const LANE: usize>(self) -> Self {
        Self(instruction!(match LANE {
            0 => _mm_permute_ps::<0x00>(self.0),
            1 => _mm_permute_ps::<0x55>(self.0),
            2 => _mm_permute_ps::<0xAA>(self.0),
            _ => _mm_permute_ps::<0xFF>(self.0),
        }))
    }

    #[inline(always)]
    fn keep_last(self) -> Self {
        Self(instruction!(_mm_blend_ps::<0x8>(_mm_setzero_ps(), self.0)))
    }

    #[inline(always)]
    fn transpose([F4(a), F4(b), F4(c), F4(d)]: [Self; 4]) -> [Self; 4] {
        let (ab_low, ab_high) = instruction!((_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b)));
        let (cd_low, cd_high) = instruction!((_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d)));
        [
            Self(instruction!(_mm_movelh_ps(ab_low, cd_low))),
            Self(instruction!(_mm_movehl_ps(cd_low, ab_low))),
            Self(instruction!(_mm_movelh_ps(ab_high, cd_high))),
            Self(instruction!(_mm_movehl_ps(cd_high, ab_high))),
        ]
    }
}

impl Word8 for U8 {
    type Float = F8;

    #[inline(always)]
    fn splat(value: u32) -> Self {
        Self(instruction!(_mm256_set1_epi32(value as i32)))
    }

    #[inline(always)]
    fn load(from: &[u32; 8]) -> Self {
        Self(memory!(_mm256_loadu_si256(from.as_ptr().cast())))
    }

    #[inline(always)]
    fn store(self, to: &mut [u32; 8]) {
        memory!(_mm256_storeu_si256(to.as_mut_ptr().cast(), self.0));
    }

    #[inline(always)]
    fn shifted_right(self, count: Self) -> Self {
        Self(instruction!(_mm256_srlv_epi32(self.0, count.0)))
    }

    #[inline(always)]
    fn shifted_left(self, count: Self) -> Self {
        Self(instruction!(_mm256_sllv_epi32(self.0, count.0)))
    }

    #[inline(always)]
    fn gather(bytes: &[u8], offsets: Self) -> Self {
        let Some(last) = bytes.len().checked_sub(4) else { return Self::splat(0) };
        // The instruction reads its offsets as signed numbers.
        let last = Self::splat(last.min(i32::MAX as usize) as u32);
        let offsets = instruction!(_mm256_min_epu32(offsets.0, last.0));
        // SAFETY: as for `instruction`; and no offset is past the last four bytes of the slice.
        Self(unsafe { _mm256_i32gather_epi32::<1>(bytes.as_ptr().cast(), offsets) })
    }

    #[inline(always)]
    fn from_u16(from: &[u16; 8]) -> Self {
        let words = memory!(_mm_loadu_si128(from.as_ptr().cast()));
        Self(instruction!(_mm256_cvtepu16_epi32(words)))
    }

    #[inline(always)]
    fn from_u8(from: &[u8; 8]) -> Self {
        let words = memory!(_mm_loadl_epi64(from.as_ptr().cast()));
        Self(instruction!(_mm256_cvtepu8_epi32(words)))
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        Self(instruction!(_mm256_andnot_si256(other.0, self.0)))
    }

    #[inline(always)]
    fn near(bytes: &[u8], at: usize, second: u8, lanes: &[u8; 8]) -> Self {
        let Some(last) = bytes.len().checked_sub(32) else { return Self::splat(0) };
        let (at, second) = (at.min(last), usize::from(second & 15));
        // SAFETY: as for `instruction`; `at` is not past the last 32 bytes of the slice, so sixteen from there on, and
        // sixteen from up to fifteen later on, are within.
        let halves = unsafe {
            let from = bytes.as_ptr().add(at);
            let low = _mm_loadu_si128(from.cast());
            let high = _mm_loadu_si128(from.add(second).cast());
            _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(low), high)
        };
        // The first byte of each lane four times, and then the next three. An index is relative to its half of the
        // register; without its highest bits it stays below sixteen.
        let first = Self::from_u8(lanes);
        let control = instruction!({
            let four = _mm_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12);
            let first = _mm256_shuffle_epi8(first.0, _mm256_broadcastsi128_si256(four));
            _mm256_add_epi8(first, _mm256_set1_epi32(0x0302_0100))
        });
        Self(instruction!(_mm256_shuffle_epi8(halves, control)))
    }

    #[inline(always)]
    fn to_float(self) -> F8 {
        F8(instruction!(_mm256_cvtepi32_ps(self.0)))
    }

    #[inline(always)]
    fn as_float(self) -> F8 {
        F8(instruction!(_mm256_castsi256_ps(self.0)))
    }
}
