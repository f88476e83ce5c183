//! `cargo bench -p dragonfly-study --bench runtime`; see `mod.rs`.

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::{Study, runtime};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn main() {
    let mut study = Study::start("runtime");
    runtime::all(&mut study);
    study.finish();
}
