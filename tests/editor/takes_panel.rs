//! The list of takes: creating, renaming, splitting, reordering and deleting.

use crate::nasty;
use crate::workbench::{Window, Workbench, button, drag, move_to, press, type_into};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::KeysRequest;
use dragonfly_kit::document::fixture;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT, Queryable};

fn names(window: &Window) -> Vec<String> {
    window.state().state.read().view.unwrap().takes.iter().map(|take| take.name.clone()).collect()
}

fn shown(window: &Window) -> Option<usize> {
    window.state().state.read().playback.take
}

fn give(window: &mut Window, id: Id) {
    let request = Request::Command(id);
    if let Some(dragonfly::panels::Effect::Change(change)) = window.state_mut().state.execute(request) {
        window.state_mut().change(change);
    }
    window.run_steps(3);
}

#[test]
fn takes_are_made_copied_and_deleted_but_the_last_one_stays() {
    let mut window = Workbench::full().window();
    window.get_by_label("New take").click();
    window.run_steps(3);
    assert_eq!(
        (names(&window), shown(&window)),
        (vec!["Survey".into(), "Walk".into(), "Run".into(), "New take".into()], Some(3))
    );
    window.get_by_label("Walk").click();
    window.run_steps(2);
    for wanted in ["Walk copy", "Walk copy 2"] {
        window.get_by_label("Duplicate take").click();
        window.run_steps(3);
        assert_eq!(names(&window)[shown(&window).unwrap()], wanted, "the copy is shown");
    }
    for left in (0..5).rev() {
        window.get_by_label("Delete take").click();
        window.run_steps(3);
        assert_eq!(names(&window).len(), left + 1);
        assert!(shown(&window).is_some(), "a neighbor is shown");
    }
    assert!(window.get_by_label("Delete take").accesskit_node().is_disabled());
    give(&mut window, Id::DeleteTake);
    assert_eq!(names(&window).len(), 1);
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn a_command_shows_the_fields_for_start_and_length() {
    let mut window = Workbench::full().window();
    assert!(window.query_by_label("Length").is_none());
    give(&mut window, Id::RetimeTake);
    assert!(window.query_by_label("Length").is_some());
    type_into(&mut window, "Length", "2", Key::Enter);
    let view = window.state().state.read().view.cloned().unwrap();
    assert_eq!(view.takes[0].length, 2.0);
}

#[test]
fn start_and_length_can_also_be_given_in_frames() {
    let mut window = Workbench::full().window();
    window.state_mut().state.execute(Request::FrameRate(24));
    give(&mut window, Id::RetimeTake);
    type_into(&mut window, "Length in frames", "48", Key::Enter);
    let length = |window: &Window| window.state().state.read().view.unwrap().takes[0].length;
    assert_eq!(length(&window), 2.0);
    type_into(&mut window, "Start in frames", "12", Key::Enter);
    let take = &window.state().state.read().view.unwrap().takes[0];
    assert_eq!((take.start, take.length), (0.5, 2.0));
    let shown = |window: &Window, field: &str| window.get_by_label(field).accesskit_node().numeric_value();
    assert_eq!(shown(&window, "Length"), Some(2.0), "both show the same");
    assert_eq!(shown(&window, "Start in frames"), Some(12.0));
    // The last frame, although in single precision its time is slightly after the end.
    type_into(&mut window, "Length", "1/3", Key::Enter);
    type_into(&mut window, "To in frames", "20", Key::Enter);
    assert_eq!(window.state().refused, [""; 0]);
    assert!(window.get_by_label("To in frames").accesskit_node().data().invalid().is_none());
}

#[test]
fn many_takes_have_a_search_field_and_the_shown_take_is_visible() {
    let names: Vec<String> =
        (0..40).map(|index| format!("Rig|{}_{index:02}", ["Walk", "Run"][index % 2])).collect();
    let takes: Vec<(&str, f32, usize)> = names.iter().map(|name| (name.as_str(), 1.0, 3)).collect();
    let view = fixture::view("model", fixture::skeleton(3), &takes);
    let mut window = Workbench::new(Some(view)).window();
    let search = |window: &mut Window, text: &str| {
        window.get_by_label("Find a take").focus();
        window.run_steps(1);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.event(egui::Event::Text(text.to_owned()));
        window.run_steps(3);
    };
    search(&mut window, "run_2");
    assert!(window.query_by_label("Rig|Run_21").is_some() && window.query_by_label("Rig|Run_29").is_some());
    assert!(window.query_by_label("Rig|Run_01").is_none() && window.query_by_label("Rest pose").is_none());
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert_eq!(shown(&window), Some(21), "Enter shows the first that is found");
    search(&mut window, "nobody");
    assert!(window.query_by_label("No take matches the search").is_some());
    window.get_by_label("Clear search").click();
    window.run_steps(3);
    window.get_by_label("Rig|Run_21");
    window.state_mut().state.execute(Request::ShowTake(Some(38)));
    window.run_steps(3);
    let list = window.get_by_label("Rig|Walk_38").rect();
    assert!(
        window.query_by_label("Rest pose").is_none() && list.bottom() < 1000.0,
        "it is scrolled to: {list:?}"
    );
    // A name can be edited in the list while the list is filtered by a search.
    search(&mut window, "run_03");
    give(&mut window, Id::RenameTake);
    assert!(window.query_by_label("Name of the take").is_some());
}

#[test]
fn few_takes_have_no_search_field() {
    let window = Workbench::full().window();
    assert!(window.query_by_label("Find a take").is_none());
}

#[test]
fn a_take_is_renamed_in_the_list() {
    let mut window = Workbench::full().window();
    window.get_by_label("Walk").click();
    window.run_steps(2);
    let rename = |window: &mut Window, text: &str, key: Key| {
        window.key_press(Key::F2);
        window.run_steps(3);
        if text.is_empty() {
            window.key_press(Key::Delete);
        } else {
            window.event(egui::Event::Text(text.to_owned()));
        }
        window.run_steps(1);
        window.key_press(key);
        window.run_steps(3);
    };
    rename(&mut window, "Stroll", Key::Enter);
    assert_eq!(names(&window)[1], "Stroll");
    rename(&mut window, "No", Key::Escape);
    assert_eq!(names(&window)[1], "Stroll", "Escape cancels it");
    assert!(window.query_by_label("Name of the take").is_none());
    rename(&mut window, "", Key::Enter);
    assert_eq!(names(&window)[1], "Stroll");
    assert!(window.query_by_label("Name of the take").is_some(), "an empty name is refused where it stands");
    assert!(window.query_by_label("A take needs a name").is_some());
    window.event(egui::Event::Text("Run".to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(
        window.query_by_label("Another take has the name \"Run\"").is_some(),
        "and so is one that another has"
    );
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(window.query_by_label("Name of the take").is_none());
    assert_eq!(window.state().steps(), (1, 1));
    let row = window.get_by_label("Run").rect().center();
    window.event(egui::Event::PointerMoved(row));
    // Both clicks in one frame, because a frame of a test takes longer than a double click may.
    for pressed in [true, false, true, false] {
        let (button, modifiers) = (egui::PointerButton::Primary, Modifiers::NONE);
        window.event(egui::Event::PointerButton { pos: row, button, pressed, modifiers });
    }
    window.run_steps(3);
    assert!(window.query_by_label("Name of the take").is_some(), "a double click renames");
    window.event(egui::Event::Text("Gallop".to_owned()));
    window.run_steps(2);
    window.get_by_label("Stroll").click();
    window.run_steps(3);
    assert_eq!(names(&window)[2], "Gallop", "a click elsewhere accepts");
}

#[test]
fn any_text_that_is_not_blank_becomes_the_name_of_a_take() {
    let mut window = Workbench::full().window_of_any_text();
    window.get_by_label("Walk").click();
    window.run_steps(2);
    for text in nasty::texts() {
        window.key_press(Key::F2);
        window.run_steps(3);
        window.event(egui::Event::Text(text.clone()));
        window.run_steps(2);
        window.key_press(Key::Enter);
        window.run_steps(3);
        let kept = names(&window)[1].clone();
        let wanted: String =
            text.chars().filter(|letter| !matches!(letter, '\n' | '\r')).take(10_000).collect();
        if wanted.trim().is_empty() {
            window.key_press(Key::Escape);
            window.run_steps(2);
        } else {
            assert!(window.query_by_label("Name of the take").is_none());
            let plain =
                |text: &str| text.chars().filter(|letter| !letter.is_whitespace()).collect::<String>();
            assert_eq!(plain(&kept), plain(&wanted));
        }
        window.state_mut().change(dragonfly_document::Change::GoTo(0));
        window.run_steps(2);
        assert_eq!(names(&window)[1], "Walk");
    }
}

#[test]
fn a_take_that_is_dragged_to_another_position_stays_shown() {
    let mut window = Workbench::full().window();
    window.get_by_label("Run").click();
    window.run_steps(2);
    drag(&mut window, "Run", vec2(0.0, -50.0), Modifiers::NONE);
    assert_eq!(names(&window), ["Run", "Survey", "Walk"]);
    assert_eq!(shown(&window), Some(0));
    let from = window.get_by_label("Survey").rect().center();
    press(&mut window, from);
    move_to(&mut window, from + vec2(0.0, 20.0), Modifiers::NONE);
    move_to(&mut window, from + vec2(0.0, 60.0), Modifiers::NONE);
    window.key_press(Key::Escape);
    window.run_steps(2);
    button(&mut window, from + vec2(0.0, 60.0), false);
    window.run_steps(2);
    assert_eq!(names(&window), ["Run", "Survey", "Walk"], "Escape cancels it");
    give(&mut window, Id::MoveTakeDown);
    assert_eq!(
        (names(&window), shown(&window)),
        (vec!["Survey".into(), "Run".into(), "Walk".into()], Some(1))
    );
    give(&mut window, Id::MoveTakeUp);
    assert_eq!(shown(&window), Some(0));
    window.state_mut().change(dragonfly_document::Change::Undo);
    window.run_steps(2);
    assert_eq!(shown(&window), Some(1), "undone, it is still the same take");
}

#[test]
fn a_take_is_split_reversed_and_trimmed() {
    let mut window = Workbench::full().window();
    window.state_mut().state.execute(Request::Seek(1.0));
    window.run_steps(2);
    window.get_by_label("Split take here").click();
    window.run_steps(3);
    assert_eq!(names(&window), ["Survey", "Survey 2", "Walk", "Run"]);
    assert_eq!(shown(&window), Some(0));
    let takes = window.state().state.read().view.unwrap().takes.clone();
    assert!((takes[0].length - 1.0).abs() < 1e-5 && (takes[1].length - 2.417).abs() < 1e-5);
    let first = takes[0].tracks[3].rotation.values[0];
    window.get_by_label("Reverse take").click();
    window.run_steps(3);
    let last = window.state().state.read().view.unwrap().takes[0].tracks[3].rotation.values.last().copied();
    assert_eq!(last, Some(first));
    window.get_by_label("Start and length").click();
    window.run_steps(3);
    assert!(window.get_by_label("Trim").accesskit_node().is_disabled(), "all of it lies between");
    type_into(&mut window, "From", "0.25", Key::Enter);
    type_into(&mut window, "To", "3/4", Key::Enter);
    window.get_by_label("Trim").click();
    window.run_steps(3);
    let take = window.state().state.read().take().unwrap();
    assert!(take.start == 0.0 && (take.length - 0.5).abs() < 1e-6, "{} {}", take.start, take.length);
    type_into(&mut window, "Start", "1/2", Key::Enter);
    type_into(&mut window, "Length", "2", Key::Enter);
    let take = window.state().state.read().take().unwrap();
    assert!(take.start == 0.5 && (take.length - 2.0).abs() < 1e-5);
    let steps = window.state().steps();
    drag(&mut window, "Length", vec2(50.0, 0.0), Modifiers::NONE);
    assert!((window.state().state.read().take().unwrap().length - 2.5).abs() < 1e-3);
    assert_eq!(window.state().steps(), (steps.0 + 1, steps.1 + 1), "a drag is one step");
    type_into(&mut window, "Length", "-1", Key::Enter);
    assert!((window.state().state.read().take().unwrap().length - 2.5).abs() < 1e-3);
    assert_eq!(window.state().refused, [""; 0], "impossible edits are not even requested");
}

#[test]
fn the_take_list_is_shown_even_for_a_model_without_takes() {
    let empty = Workbench::new(Some(fixture::empty())).window();
    assert!(empty.query_by_label("Rest pose").is_some());
    let nothing = Workbench::new(None).window();
    assert!(nothing.query_by_label("Rest pose").is_none());
    let mut still = Workbench::new(Some(fixture::view("Still", fixture::skeleton(2), &[]))).window();
    still.get_by_label("New take").click();
    still.run_steps(3);
    assert_eq!((names(&still), shown(&still)), (vec!["New take".to_owned()], Some(0)));
}

#[test]
fn trimming_keeps_the_play_range_while_playing_and_while_paused() {
    for playing in [false, true] {
        let mut window = Workbench::full().window();
        if playing {
            window.state_mut().state.execute(Request::Command(Id::PlayPause));
        }
        let bounds = |window: &Window| {
            let (start, length) = window.state().state.read().take_bounds();
            [start, start + length]
        };
        let whole = bounds(&window);
        give(&mut window, Id::TrimTake);
        assert_eq!(bounds(&window), whole, "no range is set");
        assert!(window.state().state.read().status.last().unwrap().text.contains("play range"));
        let range = KeysRequest::Range(Some([0.5, 1.25]));
        window.state_mut().state.execute(Request::Timeline(range));
        give(&mut window, Id::TrimTake);
        // The rest plays from the start of the take.
        assert_eq!(bounds(&window), [0.0, 0.75], "playing: {playing}");
        assert_eq!(window.state().state.read().keys.range(), None);
    }
}

#[test]
fn the_first_of_the_takes_that_files_brought_is_shown() {
    use dragonfly_document::Change;
    use dragonfly_document::edit::{AddTake, AddTakes, Edit};
    let mut window = Workbench::full().window();
    let walk = window.state().state.read().view.unwrap().takes[1].clone();
    let brought = ["Jump", "Fall"].map(|name| AddTake::of(name.to_owned(), &walk));
    let edit = Edit::AddTakes(AddTakes { takes: brought.to_vec() });
    window.state_mut().change(Change::Edit(edit, None));
    window.run_steps(3);
    assert_eq!(shown(&window).map(|take| names(&window)[take].clone()).as_deref(), Some("Jump"));
    window.state_mut().change(Change::Undo);
    window.run_steps(3);
    assert_eq!(shown(&window), Some(2), "a neighbor of the takes that are gone");
    window.state_mut().change(Change::Edit(Edit::AddTake(AddTake::of("Turn".to_owned(), &walk)), None));
    window.run_steps(3);
    assert_eq!(shown(&window), Some(3));
}
