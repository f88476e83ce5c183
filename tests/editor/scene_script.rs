//! The script panel: what is typed, the steps it makes, what follows it.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::Window;
use dragonfly::panels::dialogs::UnsavedQuestion;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::scene::script::ScriptPanel;
use dragonfly::panels::{Panel, Request, style};
use dragonfly_document::{Change, Then};
use dragonfly_kit::counting::count;
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};

/// Puts the cursor of the script at a byte of its text.
pub(crate) fn put_cursor(window: &mut Window, at: usize) {
    window.get_by_label("Script of the scene").focus();
    window.run_steps(2);
    let id = egui::Id::unique("script of the scene");
    let shown = window.state().state.read().scene().unwrap().text.clone();
    let cursor = CCursor::new(shown[..at].chars().count());
    let mut state = TextEditState::load(&window.ctx, id).unwrap_or_default();
    state.cursor.set_char_range(Some(CCursorRange::one(cursor)));
    state.store(&window.ctx, id);
    window.run_steps(2);
}

/// Types letters one after the other.
pub(crate) fn type_text(window: &mut Window, text: &str) {
    for letter in text.chars() {
        window.event(Event::Text(letter.to_string()));
        window.run_steps(1);
    }
    window.run_steps(2);
}

fn place(text: &str, of: &str) -> usize {
    text.find(of).unwrap() + of.len()
}

#[test]
fn what_is_typed_is_in_the_document_and_the_timeline_follows() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "take=\"Walk\" begin=\"1"));
    type_text(&mut window, ".5");
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [r#"<move who="ben" path="aisle" take="Walk" begin="1.5"/>"#]
    );
    let lanes = window.state().state.read().scene_editing.lanes().clone();
    let (_, bar) = lanes.bar_of(7).unwrap();
    assert_eq!(bar.begin.seconds(), 1.5);
    assert_eq!(
        window.state().state.read().scene_editing.action(),
        Some(7),
        "the element at the cursor is selected"
    );
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn undo_goes_back_word_by_word_to_the_same_bytes() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "Two foxes meet"));
    type_text(&mut window, " in the wood");
    let typed = FOXES.replace("Two foxes meet", "Two foxes meet in the wood");
    assert_eq!(text(&window), typed);
    let steps = window.state().steps().0;
    assert!((3..=4).contains(&steps), "{steps} steps for three words");
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(3);
    assert_eq!(text(&window), typed.replace("wood", ""), "one word is undone");
    for _ in 0..steps {
        window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        window.run_steps(3);
    }
    assert_eq!(text(&window), FOXES);
    for _ in 0..steps {
        window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
        window.run_steps(3);
    }
    assert_eq!(text(&window), typed);
}

#[test]
fn each_step_of_typing_names_what_was_typed_and_its_line() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "Two foxes meet"));
    type_text(&mut window, " again");
    let about = |window: &Window| {
        let read = window.state().state.read();
        let history = &read.view.expect("a scene").history;
        (history.steps.clone(), history.about.iter().map(ToString::to_string).collect::<Vec<_>>())
    };
    let (steps, texts) = about(&window);
    assert_eq!(texts.last().map(String::as_str), Some("“again” in line 3"), "{steps:?} {texts:?}");
    // The word is one message of the status line, too.
    put_cursor(&mut window, place(FOXES, "Two foxes"));
    let said = |window: &Window| window.state().state.read().status.lines().count();
    let before = said(&window);
    type_text(&mut window, "es");
    assert!(said(&window) <= before + 1, "a letter is no message");
    // A word that is deleted is named as well.
    for _ in 0..2 {
        window.key_press(Key::Backspace);
        window.run_steps(1);
    }
    let (steps, texts) = about(&window);
    assert_eq!(steps.last(), Some(&"Delete text"), "{steps:?}");
    assert_eq!(texts.last().map(String::as_str), Some("“es” in line 3"), "{texts:?}");
}

/// Returns the labels of the steps, with what they are about.
fn named_steps(window: &Window) -> Vec<(&'static str, String)> {
    let read = window.state().state.read();
    let history = &read.view.expect("a scene").history;
    history.steps.iter().copied().zip(history.about.iter().map(ToString::to_string)).collect()
}

#[test]
fn letters_that_arrive_in_one_frame_are_typed_and_one_step_a_word() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "Two foxes meet"));
    for together in [" ag", "ai", "n an", "d again"] {
        let letters = together.chars().map(|letter| Event::Text(letter.to_string()));
        window.input_mut().events.extend(letters);
        window.run_steps(1);
    }
    window.run_steps(2);
    assert!(text(&window).contains("Two foxes meet again and again."));
    let typed = |word: &str| ("Type", format!("“{word}” in line 3"));
    let steps = named_steps(&window);
    assert_eq!(steps[steps.len() - 3..], [typed("again"), typed("and"), typed("again")], "{steps:?}");
    assert!(steps.iter().all(|(label, _)| *label == "Type"), "{steps:?}");
    while window.state().steps().0 > 0 {
        window.state_mut().change(Change::Undo);
    }
    window.run_steps(3);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn only_what_comes_from_the_clipboard_is_pasted_and_it_is_a_step_of_its_own() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "Two foxes meet"));
    type_text(&mut window, " a");
    window.event(Event::Paste("x".to_owned()));
    window.run_steps(2);
    type_text(&mut window, "b");
    assert!(text(&window).contains("Two foxes meet axb."));
    let steps = named_steps(&window);
    let labels: Vec<&str> = steps.iter().map(|(label, _)| *label).collect();
    assert_eq!(labels[labels.len() - 3..], ["Type", "Paste text", "Type"], "{steps:?}");
    // A suggestion is no paste.
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "<move who=\"ben\" path=\"aisle\" take=\"Wal"));
    for _ in 0..3 {
        window.key_press(Key::Backspace);
        window.run_steps(1);
    }
    type_text(&mut window, "R");
    window.key_press(Key::Tab);
    window.run_steps(3);
    let steps = named_steps(&window);
    assert!(
        text(&window).contains("take=\"Run\" begin=\"1\"")
            && steps.iter().all(|(label, _)| *label != "Paste text"),
        "{steps:?}"
    );
}

#[test]
fn while_the_text_is_broken_the_last_good_scene_stays_and_the_error_is_listed() {
    let mut window = scene(FOXES).window();
    let before = window.state().state.read().scene_editing.lanes().clone();
    put_cursor(&mut window, place(FOXES, "<move who=\"ben\" path=\"aisle\" tak"));
    window.key_press(Key::Backspace);
    window.run_steps(3);
    let read = window.state().state.read();
    let scene = read.scene().unwrap();
    assert_eq!(scene.errors.len(), 1);
    assert_eq!(read.scene_editing.lanes(), &before);
    let errors = window.query_all_by_label_contains("Error at").count();
    assert_eq!(errors, 1, "the list names it");
    type_text(&mut window, "k");
    assert_eq!(text(&window), FOXES);
    assert!(window.state().state.read().scene().unwrap().errors.is_empty());
}

#[test]
fn the_question_about_unsaved_work_names_the_place_of_an_error_that_was_typed() {
    let mut window = scene(FOXES).window();
    let ask = |window: &mut Window| {
        let question = UnsavedQuestion { then: Then::Quit };
        window.state_mut().state.ask(question.into());
        window.run_steps(3);
        let error = window.query_all_by_label_contains("is saved as it is: scene.xml:").next();
        let text = error.and_then(|node| {
            let node = node.accesskit_node();
            node.label().or_else(|| node.value())
        });
        window.state_mut().state.execute(Request::Dismiss);
        window.run_steps(2);
        text
    };
    put_cursor(&mut window, place(FOXES, "Two foxes"));
    type_text(&mut window, "!");
    assert_eq!(ask(&mut window), None, "without an error it is as before");
    put_cursor(&mut window, place(FOXES, "</cas") + 1);
    window.key_press(Key::Backspace);
    window.run_steps(3);
    let place = window.state().state.read().scene().unwrap().errors[0].place;
    let asked = ask(&mut window).expect("the error");
    assert!(asked.contains(&format!("scene.xml:{place}: ")), "{asked}");
}

#[test]
fn a_comment_that_is_typed_after_a_thing_leaves_that_thing_selected() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "facing=\"-90\" scale=\"0.01\"/>") - 1);
    let things = |window: &Window| window.state().state.read().scene_editing.things().to_vec();
    assert_eq!(things(&window), [Box::from("ben")]);
    window.key_press(Key::ArrowRight);
    window.run_steps(2);
    for part in [" <", "!-", "- a much longer comment than any ", "-", "-", ">"] {
        type_text(&mut window, part);
        assert!(!things(&window).contains(&"wide".into()), "after {part}: the next line is selected");
    }
    assert!(text(&window).contains("scale=\"0.01\"/> <!-- a much longer comment than any -->"));
}

#[test]
fn a_suggestion_is_taken_with_tab() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "<move who=\"ben\" path=\"aisle\" take=\"Wal"));
    for _ in 0..3 {
        window.key_press(Key::Backspace);
        window.run_steps(1);
    }
    type_text(&mut window, "R");
    window.key_press(Key::Tab);
    window.run_steps(3);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<move who="ben" path="aisle" take="Run" begin="1"/>"#]);
}

#[test]
fn escape_closes_the_suggestions_and_the_text_keeps_the_keys() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "  <par id=\"scene-1\">"));
    type_text(&mut window, "<wa");
    assert!(window.query_by_label("wait").is_some(), "suggestions");
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert!(window.query_by_label("wait").is_none(), "they are closed");
    type_text(&mut window, "xq");
    assert!(text(&window).contains("<waxq"), "what follows is typed");
    window.key_press(Key::Escape);
    window.run_steps(2);
    type_text(&mut window, "z");
    assert!(!text(&window).contains("<waxqz"), "without suggestions it leaves the text");
}

#[test]
fn a_new_line_after_a_long_one_is_typed_in_sight() {
    let long = format!("  <!-- {} -->", "far ".repeat(120));
    let script = FOXES.replace("  <!-- Two foxes meet. -->", &long);
    let mut window = scene(&script).window();
    let left = |window: &Window| window.get_by_label("Script of the scene").rect().left();
    put_cursor(&mut window, place(&script, &long));
    window.run_steps(30);
    let start = left(&window);
    window.key_press(Key::End);
    window.run_steps(30);
    window.key_press(Key::ArrowLeft);
    window.run_steps(30);
    let far = left(&window);
    window.key_press(Key::Home);
    window.run_steps(30);
    let near = left(&window);
    assert!(far < near - 100.0 && start <= near, "{start} {far} {near}");
    let panel = window.get_by_label("Script of the scene").rect();
    assert!(near >= panel.left() && near > 0.0, "the start of a line is beside its number: {near}");
}

#[test]
fn what_is_selected_elsewhere_is_where_the_text_is_scrolled_to_and_the_cursor_selects() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "<camera id=\"clo"));
    assert_eq!(window.state().state.read().scene_editing.things(), ["close".into()]);
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(Some(10))));
    window.run_steps(2);
    assert_eq!(window.state().state.read().scene_editing.action(), Some(10));
}

#[test]
fn a_drag_in_the_timeline_and_typing_are_steps_of_one_history() {
    let mut window = scene(FOXES).window();
    put_cursor(&mut window, place(FOXES, "Two foxes"));
    type_text(&mut window, " x");
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(Some(7))));
    let effect =
        window.state_mut().state.execute(Request::Command(dragonfly::panels::commands::Id::ClipLater));
    if let Some(dragonfly::panels::Effect::Change(change)) = effect {
        window.state_mut().change(change);
    }
    window.run_steps(3);
    assert!(text(&window).contains("begin=\"25f\"") && text(&window).contains("Two foxes x"));
    while window.state().steps().0 > 0 {
        window.state_mut().change(Change::Undo);
    }
    window.run_steps(3);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_megabyte_of_text_is_edited_without_laying_it_out_again_when_nothing_changes() {
    let many = "    <wait dur=\"1\"/>\n".repeat(50_000);
    let large = FOXES.replace("  <par id=\"scene-1\">\n", &format!("  <par id=\"scene-1\">\n{many}"));
    assert!(large.len() > 900_000);
    let mut window = scene(&large).window();
    put_cursor(&mut window, place(&large, "Two foxes"));
    type_text(&mut window, "s");
    assert!(text(&window).contains("Two foxess meet"));
}

/// Returns the number of bytes that a frame of the script panel allocates, for a text with this number of comments, and its length.
fn bytes_of_a_frame(comments: usize) -> (u64, u64) {
    let long = "    <!-- a comment of the script that makes it long -->\n".repeat(comments);
    let text = FOXES.replace("  <cast>", &format!("{long}  <cast>"));
    let (bench, mut panel) = (scene(&text), ScriptPanel::default());
    // Without accessibility, which copies each line.
    let context = egui::Context::default();
    style::install(&context);
    let mut frame = || {
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(600.0, 400.0))),
            ..egui::RawInput::default()
        };
        let draw = |ui: &mut egui::Ui| panel.show(ui, &bench.state.read(), &mut Vec::new());
        let (count, mut output) = count(|| context.run_ui(input, draw));
        // No one draws them.
        output.textures_delta.clear();
        count.bytes
    };
    for _ in 0..4 {
        frame();
    }
    (frame(), text.len() as u64)
}

#[test]
fn a_frame_in_which_nothing_is_typed_copies_no_text() {
    let [(short, length), (long, longer)] = [1_000, 5_000].map(bytes_of_a_frame);
    let more = longer - length;
    // egui copies the text of each field once.
    assert!(long < short + more * 3 / 2, "{short} bytes for a text of {length}, {long} for one of {longer}");
}

#[test]
fn the_key_to_find_opens_a_field_in_the_script_that_goes_from_place_to_place() {
    let mut window = scene(FOXES).window();
    let is_open = |window: &Window| window.query_by_label("Find in the script").is_some();
    put_cursor(&mut window, FOXES.find("<par").expect("the actions"));
    window.key_press_modifiers(Modifiers::COMMAND, Key::F);
    window.run_steps(3);
    assert!(is_open(&window), "while the script has the focus");
    type_text(&mut window, "ANNA");
    let count = FOXES.matches("anna").count();
    // The first place after the cursor.
    let before = FOXES[..FOXES.find("<par").expect("the actions")].matches("anna").count();
    let shows = |window: &Window, at: usize| window.query_by_label(&format!("{at} of {count}")).is_some();
    assert!(shows(&window, before + 1));
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(shows(&window, before + 2));
    window.get_by_label("Previous place").click();
    window.run_steps(3);
    assert!(shows(&window, before + 1));
    assert_eq!(text(&window), FOXES, "nothing is typed into the script");
    window.get_by_label("Find in the script").focus();
    window.run_steps(2);
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(!is_open(&window), "Escape closes it");
    // The cursor is where the place is.
    type_text(&mut window, "x");
    let at = FOXES.match_indices("anna").nth(before).expect("a place").0;
    assert_eq!(text(&window), format!("{}x{}", &FOXES[..at], &FOXES[at..]));
}
