//! Actions that are split at the playhead by a key or a menu.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::Lanes;
use crate::workbench::Window;
use dragonfly::panels::Request;
use dragonfly::panels::commands::{Id, KeyScope, KeySettings, Keymap, Preset};
use dragonfly::panels::scene::SceneRequest;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;

const LOOKS: usize = 5;
const MOVE: usize = 7;
const LOOK: usize = 8;
const TITLE: usize = 10;

/// Opens the scene with selected actions and the playhead at a time.
fn window(actions: &[usize], time: f32) -> Window {
    let mut window = scene(FOXES).window();
    let select = SceneRequest::SelectActions(actions.to_vec(), Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.state_mut().state.execute(Request::Seek(time));
    window.run_steps(2);
    window
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
}

fn selected(window: &Window) -> Vec<usize> {
    window.state().state.read().scene_editing.actions().to_vec()
}

#[test]
fn a_key_splits_the_selected_clip_at_the_playhead_in_one_step_and_the_second_half_is_selected() {
    let mut window = window(&[LOOKS], 1.0);
    window.key_press(Key::Y);
    window.run_steps(3);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(
        new,
        [
            r#"<shot who="close" begin="looks-2.end" blend="0.5"/>"#,
            r#"<play id="looks" who="anna" take="Survey" to="1"></play>"#,
            r#"<play id="looks-2" who="anna" take="Survey" to="2" from="1"><at name="sees" time="1.25"/></play>"#,
            r#"<look who="ben" at="anna" bones="b_Head_05" begin="looks-2.sees" dur="2" fade-in="0.25" fade-out="0.25"/>"#,
        ]
    );
    assert_eq!(window.state().steps(), (1, 1));
    assert_eq!(window.state().edited.as_ref().unwrap().labels()[0], Some("Split"));
    assert_eq!(selected(&window), [LOOKS + 1]);
    window.state_mut().change(Change::Undo);
    window.run_steps(3);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn undo_of_a_split_selects_the_clip_that_it_brings_back() {
    let mut window = window(&[LOOKS], 1.0);
    for _ in 0..2 {
        window.key_press(Key::Y);
        window.run_steps(3);
        assert_eq!(selected(&window), [LOOKS + 1]);
        window.state_mut().change(Change::Undo);
        window.run_steps(3);
        assert_eq!((text(&window).as_str(), selected(&window)), (FOXES, vec![LOOKS]));
    }
}

#[test]
fn the_menu_of_a_bar_splits_it_and_several_are_split_at_once() {
    let mut window = window(&[LOOK, TITLE], 4.5);
    let at = Lanes::of(&window).bar(&window, TITLE).center();
    window.event(egui::Event::PointerMoved(at));
    window.run_steps(1);
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
        window.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers });
        window.run_steps(2);
    }
    window.run_steps(4);
    window.get_by_label_contains("Split action at playhead").click();
    window.run_steps(8);
    let new = new_lines(FOXES, &text(&window));
    // The look is over by then.
    assert_eq!(
        new,
        [
            r#"<title text="The End" begin="4" dur="0.5" fade-in="0.5"/>"#,
            r#"<title text="The End" begin="4.5" dur="0.5"/>"#
        ]
    );
    assert_eq!(selected(&window), [TITLE + 1]);
}

#[test]
fn what_is_not_split_and_why_is_in_the_status_line() {
    let press = |window: &mut Window| {
        window.key_press(Key::Y);
        window.run_steps(3);
    };
    let mut way = window(&[MOVE], 2.0);
    press(&mut way);
    assert!(said(&way, "<move> cannot be split"));
    let mut beside = window(&[LOOKS], 3.0);
    press(&mut beside);
    assert!(said(&beside, "The playhead is not inside of what is selected"));
    let mut mixed = window(&[LOOKS], 1.75);
    press(&mut mixed);
    assert!(said(&mixed, "begins after it and decides there"), "the run has taken over");
    let mut locked = window(&[LOOKS], 1.0);
    locked.state_mut().state.execute(Request::Scene(SceneRequest::Lock(vec!["anna".into()], true)));
    press(&mut locked);
    assert!(said(&locked, "anna is locked"));
    for window in [way, beside, mixed, locked] {
        assert_eq!((text(&window).as_str(), window.state().steps().0), (FOXES, 0));
    }
    // Of several, those that can be split are.
    let mut both = window(&[LOOK, MOVE], 2.0);
    press(&mut both);
    assert!(said(&both, "1 action is not split: <move> cannot be split"));
    assert_eq!(new_lines(FOXES, &text(&both)).len(), 2);
}

#[test]
fn the_keys_to_split_are_those_of_other_timelines() {
    for (preset, key) in
        [(Preset::Dragonfly, Key::Y), (Preset::Blender, Key::Y), (Preset::GameEngines, Key::S)]
    {
        let keymap = Keymap::new(KeySettings { preset, ..KeySettings::default() });
        assert_eq!(keymap.command_of(KeyScope::Window, key, Modifiers::NONE), Some(Id::SplitActions));
    }
}
