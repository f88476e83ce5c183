//! Sets of instructions, and work that can be done with any of them.

use super::many::Many;
use super::pair::RowPair;
use super::rows::Rows;
use super::vector::{Float4, Float8, Word8};
use std::fmt::Debug;

/// The vectors of one set of instructions.
pub trait Simd: Copy + Debug + 'static {
    /// Whether eight numbers fit in one register.
    const IS_WIDE: bool;
    /// Eight numbers.
    type F8: Float8<Word = Self::U8, Half = Self::F4>;
    /// Four numbers.
    type F4: Float4;
    /// Eight words of 32 bits.
    type U8: Word8<Float = Self::F8>;
    /// A matrix of three rows.
    type Rows: Rows<Column = Self::F8>;
    /// The numbers of the widest register.
    type Many: Many;
    /// Two rows of eight numbers.
    type Pair: RowPair<Row = Self::F8>;

    /// Runs a part of a kernel as a function of its own, with these vectors. For what several kernels share: inlined into each, it
    /// would be compiled again for each. A call costs some nanoseconds.
    fn call<K: Kernel>(part: K) -> K::Output;
}

/// Work written for any set of instructions.
///
/// Mark `run`, and every function that it calls with vectors, `#[inline(always)]`: only code that becomes part of the
/// function that [`super::SimdLevel::run`] compiles for a level uses that level's instructions. Closures cannot be marked, so
/// no vector may pass through one, nor through `map` and iterators over vectors: each operation in them would be a
/// call, several times slower. Iterators over memory are fine.
pub trait Kernel {
    /// Result of the work.
    type Output;

    /// Runs the kernel with the vectors of `S`.
    fn run<S: Simd>(self) -> Self::Output;
}
