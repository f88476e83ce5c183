//! What opening a model costs: `cargo bench -p dragonfly`.

use dragonfly::document::{Cancel, Source, load_model};
use dragonfly_kit::bench::measure;

fn main() {
    measure("editor/document/open_the_built_in_model", 1, || {
        load_model(&Source::BuiltIn, &mut |_| {}, &Cancel::default()).expect("part of the program")
    });
}
