//! Cost of opening and editing a model, and of a frame of the panels: `cargo bench -p dragonfly`.

mod edits;
mod frame;
mod save;
mod timeline;

use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_kit::bench::measure;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;

fn main() {
    edits::run();
    measure("editor/document/open_the_built_in_model", 1, || {
        load_model(&Source::BuiltIn, &mut |_| {}, &Cancel::default()).expect("part of the program")
    });
    timeline::all();
    save::all();
    frame::all();
}
