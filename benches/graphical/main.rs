//! `cargo bench -p dragonfly-study --bench graphical`; see `mod.rs`.

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::{Study, graphical};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn main() {
    let mut study = Study::start("graphical");
    graphical::all(&mut study);
    study.finish();
}
