//! The vectors of x86-64 processors with AVX-512: those of AVX2 with 32 registers instead of 16, and registers of sixteen
//! numbers for matrices and crowds.
//!
//! Each use of `unsafe` is one of two:
//!
//! * an instruction of AVX-512. As in [`super::avx2`], the types here can be named by other code only inside
//!   [`Kernel::run`], which is called with them only by [`WideSupport::run`], and a [`WideSupport`] exists only if the
//!   processor has the instructions;
//! * a load or store through a reference to an array of exactly as many bytes as the instruction touches.

use super::avx2::{CpuSupport, F4, F8, U8, instruction, memory};
use super::kernel::{Kernel, Simd};
use super::many::{MOST_LANES, Many, high, low};
use super::pair::RowPair;
use super::rows::Rows;
use super::vector::{Float4, Float8, LANES};
use std::arch::x86_64::*;
use std::ops::{Add, Mul};

/// Proof that the processor has AVX2, FMA, and AVX-512 F, VL, BW and DQ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct WideSupport(());

impl WideSupport {
    /// Detects the features of the processor.
    pub(super) fn detect() -> Option<Self> {
        let has_all = CpuSupport::detect().is_some()
            && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512dq");
        has_all.then_some(Self(()))
    }

    /// Runs `kernel` with these vectors.
    #[inline]
    pub(super) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        // SAFETY: `self` is proof that the processor has all features.
        unsafe { run(kernel) }
    }
}

/// Everything that is inlined into this function is compiled with AVX-512.
#[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512bw,avx512dq")]
fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx512>()
}

/// The set of instructions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx512;

impl Simd for Avx512 {
    const IS_WIDE: bool = true;
    type F8 = F8;
    type F4 = F4;
    type U8 = U8;
    type Rows = OneRegister;
    type Many = F16;
    type Pair = F16;
}

/// Three rows, and four numbers without a meaning.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct OneRegister(__m512);

/// One number of each of sixteen characters, or two rows of eight numbers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F16(__m512);

/// The lanes of the last numbers of the three rows.
const LAST: __mmask16 = 0x0888;
/// The lanes of the three rows.
const ROWS: __mmask16 = 0x0FFF;

/// Loads four numbers into each quarter.
#[inline(always)]
fn four_times(from: &[f32; 4]) -> __m512 {
    memory!(_mm512_broadcast_f32x4(_mm_loadu_ps(from.as_ptr())))
}

impl Rows for OneRegister {
    const IS_ONE_REGISTER: bool = true;
    type Column = F8;
    /// Each number of a column four times; the last column at its place, and zeros elsewhere.
    type Columns = [Self; 4];

    #[inline(always)]
    fn zero() -> Self {
        Self(instruction!(_mm512_setzero_ps()))
    }

    #[inline(always)]
    fn load(from: &[[f32; 4]; 4]) -> Self {
        Self(memory!(_mm512_loadu_ps(from.as_ptr().cast())))
    }

    #[inline(always)]
    fn store(self, to: &mut [[f32; 4]; 4]) {
        memory!(_mm512_storeu_ps(to.as_mut_ptr().cast(), self.0));
    }

    #[inline(always)]
    fn store_packed(self, to: &mut [f32; 12]) {
        // Two stores are faster than one with a mask.
        if let Some(upper) = to.first_chunk_mut() {
            F8(instruction!(_mm512_castps512_ps256(self.0))).store(upper);
        }
        if let Some(lower) = to.last_chunk_mut() {
            F4(instruction!(_mm512_extractf32x4_ps::<2>(self.0))).store(lower);
        }
    }

    #[inline(always)]
    fn columns(self) -> [Self; 4] {
        [
            Self(instruction!(_mm512_permute_ps::<0x00>(self.0))),
            Self(instruction!(_mm512_permute_ps::<0x55>(self.0))),
            Self(instruction!(_mm512_permute_ps::<0xAA>(self.0))),
            Self(instruction!(_mm512_maskz_mov_ps(LAST, self.0))),
        ]
    }

    #[inline(always)]
    fn product([x, y, z, last]: [Self; 4], [a, b, c]: &[[f32; 4]; 3]) -> Self {
        let sum = instruction!(_mm512_fmadd_ps(x.0, four_times(a), last.0));
        let sum = instruction!(_mm512_fmadd_ps(y.0, four_times(b), sum));
        Self(instruction!(_mm512_fmadd_ps(z.0, four_times(c), sum)))
    }

    #[inline(always)]
    fn checked(self, sum: Self) -> Self {
        Self(instruction!(_mm512_fmadd_ps(self.0, _mm512_setzero_ps(), sum.0)))
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        instruction!(_mm512_mask_cmp_ps_mask::<_CMP_UNORD_Q>(ROWS, self.0, self.0)) == 0
    }

    #[inline(always)]
    fn store_eight([upper, middle, lower]: [[F8; 4]; 3], [a, b, c, d, e, f, g, h]: [&mut [[f32; 4]; 4]; 8]) {
        // In each quarter the same number of four matrices: row 0 of the first four and of the others, then row 1.
        let [x, y, z, w] = transposed([
            two(upper[0], middle[0]),
            two(upper[1], middle[1]),
            two(upper[2], middle[2]),
            two(upper[3], middle[3]),
        ]);
        let [p, q, r, s] = F8::transpose(lower);
        store_two(x, p, a, e);
        store_two(y, q, b, f);
        store_two(z, r, c, g);
        store_two(w, s, d, h);
    }

    #[inline(always)]
    fn load_packed(from: &[f32; 12]) -> Self {
        let upper = F8::load(from.first_chunk().unwrap_or(&[0.0; 8]));
        let lower = F4::load(from.last_chunk().unwrap_or(&[0.0; 4]));
        Self(instruction!(_mm512_insertf32x4::<2>(_mm512_castps256_ps512(upper.0), lower.0)))
    }

    #[inline(always)]
    fn scaled(self, factor: f32) -> Self {
        Self(instruction!(_mm512_mul_ps(self.0, _mm512_set1_ps(factor))))
    }

    #[inline(always)]
    fn scaled_add(self, factor: f32, sum: Self) -> Self {
        Self(instruction!(_mm512_fmadd_ps(self.0, _mm512_set1_ps(factor), sum.0)))
    }

    #[inline(always)]
    fn turned([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        let [a, b, c, d] = transposed([a.0, b.0, c.0, d.0]);
        [Self(a), Self(b), Self(c), Self(d)]
    }

    #[inline(always)]
    fn moved([a, b, c, t]: [Self; 4], [x, y, z]: [&[f32; 4]; 3]) -> Self {
        let sum = instruction!(_mm512_fmadd_ps(c.0, four_times(z), t.0));
        let sum = instruction!(_mm512_fmadd_ps(b.0, four_times(y), sum));
        Self(instruction!(_mm512_fmadd_ps(a.0, four_times(x), sum)))
    }

    #[inline(always)]
    fn directed([a, b, c, _]: [Self; 4], [x, y, z]: [&[f32; 4]; 3]) -> Self {
        let sum = instruction!(_mm512_mul_ps(c.0, four_times(z)));
        let sum = instruction!(_mm512_fmadd_ps(b.0, four_times(y), sum));
        Self(instruction!(_mm512_fmadd_ps(a.0, four_times(x), sum)))
    }

    #[inline(always)]
    fn store_points([a, b]: [Self; 2], to: &mut [f32; 24]) {
        let (first, second) = instruction!((
            _mm512_permutex2var_ps(
                a.0,
                _mm512_setr_epi32(0, 4, 8, 1, 5, 9, 2, 6, 10, 3, 7, 11, 16, 20, 24, 17),
                b.0,
            ),
            _mm512_permutexvar_ps(_mm512_setr_epi32(5, 9, 2, 6, 10, 3, 7, 11, 0, 0, 0, 0, 0, 0, 0, 0), b.0),
        ));
        if let Some(to) = to.first_chunk_mut() {
            F16(first).put(to);
        }
        if let Some(to) = to.last_chunk_mut() {
            F8(instruction!(_mm512_castps512_ps256(second))).store(to);
        }
    }

    #[inline(always)]
    fn joined([a, b]: [Self; 2]) -> [F8; 3] {
        let (a, b) = instruction!((_mm512_castps_pd(a.0), _mm512_castps_pd(b.0)));
        let (upper, lower) = instruction!((
            _mm512_castpd_ps(_mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), b)),
            _mm512_castpd_ps(_mm512_permutex2var_pd(a, _mm512_setr_epi64(4, 5, 12, 13, 4, 5, 12, 13), b)),
        ));
        instruction!([
            F8(_mm512_castps512_ps256(upper)),
            F8(_mm512_extractf32x8_ps::<1>(upper)),
            F8(_mm512_castps512_ps256(lower)),
        ])
    }
}

/// Returns a register with two vectors of eight.
#[inline(always)]
fn two(low: F8, high: F8) -> __m512 {
    instruction!(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(low.0), high.0))
}

/// Stores two matrices: `upper` has row 0 of both, then row 1 of both; `lower` has row 2 of both.
#[inline(always)]
fn store_two(upper: __m512, lower: F8, first: &mut [[f32; 4]; 4], second: &mut [[f32; 4]; 4]) {
    let lower = instruction!(_mm512_castps256_ps512(lower.0));
    let (a, b) = instruction!((
        _mm512_permutex2var_pd(
            _mm512_castps_pd(upper),
            _mm512_setr_epi64(0, 1, 4, 5, 8, 9, 8, 9),
            _mm512_castps_pd(lower),
        ),
        _mm512_permutex2var_pd(
            _mm512_castps_pd(upper),
            _mm512_setr_epi64(2, 3, 6, 7, 10, 11, 10, 11),
            _mm512_castps_pd(lower),
        ),
    ));
    OneRegister(instruction!(_mm512_castpd_ps(a))).store(first);
    OneRegister(instruction!(_mm512_castpd_ps(b))).store(second);
}

/// Transposes four rows of four numbers in each quarter.
#[inline(always)]
fn transposed([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
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

impl RowPair for F16 {
    type Row = F8;

    #[inline(always)]
    fn zero() -> Self {
        Self(instruction!(_mm512_setzero_ps()))
    }

    #[inline(always)]
    fn from_rows(first: &[f32; LANES], second: &[f32; LANES]) -> Self {
        Self(two(F8::load(first), F8::load(second)))
    }

    #[inline(always)]
    fn store_rows(self, first: &mut [f32; LANES], second: &mut [f32; LANES]) {
        F8(instruction!(_mm512_castps512_ps256(self.0))).store(first);
        F8(instruction!(_mm512_extractf32x8_ps::<1>(self.0))).store(second);
    }

    #[inline(always)]
    fn both(row: F8) -> Self {
        Self(two(row, row))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(instruction!(_mm512_fmadd_ps(self.0, factor.0, addend.0)))
    }

    #[inline(always)]
    fn sum(self) -> F8 {
        F8(instruction!(_mm512_castps512_ps256(self.0)))
            + F8(instruction!(_mm512_extractf32x8_ps::<1>(self.0)))
    }

    #[inline(always)]
    fn chosen(mask: F8, yes: Self, no: Self) -> Self {
        let lanes = instruction!(_mm256_movepi32_mask(_mm256_castps_si256(mask.0)));
        let both = u16::from(lanes) * 0x0101;
        Self(instruction!(_mm512_mask_blend_ps(both, no.0, yes.0)))
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
    fn all(value: f32) -> Self {
        Self(instruction!(_mm512_set1_ps(value)))
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
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Self(instruction!(_mm512_fmadd_ps(self.0, factor.0, addend.0)))
    }

    #[inline(always)]
    fn times_from(self, factor: Self, minuend: Self) -> Self {
        Self(instruction!(_mm512_fnmadd_ps(self.0, factor.0, minuend.0)))
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
