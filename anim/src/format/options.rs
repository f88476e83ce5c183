//! What a caller may set about reading: how much memory, when to stop, whom to tell.

use crate::limits::{MEMORY_BASE, MEMORY_MAX, MEMORY_PER_BYTE};
use std::cell::Cell;

/// How to read. The default reads with the usual limits, cannot be cancelled and tells nobody.
pub struct ReadOptions<'a> {
    /// Charged before each large allocation.
    pub budget: ByteBudget,
    /// Asked at least every few milliseconds of work; `true` ends reading with [`super::ImportError::Cancelled`].
    pub is_cancelled: &'a dyn Fn() -> bool,
    /// Told how far reading is, 0..1, never falling.
    pub progress: &'a dyn Fn(f32),
}

impl Default for ReadOptions<'_> {
    fn default() -> Self {
        Self { budget: ByteBudget::default(), is_cancelled: &|| false, progress: &|_| () }
    }
}

/// Memory that reading may use: asked before it is taken, so that a small file cannot make a large machine small.
///
/// Starts at [`MEMORY_BASE`] and grows by [`MEMORY_PER_BYTE`] for each byte read, up to [`MEMORY_MAX`]. What was
/// charged stays charged: the budget bounds work as well as memory.
#[derive(Clone, Debug)]
pub struct ByteBudget {
    limit: Cell<u64>,
    max: u64,
    used: Cell<u64>,
    requests: Cell<u64>,
    fail_at: u64,
}

impl Default for ByteBudget {
    fn default() -> Self {
        Self {
            limit: Cell::new(MEMORY_BASE),
            max: MEMORY_MAX,
            used: Cell::new(0),
            requests: Cell::new(0),
            fail_at: u64::MAX,
        }
    }
}

/// A budget that does not stretch so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverBudget {
    /// Bytes needed in all.
    pub needed: u64,
    /// Bytes granted in all.
    pub limit: u64,
}

impl ByteBudget {
    /// At most `bytes`, however large the file is.
    pub fn at_most(bytes: u64) -> Self {
        Self { limit: Cell::new(bytes.min(MEMORY_BASE)), max: bytes, ..Self::default() }
    }

    /// Refuses the `request`-th charge, counted from zero, and grants the others: for tests of every way to fail.
    pub fn failing_at(request: u64) -> Self {
        Self { fail_at: request, ..Self::default() }
    }

    /// Grants more because `bytes` of input were read.
    pub fn input(&self, bytes: usize) {
        let more = (bytes as u64).saturating_mul(MEMORY_PER_BYTE);
        self.limit.set(self.limit.get().saturating_add(more).min(self.max));
    }

    /// Takes `bytes`, or says by how much they are too many.
    pub fn charge(&self, bytes: u64) -> Result<(), OverBudget> {
        let request = self.requests.get();
        self.requests.set(request + 1);
        let needed = self.used.get().saturating_add(bytes);
        if needed > self.limit.get() || request == self.fail_at {
            return Err(OverBudget { needed, limit: self.limit.get() });
        }
        self.used.set(needed);
        Ok(())
    }

    /// Bytes not yet taken.
    pub fn remaining(&self) -> u64 {
        self.limit.get() - self.used.get()
    }

    /// Bytes taken so far.
    pub fn used(&self) -> u64 {
        self.used.get()
    }

    /// How often [`Self::charge`] was called.
    pub fn requests(&self) -> u64 {
        self.requests.get()
    }
}
