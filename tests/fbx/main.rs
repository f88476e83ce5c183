//! Tests of the crate: one module for each guarantee.

mod agreement;
mod contained;
mod content;
mod figures;
mod hostile;
mod judges;
mod round_trip;
#[path = "../anim/soundness.rs"]
mod soundness;
mod support;
mod written;
mod written_crafted;
mod written_textures;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
