//! Settings of an import: memory budget, cancel flag, progress listener, conventions.

use super::Conventions;
use crate::limits::{MEMORY_BASE, MEMORY_MAX, MEMORY_PER_BYTE};
use std::cell::Cell;

/// Settings of an import. The default has the usual limits, no way to cancel and no progress listener.
pub struct ReadOptions<'a> {
    /// Memory budget, charged before each large allocation.
    pub budget: ByteBudget,
    /// Cancel flag, polled at least every few milliseconds of work; `true` ends the import with
    /// [`super::ImportError::Cancelled`].
    pub is_cancelled: &'a dyn Fn() -> bool,
    /// Progress listener, called with a fraction 0..1 that never decreases.
    pub progress: &'a dyn Fn(f32),
    /// Units, axes and frame rate that the user chose.
    pub conventions: Conventions,
}

impl Default for ReadOptions<'_> {
    fn default() -> Self {
        Self {
            budget: ByteBudget::default(),
            is_cancelled: &|| false,
            progress: &|_| (),
            conventions: Conventions::default(),
        }
    }
}

/// Memory budget of an import. Memory is charged before it is allocated, so that a small file cannot exhaust the memory
/// of the machine.
///
/// The limit starts at [`MEMORY_BASE`] and grows by [`MEMORY_PER_BYTE`] for each byte of input, up to [`MEMORY_MAX`].
/// Charged bytes are never released: the budget bounds work as well as memory.
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

/// A charge that a [`ByteBudget`] refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverBudget {
    /// Total number of bytes needed, this charge included.
    pub needed: u64,
    /// Total number of bytes granted.
    pub limit: u64,
}

impl ByteBudget {
    /// Returns a budget of at most `bytes`, however large the file is.
    pub fn at_most(bytes: u64) -> Self {
        Self { limit: Cell::new(bytes.min(MEMORY_BASE)), max: bytes, ..Self::default() }
    }

    /// Returns a budget that refuses only the charge number `request`, counted from zero, for tests of every failure
    /// path.
    pub fn failing_at(request: u64) -> Self {
        Self { fail_at: request, ..Self::default() }
    }

    /// Raises the limit after `bytes` of input were read.
    pub fn input(&self, bytes: usize) {
        let more = (bytes as u64).saturating_mul(MEMORY_PER_BYTE);
        self.limit.set(self.limit.get().saturating_add(more).min(self.max));
    }

    /// Charges `bytes`. The error contains the total that would have been needed.
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

    /// Returns the number of bytes that can still be charged.
    pub fn remaining(&self) -> u64 {
        self.limit.get() - self.used.get()
    }

    /// Returns the number of bytes charged so far.
    pub fn used(&self) -> u64 {
        self.used.get()
    }

    /// Returns how many times [`Self::charge`] was called.
    pub fn requests(&self) -> u64 {
        self.requests.get()
    }
}
