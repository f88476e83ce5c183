//! Promises of the crate, one module each.

mod agreement;
mod bad_files;
mod bombs;
mod bounds;
mod budget;
mod damage;
mod degenerate;
mod degenerate_import;
mod determinism;
mod doors;
mod fast_layers;
mod fast_path;
mod fixture;
mod formats;
mod hostile;
mod poses;
mod rules;
mod sampling;
mod seeds;
mod simd;
mod skinning;
mod soundness;
mod support;
mod textures;
mod trial;
mod uris;

/// Counts what each thread allocates, for the promises that playing allocates nothing.
#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
