//! The page `benches/editor/README.md`, and the files of results that its tables are made from.

mod tables;

use dragonfly_kit::figures::FigurePage;

/// The page. `drag` is written by the bench `drag`, the other files by the bench `editor`.
pub(crate) static PAGE: FigurePage = FigurePage::new(
    "benches/editor/README.md",
    "benches/editor/results",
    &["drag", "timeline", "frame", "edits", "save", "convert"],
    tables::all,
);
