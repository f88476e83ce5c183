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
use super::many::Many;
use super::rows::Rows;
use super::sixteen::{F16, transposed, two};
use super::vector::{Float4, Float8};
use std::arch::x86_64::*;

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

    #[inline(always)]
    fn call<K: Kernel>(part: K) -> K::Output {
        // SAFETY: only a kernel that runs with these instructions can name this type, see the top of the file.
        unsafe { run(part) }
    }
}

/// Three rows, and four numbers without a meaning.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct OneRegister(__m512);

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
