//! Promises of the crate, one module each.

mod agreement;
mod bad_files;
mod bounds;
mod damage;
mod degenerate;
mod determinism;
mod doors;
mod fixture;
mod hostile;
mod poses;
mod rules;
mod sampling;
mod seeds;
mod skinning;
mod soundness;
mod support;
mod trial;

/// Counts what each thread allocates, for the promises that playing allocates nothing.
#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
