//! What opening a model costs, and what a frame of the panels does: `cargo bench -p dragonfly`.

mod timeline;

use dragonfly::document::{Cancel, Source, load_model};
use dragonfly_kit::bench::measure;

fn main() {
    measure("editor/document/open_the_built_in_model", 1, || {
        load_model(&Source::BuiltIn, &mut |_| {}, &Cancel::default()).expect("part of the program")
    });
    timeline::all();
}
