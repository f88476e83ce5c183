//! Every overlay, and the hint while a file is held over the window.

use super::series::{self, Crop, PictureCase};
use super::states::Fullness::{self, Crowded, Empty, Typical};
use crate::workbench::{Window, Workbench};
use dragonfly::panels::FileChoice;
use dragonfly::panels::prompts::Overlay;
use dragonfly_kit::document::fixture;
use egui::{Vec2, vec2};
use std::sync::Arc;

/// The overlays: a name, the states in which the overlay is drawn, and why the other states are not. A new overlay does
/// not compile without a row here.
macro_rules! overlays {
    ($($overlay:ident $(($of:path))? => $name:literal, $size:expr, [$($state:ident),*], $reason:literal;)*) => {
        /// Returns the name that the pictures of an overlay begin with.
        fn name(overlay: Overlay) -> &'static str {
            match overlay {
                $(Overlay::$overlay { .. } => $name,)*
            }
        }

        /// Each overlay with the size of its window, its states, and the reason why others are left out.
        const TABLE: &[(Overlay, Vec2, &[Fullness], &str)] =
            &[$((Overlay::$overlay $(($of))?, $size, &[$($state),*], $reason)),*];
    };
}

overlays! {
    Palette => "palette", vec2(560.0, 480.0), [Empty, Typical, Crowded], "";
    Shortcuts => "shortcuts", vec2(560.0, 480.0), [Typical],
        "the list of commands is the same whatever is open";
    About => "about", vec2(560.0, 320.0), [Typical], "the text is the same whatever is open";
    ComparePath => "compare-path", vec2(640.0, 320.0), [Typical], "the field is the same whatever is open";
    FilePath(FileChoice::Role) => "file-path", vec2(640.0, 260.0), [Typical], "the field is the same whatever is open";
    OpenPath => "open-path", vec2(640.0, 420.0), [Typical], "the field is the same whatever is open";
    ImportOptions => "import-options", vec2(640.0, 420.0), [Typical], "the fields are the same whatever is open";
    Export => "export", vec2(640.0, 560.0), [Empty, Typical], "the list of takes is one line";
    MirrorPairs => "mirror-pairs", vec2(640.0, 480.0), [Empty, Typical], "more bones only make the list scroll";
    Retarget => "retarget", vec2(720.0, 560.0), [Empty, Typical, Crowded], "";
    ModelSize => "model-size", vec2(560.0, 320.0), [Typical], "a model has one size";
    Loop => "loop", vec2(640.0, 560.0), [Empty, Typical, Crowded], "";
    Reference => "reference", vec2(560.0, 480.0), [Typical], "the dialog is the same whatever is open";
    RootMotion => "root-motion", vec2(640.0, 480.0), [Empty, Typical, Crowded], "";
}

/// Returns a case in a window without panels around the overlay.
fn case(name: String, size: Vec2, fullness: Fullness, overlay: Option<Overlay>) -> PictureCase {
    PictureCase {
        name,
        size,
        crop: Crop::Above,
        bench: Box::new(move || {
            let mut bench = fullness.bench();
            for panel in dragonfly::panels::all() {
                bench.desk.toggle_panel(panel.id());
            }
            bench.state.show_overlay(overlay);
            bench
        }),
        act: Box::new(|_| {}),
        twice: true,
    }
}

pub(super) fn cases() -> Vec<PictureCase> {
    let mut cases: Vec<PictureCase> = TABLE
        .iter()
        .flat_map(|&(overlay, size, states, _)| {
            let named = move |state: &Fullness| format!("overlays/{}-{}", name(overlay), state.word());
            states.iter().map(move |state| case(named(state), size, *state, Some(overlay)))
        })
        .collect();
    // The palette finds takes as well, and there are many.
    let types = |window: &mut Window| window.event(egui::Event::Text("walk".to_owned()));
    for case in cases.iter_mut().filter(|case| case.name == "overlays/palette-crowded") {
        case.act = Box::new(types);
    }
    // A text that no command contains.
    let types = |window: &mut Window| window.event(egui::Event::Text("no such command".to_owned()));
    let nothing = case(
        "overlays/palette-nothing-found".to_owned(),
        vec2(560.0, 480.0),
        Typical,
        Some(Overlay::Palette),
    );
    cases.push(PictureCase { act: Box::new(types), ..nothing });
    // The dialog offers a root bone where no bone is above the hips.
    let name = "overlays/root-motion-hips-on-top".to_owned();
    let rootless = case(name, vec2(640.0, 480.0), Typical, Some(Overlay::RootMotion));
    let bench = || {
        let mut bench = Workbench::new(Some(fixture::hips_on_top()));
        for panel in dragonfly::panels::all() {
            bench.desk.toggle_panel(panel.id());
        }
        bench.state.show_overlay(Some(Overlay::RootMotion));
        bench
    };
    cases.push(PictureCase { bench: Box::new(bench), ..rootless });
    // The dialog lists the bones of both models once the file is read.
    let name = "overlays/retarget-source".to_owned();
    let read = case(name, vec2(720.0, 640.0), Typical, Some(Overlay::Retarget));
    let bench = || {
        let mut bench = Typical.bench();
        for panel in dragonfly::panels::all() {
            bench.desk.toggle_panel(panel.id());
        }
        bench.state.source_read(Arc::clone(&fixture::hips_on_top().loaded));
        bench.state.show_overlay(Some(Overlay::Retarget));
        bench
    };
    cases.push(PictureCase { bench: Box::new(bench), ..read });
    // A file that is held over the window; the hint fills it.
    let holds = |window: &mut Window| window.input_mut().hovered_files.push(egui::HoveredFile::default());
    let drop = case("overlays/drop-a-file".to_owned(), vec2(480.0, 240.0), Typical, None);
    cases.push(PictureCase { crop: Crop::Whole, act: Box::new(holds), ..drop });
    cases
}

#[test]
fn the_overlays_look_as_stored() {
    series::compare(cases());
}

#[test]
fn every_overlay_is_drawn_in_three_states_or_there_is_a_reason() {
    for (overlay, _, states, reason) in TABLE {
        assert!(states.len() == 3 || (!states.is_empty() && !reason.is_empty()), "{overlay:?}");
    }
}
