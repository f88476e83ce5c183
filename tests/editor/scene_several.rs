//! Several actions in the timeline of a scene: selected, moved, copied, deleted; clips that mix where they overlap, or go to other lanes.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::{Lanes, drag};
use crate::workbench::{Window, move_to, press, release};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::scene::timeline::{handed_back_part, mixed_part};
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::table::{ELEMENTS, ElementGroup};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::ScriptLabel;
use egui::{Key, Modifiers, pos2};

const LOOKS: usize = 5;
const RUN: usize = 6;
const MOVE: usize = 7;
const LOOK: usize = 8;
const TITLE: usize = 10;

fn window() -> Window {
    scene(FOXES).window()
}

fn actions(window: &Window) -> Vec<usize> {
    window.state().state.read().scene_editing.actions().to_vec()
}

fn select(window: &mut Window, actions: &[usize]) {
    let request = SceneRequest::SelectActions(actions.to_vec(), Choice::Replace);
    window.state_mut().state.execute(Request::Scene(request));
    window.run_steps(1);
}

/// Clicks the middle of a bar, below its fades.
fn click(window: &mut Window, action: usize, modifiers: Modifiers) {
    let bar = Lanes::of(window).bar(window, action);
    let at = pos2(bar.center().x, bar.bottom() - 4.0);
    move_to(window, at, modifiers);
    for pressed in [true, false] {
        let button = egui::PointerButton::Primary;
        window.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers });
        window.run_steps(1);
    }
    move_to(window, at, Modifiers::NONE);
    // Two clicks are no double click.
    window.run_steps(30);
}

/// Runs a command. Returns the text that it copies.
fn run(window: &mut Window, id: Id) -> Option<String> {
    let effect = window.state_mut().state.execute(Request::Command(id));
    let text = match effect {
        Some(Effect::Change(change)) => {
            window.state_mut().change(change);
            None
        }
        Some(Effect::Copy(text)) => Some(text),
        Some(Effect::Cut(text, change)) => {
            window.state_mut().change(change);
            Some(text)
        }
        _ => None,
    };
    window.run_steps(3);
    text
}

fn paste(window: &mut Window, text: &str) {
    let paste = Request::PastePose { text: text.to_owned(), mirrored: false };
    if let Some(Effect::Change(change)) = window.state_mut().state.execute(paste) {
        window.state_mut().change(change);
    }
    window.run_steps(3);
}

fn last_label(window: &Window) -> &'static str {
    let steps = window.state().edited.as_ref().unwrap().steps();
    steps.0.back().unwrap().edit.label()
}

#[test]
fn shift_adds_an_action_ctrl_toggles_one_and_a_click_selects_one() {
    let mut window = window();
    click(&mut window, MOVE, Modifiers::NONE);
    click(&mut window, TITLE, Modifiers::SHIFT);
    assert_eq!(actions(&window), [MOVE, TITLE]);
    click(&mut window, MOVE, Modifiers::COMMAND);
    assert_eq!(actions(&window), [TITLE]);
    click(&mut window, LOOK, Modifiers::COMMAND);
    assert_eq!(actions(&window), [TITLE, LOOK]);
    click(&mut window, MOVE, Modifiers::NONE);
    assert_eq!(actions(&window), [MOVE]);
}

#[test]
fn a_box_selects_the_bars_that_it_touches_and_the_key_for_all_selects_all() {
    let mut window = window();
    let lanes = Lanes::of(&window);
    let [first, last] = [MOVE, LOOK].map(|action| lanes.bar(&window, action));
    let from = pos2(lanes.canvas.left() + 2.0, first.top() + 1.0);
    let to = pos2(last.right() + 4.0, last.bottom() - 2.0);
    press(&mut window, from);
    for step in 1..=4 {
        move_to(&mut window, from + (to - from) * (step as f32 / 4.0), Modifiers::NONE);
    }
    release(&mut window, to);
    let mut found = actions(&window);
    found.sort_unstable();
    assert_eq!(found, [MOVE, LOOK]);
    assert_eq!(text(&window), FOXES);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.run_steps(2);
    assert_eq!(actions(&window).len(), 8, "all actions that have bars");
}

#[test]
fn a_drag_of_one_of_several_selected_actions_moves_all_in_one_step() {
    let mut window = window();
    select(&mut window, &[TITLE, MOVE]);
    let bar = Lanes::of(&window).bar(&window, MOVE);
    drag(&mut window, bar.center(), 0.5, Modifiers::NONE);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [
            r#"<move who="ben" path="aisle" take="Walk" begin="1.5"/>"#,
            r#"<title text="The End" begin="4.5" dur="1" fade-in="0.5"/>"#
        ]
    );
    assert_eq!((window.state().steps(), last_label(&window)), ((1, 1), "Move actions"));
    assert_eq!(actions(&window), [TITLE, MOVE], "they stay selected");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
    run(&mut window, Id::ClipLater);
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 2);
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn several_actions_are_deleted_duplicated_cut_and_pasted_in_one_step_each() {
    let mut window = window();
    select(&mut window, &[MOVE, TITLE]);
    run(&mut window, Id::SceneDelete);
    let left = text(&window);
    assert!(!left.contains("<move") && !left.contains("<title") && left.contains("<look"));
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    select(&mut window, &[MOVE, TITLE]);
    run(&mut window, Id::SceneDuplicate);
    let twice = text(&window);
    assert_eq!((twice.matches("<move").count(), twice.matches("<title").count()), (2, 2));
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    select(&mut window, &[MOVE, TITLE]);
    let copied = run(&mut window, Id::CutKeys).expect("a text");
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().state.execute(Request::Seek(2.0));
    select(&mut window, &[LOOK]);
    paste(&mut window, &copied);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [
            r#"<move who="ben" path="aisle" take="Walk" begin="2"/>"#,
            r#"<title text="The End" begin="5" dur="1" fade-in="0.5"/>"#
        ]
    );
    assert_eq!((window.state().steps(), last_label(&window)), ((2, 2), "Paste"));
}

#[test]
fn copied_actions_are_pasted_for_the_role_that_is_selected() {
    let mut window = window();
    select(&mut window, &[LOOKS]);
    let copied = run(&mut window, Id::Copy).expect("a text");
    window.state_mut().state.execute(Request::Seek(4.0));
    let ben = SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(ben));
    window.run_steps(1);
    paste(&mut window, &copied);
    let new = new_lines(FOXES, &text(&window)).concat();
    assert!(new.contains(r#"who="ben" take="Survey" to="2" begin="4""#), "{new}");
    paste(&mut window, "something else");
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn a_clip_dragged_onto_another_lane_belongs_to_that_role() {
    let mut window = window();
    let lanes = Lanes::of(&window);
    let [from, to] = [LOOKS, MOVE].map(|action| lanes.bar(&window, action).center());
    let from = pos2(from.x, from.y + 4.0);
    press(&mut window, from);
    for step in 1..=4 {
        move_to(&mut window, from + (pos2(from.x, to.y) - from) * (step as f32 / 4.0), Modifiers::NONE);
    }
    release(&mut window, pos2(from.x, to.y));
    let new = text(&window);
    let line = new.lines().find(|line| line.contains("id=\"looks\"")).unwrap_or_default();
    assert!(line.contains("who=\"ben\""), "{line}");
    assert_eq!(window.state().steps(), (1, 1));
    assert_eq!(window.state().refused, [""; 0]);
    assert!(window.state().state.read().scene().unwrap().errors.is_empty(), "{new}");
}

#[test]
fn a_bar_dragged_over_another_one_mixes_with_it_and_the_cross_is_where_the_mix_is() {
    let apart = FOXES.replace("begin=\"-0.5\" fade-in=\"0.5\" repeat=\"3\"", "begin=\"0.5\" repeat=\"3\"");
    let mut window = scene(&apart).window();
    let part = |window: &Window| {
        let lanes = Lanes::of(window);
        let all = window.state().state.read().scene_editing.lanes().clone();
        let (_, bar) = all.bar_of(RUN).unwrap();
        let part = mixed_part(bar, lanes.bar(window, RUN), &lanes.scale)?;
        let seconds = f64::from(part.width()) / lanes.scale.per_second();
        Some(((part.left() - lanes.bar(window, RUN).left()).abs(), seconds))
    };
    assert_eq!(part(&window), None);
    let bar = Lanes::of(&window).bar(&window, RUN);
    drag(&mut window, pos2(bar.center().x, bar.bottom() - 4.0), -0.75, Modifiers::ALT);
    let new = new_lines(&apart, &text(&window));
    assert_eq!(new, [r#"<play who="anna" take="Run" begin="-0.25" repeat="3" fade-in="0.25"/>"#]);
    assert_eq!(window.state().steps(), (1, 1), "move and fade are one step");
    let (left, seconds) = part(&window).expect("a mix");
    assert!(left < 0.01 && (seconds - 0.25).abs() < 0.01, "{left} {seconds}");
    // A cut has no width.
    let mut cut = scene(&FOXES.replace(" fade-in=\"0.5\" repeat", " repeat")).window();
    cut.run_steps(1);
    assert_eq!(part(&cut).map(|(_, seconds)| seconds), Some(0.0));
}

#[test]
fn a_bar_dragged_inside_of_another_one_fades_at_both_ends_and_has_a_cross_at_each_of_them() {
    let apart = FOXES
        .replace("take=\"Survey\" to=\"2\"", "take=\"Survey\"")
        .replace("begin=\"-0.5\" fade-in=\"0.5\" repeat=\"3\"", "begin=\"0.5\"");
    let mut window = scene(&apart).window();
    let parts = |window: &Window| {
        let lanes = Lanes::of(window);
        let all = window.state().state.read().scene_editing.lanes().clone();
        let (_, bar) = all.bar_of(RUN).unwrap();
        let rect = lanes.bar(window, RUN);
        let [start, end] = [mixed_part, handed_back_part].map(|part| part(bar, rect, &lanes.scale));
        let seconds = |width: f32| f64::from(width) / lanes.scale.per_second();
        assert!(end.is_none_or(|end| (end.right() - rect.right()).abs() < 0.01), "{end:?} {rect}");
        [start, end].map(|part| part.map(|part| seconds(part.width())))
    };
    assert_eq!(parts(&window), [None, None]);
    let bar = Lanes::of(&window).bar(&window, RUN);
    drag(&mut window, pos2(bar.center().x, bar.bottom() - 4.0), -2.5, Modifiers::ALT);
    let new = new_lines(&apart, &text(&window));
    assert!(new.len() == 1 && new[0].ends_with(r#" fade-in="0.25" fade-out="0.25"/>"#), "{new:?}");
    assert_eq!(window.state().steps(), (1, 1), "move and fades are one step");
    let [Some(start), Some(end)] = parts(&window) else { panic!("{:?}", parts(&window)) };
    assert!((start - 0.25).abs() < 0.01 && (end - 0.25).abs() < 0.01, "{start} {end}");
    // The handle at its end changes the fade there.
    let lanes = Lanes::of(&window);
    let bar = lanes.bar(&window, RUN);
    let handle = bar.right() - (0.25 * lanes.scale.per_second()) as f32 - 12.0;
    drag(&mut window, pos2(handle, bar.top() + 3.0), -0.25, Modifiers::NONE);
    assert_eq!(window.state().steps(), (2, 2));
    let [Some(start), Some(end)] = parts(&window) else { panic!("{:?}", parts(&window)) };
    // It snaps to a frame, or to what is near.
    assert!((start - 0.25).abs() < 0.01 && (end - 0.5).abs() < 0.1, "{start} {end}");
}

#[test]
fn steps_of_scenes_have_names_of_their_own() {
    let mut window = window();
    let ben = SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace);
    let raised = FOXES.replace("at=\"1 0 0\"", "at=\"1 0.5 0\"");
    let mut high = scene(&raised).window();
    high.state_mut().state.execute(Request::Scene(ben));
    run(&mut high, Id::DropToGround);
    assert_eq!(last_label(&high), "Drop to the ground");
    run(&mut window, Id::AddEffect);
    assert_eq!(last_label(&window), "Add effect");
    run(&mut window, Id::AddTitle);
    assert_eq!(last_label(&window), "Add title");
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectThings(
        ["ben", "aisle"].map(Box::from).to_vec(),
        Choice::Replace,
    )));
    run(&mut window, Id::WalkAlong);
    assert_eq!(last_label(&window), "Add move");
}

#[test]
fn a_step_that_adds_an_action_has_the_name_of_that_kind_of_action() {
    let actions = ELEMENTS.iter().filter(|row| row.group == ElementGroup::Action);
    let mut labels: Vec<&str> = Vec::new();
    for row in actions.filter(|row| row.name != "include") {
        let label = ScriptLabel::adding(row.name);
        assert_ne!(label, ScriptLabel::AddAction, "{}", row.name);
        labels.push(label.text());
    }
    labels.sort_unstable();
    let count = labels.len();
    labels.dedup();
    assert_eq!(labels.len(), count, "two kinds have one name: {labels:?}");
    assert!(count > 12 && ScriptLabel::ALL.iter().all(|label| ScriptLabel::of(label.text()) == Some(*label)));
}
