//! How often a piece of code allocates, counted for the thread that runs it.
//!
//! A test binary installs the allocator once:
//!
//! ```
//! #[global_allocator]
//! static ALLOCATOR: crate::counting::CountingAllocator = crate::counting::CountingAllocator;
//! let (count, _) = crate::counting::count(|| Box::new(1));
//! assert_eq!(count.allocations, 1);
//! ```

// A global allocator cannot be written without it; nothing else in this crate may use it.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicI64, Ordering};

/// What a thread asked of the allocator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Calls that asked for memory: new blocks and blocks that had to grow or shrink.
    pub allocations: u64,
    /// Bytes asked for in them.
    pub bytes: u64,
}

thread_local! {
    // Constant and without a destructor, so that reading it never allocates.
    static COUNT: Cell<Count> = const { Cell::new(Count { allocations: 0, bytes: 0 }) };
    /// Bytes held now and at most, by what this thread took and gave back.
    static HELD: Cell<(i64, i64)> = const { Cell::new((0, 0)) };
    /// Of that, what is not yet counted for the process.
    static UNCOUNTED: Cell<i64> = const { Cell::new(0) };
}

/// A thread adds what it took and gave back to the process's count in steps of so many bytes: so the threads do not meet at
/// one number in every call, and the count is right but for this much a thread.
const STEP: i64 = 1 << 16;

/// Bytes that the process holds now, and at most.
static PROCESS: [AtomicI64; 2] = [AtomicI64::new(0), AtomicI64::new(0)];

/// What the calling thread has asked for so far; zero unless [`CountingAllocator`] is the global allocator.
pub fn so_far() -> Count {
    COUNT.get()
}

/// Runs `work` and tells what it asked of the allocator on this thread.
pub fn count<T>(work: impl FnOnce() -> T) -> (Count, T) {
    let before = so_far();
    let result = work();
    let after = so_far();
    let count =
        Count { allocations: after.allocations - before.allocations, bytes: after.bytes - before.bytes };
    (count, result)
}

/// Runs `work` and tells how many bytes more than before it held at most, taken and not given back by this thread.
pub fn peak<T>(work: impl FnOnce() -> T) -> (u64, T) {
    let (before, outer) = HELD.get();
    HELD.set((before, before));
    let result = work();
    let (now, most) = HELD.get();
    HELD.set((now, most.max(outer)));
    ((most - before).max(0) as u64, result)
}

/// Runs `work` and tells how many bytes more than before the process held at most, all its threads together; right but for
/// 64 KiB a thread. One at a time.
pub fn process_peak<T>(work: impl FnOnce() -> T) -> (u64, T) {
    let [held, most] = &PROCESS;
    let before = held.load(Ordering::Relaxed);
    most.store(before, Ordering::Relaxed);
    let result = work();
    ((most.load(Ordering::Relaxed) - before).max(0) as u64, result)
}

/// The system's allocator, which counts per thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct CountingAllocator;

/// Adds one call to the count of this thread.
fn note(bytes: usize) {
    // Fails only while the thread ends; those calls are of no interest.
    let _ = COUNT.try_with(|cell| {
        let count = cell.get();
        cell.set(Count { allocations: count.allocations + 1, bytes: count.bytes + bytes as u64 });
    });
}

/// Adds to the bytes that this thread holds.
fn hold(bytes: i64) {
    let _ = HELD.try_with(|cell| {
        let (held, most) = cell.get();
        cell.set((held + bytes, most.max(held + bytes)));
    });
    let _ = UNCOUNTED.try_with(|cell| {
        let bytes = cell.get() + bytes;
        let counted = bytes.abs() >= STEP;
        cell.set(if counted { 0 } else { bytes });
        if counted {
            let [held, most] = &PROCESS;
            let now = held.fetch_add(bytes, Ordering::Relaxed) + bytes;
            most.fetch_max(now, Ordering::Relaxed);
        }
    });
}

// SAFETY: every method hands its arguments on to `System` unchanged and returns what `System` returned, so the contract
// of `GlobalAlloc` is kept because `System` keeps it; `note` and `hold` neither allocate nor unwind.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        hold(layout.size() as i64);
        // SAFETY: the caller keeps the contract of `alloc`, which is that of `System.alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        hold(layout.size() as i64);
        // SAFETY: as for `alloc`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note(size);
        // A block that grows may be copied: for a moment there are two.
        hold(size as i64);
        hold(-(layout.size() as i64));
        // SAFETY: `block` came from this allocator, hence from `System`, with this `layout`.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        hold(-(layout.size() as i64));
        // SAFETY: `block` came from this allocator, hence from `System`, with this `layout`.
        unsafe { System.dealloc(block, layout) }
    }
}
