//! Pictures of every panel, question, overlay and menu, and of the whole window, compared with those in
//! `tests/data/pictures`.
//!
//! ```text
//! states     empty, typical and crowded: what is open and selected
//! panels, questions, overlays, menus     the cases: a state, a size, what is clicked
//! series     draws each case in both themes at 1x and 2x, and compares it
//! reference  the files: written small, read, updated
//! compare    the tolerance
//! windows    the whole window with the scene, through the passes of the program
//! effects    the scene alone, with an effect
//! ```
//!
//! `DRAGONFLY_UPDATE_PICTURES=1 ./test --workspace --test editor pictures` replaces the pictures that differ. Everything that
//! depends on time is fixed: egui runs with steps of a quarter second, no cursor blinks, nothing is animated, and the
//! duration of the last frame is a constant.

mod compare;
mod drawing;
mod effects;
mod menus;
mod overlays;
mod panels;
mod questions;
mod reference;
mod series;
pub(crate) mod states;
mod windows;

use reference::update;
use std::collections::BTreeSet;

#[test]
fn every_file_in_the_folder_of_pictures_is_compared() {
    let cases =
        [panels::cases(), questions::cases(), overlays::cases(), menus::cases()].into_iter().flatten();
    let mut names: BTreeSet<String> = cases.flat_map(|case| case.names()).collect();
    names.extend(windows::names());
    names.extend(effects::names());
    let strays: Vec<String> = reference::stored().into_iter().filter(|name| !names.contains(name)).collect();
    if update() {
        strays.iter().for_each(|name| std::fs::remove_file(reference::path(name)).unwrap());
        return;
    }
    assert!(
        strays.is_empty(),
        "no test draws these pictures any more: {strays:?}\n{}",
        reference::HOW_TO_UPDATE
    );
}

#[test]
fn the_pictures_take_at_most_eight_megabytes() {
    let bytes: u64 =
        reference::stored().iter().map(|name| std::fs::metadata(reference::path(name)).unwrap().len()).sum();
    assert!(bytes <= 8 << 20, "{bytes} bytes of pictures");
}
