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
//! | `avx2` | x86-64 with AVX2 and FMA | one register |
//! | `portable` | everywhere | an array, in loops that compilers vectorize for the target |
//!
//! Results are the same, bit for bit, each time the same build runs at the same level; no approximate instruction
//! (reciprocal, reciprocal root) is used, so that is true across processors too. Levels differ in the last bits,
//! because a fused multiply-add rounds once and not twice.
//!
//! # Safety
//!
//! The only file of the crate with `unsafe` code is `avx2.rs`, called through the safe traits of this module. Its types
//! cannot be named outside; a kernel is only given them inside [`SimdLevel::run`], after the processor's features were
//! detected.

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "instructions beyond the target's own can be had in no other way")]
mod avx2;
mod portable;
mod vector;

pub use portable::Portable;
pub use vector::{Float4, Float8, Simd, Word8};

/// Number of lanes of the wide vectors.
pub const LANES: usize = 8;

/// Work written for any set of instructions.
///
/// Mark `run`, and every function that it calls with vectors, `#[inline(always)]`: only code that becomes part of the
/// function that [`SimdLevel::run`] compiles for a level uses that level's instructions. Closures cannot be marked, so
/// no vector may pass through one, nor through `map` and iterators over vectors: each operation in them would be a
/// call, several times slower. Iterators over memory are fine.
pub trait Kernel {
    /// Result of the work.
    type Output;

    /// Runs the kernel with the vectors of `S`.
    fn run<S: Simd>(self) -> Self::Output;
}

/// A set of instructions of the current machine (AVX2, or the portable fallback).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[doc(alias("AVX2", "instruction set"))]
pub struct SimdLevel(Instructions);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Instructions {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::CpuSupport),
}

impl SimdLevel {
    /// The level that every machine has.
    pub const PORTABLE: Self = Self(Instructions::Portable);

    /// Returns the fastest level of this machine. Cheap, but call it once, at set-up.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(support) = avx2::CpuSupport::detect() {
            return Self(Instructions::Avx2(support));
        }
        Self::PORTABLE
    }

    /// Returns every level of this machine, the fastest first; the last is [`Self::PORTABLE`].
    pub fn all() -> Vec<Self> {
        let mut levels = vec![Self::best(), Self::PORTABLE];
        levels.dedup();
        levels
    }

    /// Returns the name of the level, as in the table of the [module](self).
    pub fn name(self) -> &'static str {
        match self.0 {
            Instructions::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(_) => "avx2",
        }
    }

    /// Runs `kernel` with this level's instructions.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Instructions::Portable => portable::run(kernel),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(support) => support.run(kernel),
        }
    }
}

impl Default for SimdLevel {
    fn default() -> Self {
        Self::best()
    }
}
