//! How often a piece of code allocates, counted for the thread that runs it.
//!
//! A test binary installs the allocator once:
//!
//! ```
//! #[global_allocator]
//! static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
//! let (count, _) = dragonfly_kit::counting::count(|| Box::new(1));
//! assert_eq!(count.allocations, 1);
//! ```

// A global allocator cannot be written without it; nothing else in this crate may use it.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

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
}

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

// SAFETY: every method hands its arguments on to `System` unchanged and returns what `System` returned, so the contract
// of `GlobalAlloc` is kept because `System` keeps it; `note` neither allocates nor unwinds.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        // SAFETY: the caller keeps the contract of `alloc`, which is that of `System.alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        // SAFETY: as for `alloc`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note(size);
        // SAFETY: `block` came from this allocator, hence from `System`, with this `layout`.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: `block` came from this allocator, hence from `System`, with this `layout`.
        unsafe { System.dealloc(block, layout) }
    }
}
