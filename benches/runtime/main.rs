//! `cargo bench -p dragonfly-study --bench runtime`; see `mod.rs`.

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::goal::goals;
use dragonfly_study::{Study, StudyMode, runtime};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn main() {
    let mut study = Study::start("runtime");
    runtime::all(&mut study);
    let mode = study.mode;
    let rows = study.finish();
    if mode != StudyMode::Check {
        goals(&rows).iter().for_each(|goal| println!("{goal}"));
    }
}
