//! The registers of AVX-512: sixteen numbers, or two rows of eight.
//!
//! Each use of `unsafe` is one of three:
//!
//! * an instruction of AVX-512, as in [`super::avx512`];
//! * a load or store through a reference to an array of the bytes that the instruction touches;
//! * [`RowPair::near`], which keeps its offsets within the slice.

use super::arithmetic::Arithmetic;
use super::avx2::{F4, F8, instruction, memory};
use super::many::{MOST_LANES, Many, high, low};
use super::pair::RowPair;
use super::vector::{Float4, Float8, LANES};
use std::arch::x86_64::*;
use std::ops::{Add, Mul};

/// One number of each of sixteen characters, or two rows of eight numbers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F16(pub(super) __m512);

/// Two rows of eight words.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct U16(__m512i);

/// Returns a register with two vectors of eight.
#[inline(always)]
pub(super) fn two(low: F8, high: F8) -> __m512 {
    instruction!(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(low.0), high.0))
}

/// Transposes four rows of four numbers in each quarter.
#[inline(always)]
pub(super) fn transposed([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
    let (ab_low, ab_high) = instruction!((_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b)));
    let (cd_low, cd_high) = instruction!((_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d)));
    [
        instruction!(_mm512_shuffle_ps::<0x44>(ab_low, cd_low)),
        instruction!(_mm512_shuffle_ps::<0xEE>(ab_low, cd_low)),
        instruction!(_mm512_shuffle_ps::<0x44>(ab_high, cd_high)),
        instruction!(_mm512_shuffle_ps::<0xEE>(ab_high, cd_high)),
    ]
}

impl Add for F16 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(instruction!(_mm512_add_ps(self.0, other.0)))
    }
}

impl Mul for F16 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(instruction!(_mm512_mul_ps(self.0, other.0)))
    }
}

impl Arithmetic for F16 {
    #[inline(always)]
    fn all(value: f32) -> Self {
        Self(instruction!(_mm512_set1_ps(value)))
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Self(instruction!(_mm512_fmadd_ps(self.0, factor.0, addend.0)))
    }

    #[inline(always)]
    fn times_from(self, factor: Self, minuend: Self) -> Self {
        Self(instruction!(_mm512_fnmadd_ps(self.0, factor.0, minuend.0)))
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(instruction!(_mm512_sqrt_ps(self.0)))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(instruction!(_mm512_max_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn any_less(self, other: Self) -> bool {
        instruction!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)) != 0
    }
}

impl RowPair for F16 {
    type Row = F8;
    type Words = U16;

    #[inline(always)]
    fn from_rows(first: &[f32; LANES], second: &[f32; LANES]) -> Self {
        Self(two(F8::load(first), F8::load(second)))
    }

    #[inline(always)]
    fn load(rows: &[[f32; LANES]; 2]) -> Self {
        Self(memory!(_mm512_loadu_ps(rows.as_ptr().cast())))
    }

    #[inline(always)]
    fn from_high_bits(rows: &[[u16; LANES]; 2]) -> Self {
        let words = memory!(_mm256_loadu_si256(rows.as_ptr().cast()));
        Self(instruction!(_mm512_castsi512_ps(_mm512_slli_epi32::<16>(_mm512_cvtepu16_epi32(words)))))
    }

    #[inline(always)]
    fn store_rows(self, first: &mut [f32; LANES], second: &mut [f32; LANES]) {
        let [low, high] = self.rows();
        low.store(first);
        high.store(second);
    }

    #[inline(always)]
    fn of([first, second]: [F8; 2]) -> Self {
        Self(two(first, second))
    }

    #[inline(always)]
    fn rows(self) -> [F8; 2] {
        instruction!([F8(_mm512_castps512_ps256(self.0)), F8(_mm512_extractf32x8_ps::<1>(self.0))])
    }

    #[inline(always)]
    fn chosen(mask: F8, yes: Self, no: Self) -> Self {
        let lanes = instruction!(_mm256_movepi32_mask(_mm256_castps_si256(mask.0)));
        let both = u16::from(lanes) * 0x0101;
        Self(instruction!(_mm512_mask_blend_ps(both, no.0, yes.0)))
    }

    #[inline(always)]
    fn near(bytes: &[u8], at: [usize; 2], second: [u8; 2], lanes: &[[u8; LANES]; 2]) -> U16 {
        let Some(last) = bytes.len().checked_sub(32) else {
            return U16(instruction!(_mm512_setzero_si512()));
        };
        let [a, b] = [at[0].min(last), at[1].min(last)];
        let [c, d] = [usize::from(second[0] & 15), usize::from(second[1] & 15)];
        // SAFETY: as for `instruction`; neither position is past the last 32 bytes of the slice, so sixteen bytes from
        // there on, and sixteen from up to fifteen later on, are within.
        let quarters = unsafe {
            let [first, second] = [bytes.as_ptr().add(a), bytes.as_ptr().add(b)];
            let first = _mm256_loadu2_m128i(first.add(c).cast(), first.cast());
            let second = _mm256_loadu2_m128i(second.add(d).cast(), second.cast());
            _mm512_inserti64x4::<1>(_mm512_castsi256_si512(first), second)
        };
        let lanes = memory!(_mm_loadu_si128(lanes.as_ptr().cast()));
        // The first byte of each lane four times, and then the next three. An index is relative to its quarter of the
        // register; without its highest bits it stays below sixteen.
        let control = instruction!({
            let four = _mm_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12);
            let first = _mm512_shuffle_epi8(_mm512_cvtepu8_epi32(lanes), _mm512_broadcast_i32x4(four));
            _mm512_add_epi8(first, _mm512_set1_epi32(0x0302_0100))
        });
        U16(instruction!(_mm512_shuffle_epi8(quarters, control)))
    }

    #[inline(always)]
    fn masked(words: U16, masks: &[[u32; LANES]; 2]) -> Self {
        let masks = memory!(_mm512_loadu_si512(masks.as_ptr().cast()));
        Self(instruction!(_mm512_cvtepi32_ps(_mm512_and_si512(words.0, masks))))
    }
}

impl Many for F16 {
    type Numbers = [f32; MOST_LANES];
    const COUNT: usize = MOST_LANES;

    const ZEROS: Self::Numbers = [0.0; MOST_LANES];

    #[inline(always)]
    fn numbers_of(memory: &mut [f32]) -> &mut [[f32; MOST_LANES]] {
        memory.as_chunks_mut().0
    }

    #[inline(always)]
    fn get(from: &[f32; MOST_LANES]) -> Self {
        Self(memory!(_mm512_loadu_ps(from.as_ptr())))
    }

    #[inline(always)]
    fn put(self, to: &mut [f32; MOST_LANES]) {
        memory!(_mm512_storeu_ps(to.as_mut_ptr(), self.0));
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        instruction!(_mm512_cmp_ps_mask::<_CMP_UNORD_Q>(self.0, self.0)) == 0
    }

    #[inline(always)]
    fn turn(rows: &[&[f32; LANES]; MOST_LANES], to: &mut [[f32; MOST_LANES]; LANES]) {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = rows;
        let first = transposed([
            quarters([low(a), low(e), low(i), low(m)]),
            quarters([low(b), low(f), low(j), low(n)]),
            quarters([low(c), low(g), low(k), low(o)]),
            quarters([low(d), low(h), low(l), low(p)]),
        ]);
        let last = transposed([
            quarters([high(a), high(e), high(i), high(m)]),
            quarters([high(b), high(f), high(j), high(n)]),
            quarters([high(c), high(g), high(k), high(o)]),
            quarters([high(d), high(h), high(l), high(p)]),
        ]);
        let [q, r, s, t, u, v, w, x] = to;
        Self(first[0]).put(q);
        Self(first[1]).put(r);
        Self(first[2]).put(s);
        Self(first[3]).put(t);
        Self(last[0]).put(u);
        Self(last[1]).put(v);
        Self(last[2]).put(w);
        Self(last[3]).put(x);
    }

    #[inline(always)]
    fn store_matrices(columns: &[[Self; 4]; 3], to: &mut [[f32; 12]], at: usize, stride: usize) -> bool {
        let Some(matrices) = super::apart::apart::<_, MOST_LANES>(to, at, stride) else { return false };
        let [upper, middle, lower] = columns;
        let upper = transposed([upper[0].0, upper[1].0, upper[2].0, upper[3].0]);
        let middle = transposed([middle[0].0, middle[1].0, middle[2].0, middle[3].0]);
        let lower = transposed([lower[0].0, lower[1].0, lower[2].0, lower[3].0]);
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = matrices;
        store_four([upper[0], middle[0], lower[0]], [a, e, i, m]);
        store_four([upper[1], middle[1], lower[1]], [b, f, j, n]);
        store_four([upper[2], middle[2], lower[2]], [c, g, k, o]);
        store_four([upper[3], middle[3], lower[3]], [d, h, l, p]);
        true
    }
}

/// Loads four numbers into each quarter, each from its own place.
#[inline(always)]
fn quarters([a, b, c, d]: [&[f32; 4]; 4]) -> __m512 {
    let [F4(a), F4(b), F4(c), F4(d)] = [F4::load(a), F4::load(b), F4::load(c), F4::load(d)];
    let two = instruction!(_mm512_insertf32x4::<1>(_mm512_castps128_ps512(a), b));
    let three = instruction!(_mm512_insertf32x4::<2>(two, c));
    instruction!(_mm512_insertf32x4::<3>(three, d))
}

/// Stores four matrices; `rows[r]` has row `r` of each.
#[inline(always)]
fn store_four(rows: [__m512; 3], [a, b, c, d]: [&mut [f32; 12]; 4]) {
    let [x, y, z] = rows;
    store_quarters(
        x,
        [
            super::many::row::<0>(a),
            super::many::row::<0>(b),
            super::many::row::<0>(c),
            super::many::row::<0>(d),
        ],
    );
    store_quarters(
        y,
        [
            super::many::row::<1>(a),
            super::many::row::<1>(b),
            super::many::row::<1>(c),
            super::many::row::<1>(d),
        ],
    );
    store_quarters(
        z,
        [
            super::many::row::<2>(a),
            super::many::row::<2>(b),
            super::many::row::<2>(c),
            super::many::row::<2>(d),
        ],
    );
}

/// Stores each quarter to its own place.
#[inline(always)]
fn store_quarters(four: __m512, [a, b, c, d]: [&mut [f32; 4]; 4]) {
    F4(instruction!(_mm512_castps512_ps128(four))).store(a);
    F4(instruction!(_mm512_extractf32x4_ps::<1>(four))).store(b);
    F4(instruction!(_mm512_extractf32x4_ps::<2>(four))).store(c);
    F4(instruction!(_mm512_extractf32x4_ps::<3>(four))).store(d);
}
