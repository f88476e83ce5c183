//! Promises of the crate, one module each.

mod agreement;
mod bounds;
mod degenerate;
mod determinism;
mod doors;
mod hostile;
mod poses;
mod sampling;
mod skinning;
mod support;

/// Counts what each thread allocates, for the promises that playing allocates nothing.
#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
