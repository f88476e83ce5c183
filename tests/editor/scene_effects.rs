//! Effects: the notes that the editor does not draw them.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::scene_timeline::Lanes;
use crate::workbench::{Window, move_to};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use egui::Modifiers;
use egui_kittest::kittest::Queryable;

const NOTE: &str = "Effects are not drawn yet";

fn says_so(window: &Window) -> bool {
    window.query_all_by_label_contains(&format!("Messages: {NOTE}")).count() > 0
}

/// A scene with rain from one second to two.
fn rain() -> String {
    let text = FOXES.replace(
        "  </cast>",
        "    <effect id=\"rain\" kind=\"particles\" preset=\"rain\" at=\"0 6 0\"/>\n  </cast>",
    );
    text.replace("  </par>", "    <run who=\"rain\" begin=\"1\" dur=\"1\"/>\n  </par>")
}

#[test]
fn an_effect_that_is_added_is_said_to_be_not_drawn() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::AddMark);
    assert!(!says_so(&window));
    run(&mut window, Id::AddEffect);
    let read = window.state().state.read();
    assert!(read.status.lines().any(|message| message.text == NOTE));
}

#[test]
fn the_status_line_says_that_an_effect_at_the_playhead_is_not_drawn() {
    let mut window = scene(&rain()).window();
    for (time, is_on) in [(0.5, false), (1.5, true), (2.5, false)] {
        window.state_mut().state.execute(Request::Seek(time));
        window.run_steps(2);
        assert_eq!(says_so(&window), is_on, "{time} s");
    }
}

#[test]
fn the_hint_of_the_bar_of_an_effect_says_that_it_is_not_drawn() {
    let mut window = scene(&rain()).window();
    let lanes = Lanes::of(&window);
    let editing = window.state().state.read().scene_editing;
    let of_effect = |kind: &str| {
        let mut bars = editing.lanes().list.iter().flat_map(|lane| &lane.bars);
        bars.find(|bar| bar.kind == kind).expect("a bar").action
    };
    let [rain, title] = ["run", "title"].map(|kind| lanes.bar(&window, of_effect(kind)).center());
    for (at, is_shown) in [(title, false), (rain, true)] {
        move_to(&mut window, at, Modifiers::NONE);
        window.run_steps(60);
        assert_eq!(window.query_all_by_label(NOTE).count() > 0, is_shown);
    }
}
