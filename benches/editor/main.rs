//! Cost of opening and editing a model, and of a frame of the panels: `cargo bench -p dragonfly --bench editor`, or
//! `-- editor/frame` for the cases whose names contain this. `-- --record` writes the files in `results` and the tables of
//! `README.md`; `-- --record editor/frame` writes one file.

mod convert;
mod edits;
mod frame;
mod report;
mod save;
mod timeline;

use dragonfly_kit::figures::FigureBench;
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;

fn main() -> ExitCode {
    FigureBench::run(&report::PAGE, "editor", "cargo bench -p dragonfly --bench editor", |bench| {
        bench.file("edits", edits::run);
        bench.file("timeline", timeline::all);
        bench.file("save", save::all);
        bench.file("frame", frame::all);
        bench.file("convert", convert::all);
    })
}
