//! The tables of `anim/FORMATS.md`, and the files of results that they are made from.

mod tables;

use dragonfly_kit::figures::FigurePage;

/// The page.
pub(crate) static PAGE: FigurePage =
    FigurePage::new("anim/FORMATS.md", "benches/formats/results", &["round-trips", "speed"], tables::all);
