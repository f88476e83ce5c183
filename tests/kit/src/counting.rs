//! Counts the allocations of a piece of code in the thread that runs it.
//!
//! A test binary installs the allocator once:
//!
//! ```
//! #[global_allocator]
//! static ALLOCATOR: crate::counting::CountingAllocator = crate::counting::CountingAllocator;
//! let (count, _) = crate::counting::count(|| Box::new(1));
//! assert_eq!(count.allocations, 1);
//! ```

// A global allocator is an unsafe trait; nothing else in this crate may be unsafe.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicI64, Ordering};

/// Number and size of allocations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Number of calls that requested memory: new blocks and blocks that grew or shrank.
    pub allocations: u64,
    /// Number of bytes requested in these calls.
    pub bytes: u64,
}

thread_local! {
    // Constant and without a destructor, so that reading it never allocates.
    static COUNT: Cell<Count> = const { Cell::new(Count { allocations: 0, bytes: 0 }) };
    /// Bytes in use now and at the peak, by this thread's allocations and deallocations.
    static IN_USE: Cell<(i64, i64)> = const { Cell::new((0, 0)) };
    /// Part of these bytes not yet added to [`PROCESS`].
    static UNCOUNTED: Cell<i64> = const { Cell::new(0) };
}

/// Number of bytes after which a thread updates [`PROCESS`]. So threads do not contend for `PROCESS` in every call,
/// and its error is at most this number for each thread.
const STEP: i64 = 1 << 16;

/// Bytes in use by the process now and at the peak.
static PROCESS: [AtomicI64; 2] = [AtomicI64::new(0), AtomicI64::new(0)];

/// Returns the allocations of the calling thread so far; zero unless [`CountingAllocator`] is the global allocator.
pub fn so_far() -> Count {
    COUNT.get()
}

/// Runs `work`. Returns its allocations in this thread, and its result.
pub fn count<T>(work: impl FnOnce() -> T) -> (Count, T) {
    let before = so_far();
    let result = work();
    let after = so_far();
    let count =
        Count { allocations: after.allocations - before.allocations, bytes: after.bytes - before.bytes };
    (count, result)
}

/// Runs `work`. Returns the peak of additional bytes that this thread had in use, and the result.
pub fn peak<T>(work: impl FnOnce() -> T) -> (u64, T) {
    let (before, outer) = IN_USE.get();
    IN_USE.set((before, before));
    let result = work();
    let (now, most) = IN_USE.get();
    IN_USE.set((now, most.max(outer)));
    ((most - before).max(0) as u64, result)
}

/// Runs `work`. Returns the peak of additional bytes that all threads of the process had in use, with an error of at most
/// 64 KiB for each thread, and the result. Must not run in two threads at once.
pub fn process_peak<T>(work: impl FnOnce() -> T) -> (u64, T) {
    let [held, most] = &PROCESS;
    let before = held.load(Ordering::Relaxed);
    most.store(before, Ordering::Relaxed);
    let result = work();
    ((most.load(Ordering::Relaxed) - before).max(0) as u64, result)
}

/// The system's allocator with a count for each thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct CountingAllocator;

/// Adds one call to the count of this thread.
fn count_call(bytes: usize) {
    // Fails only while the thread ends; those calls are not counted.
    let _ = COUNT.try_with(|cell| {
        let count = cell.get();
        cell.set(Count { allocations: count.allocations + 1, bytes: count.bytes + bytes as u64 });
    });
}

/// Adds `bytes`, which may be negative, to the bytes in use by this thread.
fn count_bytes(bytes: i64) {
    let _ = IN_USE.try_with(|cell| {
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

// SAFETY: every method passes its arguments to `System` unchanged and returns what `System` returned, so the contract of
// `GlobalAlloc` is kept because `System` keeps it; `count_call` and `count_bytes` neither allocate nor unwind.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count_call(layout.size());
        count_bytes(layout.size() as i64);
        // SAFETY: the caller keeps the contract of `alloc`, which is that of `System.alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count_call(layout.size());
        count_bytes(layout.size() as i64);
        // SAFETY: as for `alloc`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count_call(size);
        // A block that grows may be copied: for a moment there are two.
        count_bytes(size as i64);
        count_bytes(-(layout.size() as i64));
        // SAFETY: `block` came from this allocator, hence from `System`, with this `layout`.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count_bytes(-(layout.size() as i64));
        // SAFETY: `block` came from this allocator, hence from `System`, with this `layout`.
        unsafe { System.dealloc(block, layout) }
    }
}
