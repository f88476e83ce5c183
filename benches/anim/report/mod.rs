//! The page `anim/README.md`, and the files of results that its tables are made from.

mod tables;

use dragonfly_kit::figures::FigurePage;

/// The page. `times` and `sizes` are written by `cargo bench -p dragonfly-anim -- --record`, `instructions` by
/// `benches/anim/instructions --record`.
pub(crate) static PAGE: FigurePage = FigurePage::new(
    "anim/README.md",
    "benches/anim/results",
    &["times", "sizes", "instructions"],
    tables::all,
);
