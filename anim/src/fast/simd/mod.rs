//! Eight numbers at once: the vectors that the kernels of the fast path are written with.
//!
//! A kernel is written once, generic over [`Simd`], and run by a [`Level`]: the set of instructions that this
//! machine was found to have. [`Level::best`] asks the processor; keep what it answers where the kernel's data is
//! kept, and nothing is asked again.
//!
//! ```
//! use dragonfly_anim::fast::simd::{Float8, Kernel, Level, Simd};
//!
//! /// Adds to each number the square of its neighbour in `other`.
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
//! Level::best().run(AddSquares(&mut numbers, &[[3.0; 8]]));
//! assert_eq!(numbers, [[10.0; 8]]);
//! ```
//!
//! # Levels
//!
//! | level | where | a vector of eight is |
//! |---|---|---|
//! | `avx2` | x86-64 with AVX2 and FMA | one register |
//! | `portable` | everywhere | an array, in loops that compilers turn into what the target has |
//!
//! Results are the same, bit for bit, each time the same build runs at the same level; no approximate instruction
//! (reciprocal, reciprocal root) is used, so that holds across processors too. Levels differ in the last bits,
//! because a fused multiplication rounds once and not twice.
//!
//! # Safety
//!
//! The one file of the crate that holds `unsafe` code is `avx2.rs`, behind the safe traits of this one. Its types
//! cannot be named outside; a kernel meets them only inside [`Level::run`], after the processor was asked.

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "instructions beyond the target's own can be had in no other way")]
mod avx2;
mod portable;
mod vector;

pub use portable::Portable;
pub use vector::{Float4, Float8, Simd, Word8};

/// Lanes of the wide vectors.
pub const LANES: usize = 8;

/// Work written for any set of instructions.
///
/// Mark `run`, and every function that it calls with vectors, `#[inline(always)]`: only what becomes part of the
/// function that [`Level::run`] compiles for a level is compiled with that level's instructions. Closures cannot be
/// marked, so no vector may pass through one, nor through `map` and iterators over vectors: each operation in them
/// would be a call, several times slower. Iterators over memory are fine.
pub trait Kernel {
    /// What the work results in.
    type Output;

    /// Does the work with the vectors of `S`.
    fn run<S: Simd>(self) -> Self::Output;
}

/// A set of instructions that this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Kind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::Present),
}

impl Level {
    /// What every machine has.
    pub const PORTABLE: Self = Self(Kind::Portable);

    /// The fastest level of this machine. Cheap, but ask once, at set-up.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(present) = avx2::Present::detect() {
            return Self(Kind::Avx2(present));
        }
        Self::PORTABLE
    }

    /// Every level of this machine, the fastest first; the last is [`Self::PORTABLE`].
    pub fn all() -> Vec<Self> {
        let mut levels = vec![Self::best(), Self::PORTABLE];
        levels.dedup();
        levels
    }

    /// As the table in [`self`] has it.
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(_) => "avx2",
        }
    }

    /// Does the work of `kernel` with this level's instructions.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Kind::Portable => portable::run(kernel),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(present) => present.run(kernel),
        }
    }
}

impl Default for Level {
    fn default() -> Self {
        Self::best()
    }
}
