//! Vectors of eight numbers, with which the kernels of the fast path are written.
//!
//! A kernel is written once, generic over [`Simd`], and run by a [`SimdLevel`]: a set of instructions of the current
//! machine. [`SimdLevel::best`] queries the processor; store its result together with the kernel's data, so that it is
//! called only once.
//!
//! ```
//! use dragonfly_anim::fast::simd::{Float8, Kernel, Simd, SimdLevel};
//!
//! /// Adds to each number the square of its neighbor in `other`.
//! struct AddSquares<'a>(&'a mut [[f32; 8]], &'a [[f32; 8]]);
//!
//! impl Kernel for AddSquares<'_> {
//!     type Output = ();
//!
//!     #[inline(always)]
//!     fn run<S: Simd>(self) {
//!         for (out, other) in self.0.iter_mut().zip(self.1) {
//!             let other = S::F8::load(other);
//!             other.mul_add(other, S::F8::load(out)).store(out);
//!         }
//!     }
//! }
//!
//! let mut numbers = [[1.0; 8]];
//! SimdLevel::best().run(AddSquares(&mut numbers, &[[3.0; 8]]));
//! assert_eq!(numbers, [[10.0; 8]]);
//! ```
//!
//! # Levels
//!
//! | level | available | a vector of eight is |
//! |---|---|---|
//! | `avx512` | x86-64 with AVX-512 (F, VL, BW, DQ) | half a register: matrices, pairs of rows or blocks and crowds use all of it |
//! | `avx2` | x86-64 with AVX2 and FMA | one register |
//! | `portable` | everywhere | an array, in loops that compilers vectorize for the target |
//!
//! Results are the same, bit for bit, each time the same build runs at the same level; no approximate instruction
//! (reciprocal, reciprocal root) is used, so that is true across processors too. Levels differ in the last bits,
//! because a fused multiply-add rounds once and not twice.
//!
//! # Safety
//!
//! The only files of the crate with `unsafe` code are `avx2.rs`, `avx512.rs` and `sixteen.rs`, called through the safe
//! traits of this module, and `apart.rs`, a function. The types of the first three cannot be named outside; a kernel is
//! only given them inside [`SimdLevel::run`], after the processor's features were detected.

#[allow(unsafe_code, reason = "one check in place of one for each of sixteen items")]
mod apart;
mod arithmetic;
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "instructions beyond the target's own can be had in no other way")]
mod avx2;
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "as for avx2")]
mod avx512;
mod kernel;
mod many;
mod pair;
mod portable;
mod rows;
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "as for avx2")]
mod sixteen;
mod vector;

pub use arithmetic::Arithmetic;
pub use kernel::{Kernel, Simd};
pub use many::{MOST_LANES, Many};
pub(super) use many::{high, low};
pub use pair::{RowPair, TwoRows};
pub use portable::Portable;
pub use rows::{Rows, TwoVectors};
pub use vector::{Float4, Float8, LANES, Word8};

/// A set of instructions of the current machine (AVX-512, AVX2, or the portable fallback).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[doc(alias("AVX2", "AVX-512", "instruction set"))]
pub struct SimdLevel(Instructions);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Instructions {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::CpuSupport),
    #[cfg(target_arch = "x86_64")]
    Avx512(avx512::WideSupport),
}

impl SimdLevel {
    /// The level that every machine has.
    pub const PORTABLE: Self = Self(Instructions::Portable);

    /// Returns the fastest level of this machine. Cheap, but call it once, at set-up.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(support) = avx512::WideSupport::detect() {
            return Self(Instructions::Avx512(support));
        }
        Self::avx2().unwrap_or(Self::PORTABLE)
    }

    /// Returns the level with vectors of eight and no wider ones, if the machine has it.
    fn avx2() -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        if let Some(support) = avx2::CpuSupport::detect() {
            return Some(Self(Instructions::Avx2(support)));
        }
        None
    }

    /// Returns every level of this machine, the fastest first; the last is [`Self::PORTABLE`].
    pub fn all() -> Vec<Self> {
        let mut levels: Vec<Self> =
            [Some(Self::best()), Self::avx2(), Some(Self::PORTABLE)].into_iter().flatten().collect();
        levels.dedup();
        levels
    }

    /// Returns the name of the level, as in the table of the [module](self).
    pub fn name(self) -> &'static str {
        match self.0 {
            Instructions::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(_) => "avx512",
        }
    }

    /// Runs `kernel` with this level's instructions.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Instructions::Portable => portable::run(kernel),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(support) => support.run(kernel),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512(support) => support.run(kernel),
        }
    }
}

impl Default for SimdLevel {
    fn default() -> Self {
        Self::best()
    }
}
