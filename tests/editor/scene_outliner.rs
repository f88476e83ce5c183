//! The list of things: selected, renamed, hidden, added, deleted.

use crate::scene_bench::{FOXES, looked, new_lines, project, scene, text};
use crate::workbench::{Window, press, release, type_into};
use dragonfly::panels::commands::Id;
use dragonfly::panels::file_choice::FileChoice;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use dragonfly_picture::ThroughCamera;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

fn window() -> Window {
    scene(FOXES).window()
}

fn run(window: &mut Window, id: Id) {
    let effect = window.state_mut().state.execute(Request::Command(id));
    if let Some(Effect::Change(change)) = effect {
        window.state_mut().change(change);
    }
    window.run_steps(3);
}

fn things(window: &Window) -> Vec<String> {
    window.state().state.read().scene_editing.things().iter().map(|id| id.to_string()).collect()
}

#[test]
fn a_click_selects_a_thing_and_ctrl_adds_another() {
    let mut window = window();
    window.get_by_label("ben, role").click();
    window.run_steps(2);
    assert_eq!(things(&window), ["ben"]);
    window.get_by_label("wide, camera").click_modifiers(Modifiers::COMMAND);
    window.run_steps(2);
    assert_eq!(things(&window), ["ben", "wide"]);
}

#[test]
fn a_new_name_is_written_wherever_the_script_uses_the_old_one() {
    let mut window = window();
    window.get_by_label("ben, role").click();
    window.run_steps(2);
    window.key_press(Key::F2);
    window.run_steps(2);
    type_into(&mut window, "Name of the thing", "bernard", Key::Enter);
    let new = text(&window);
    assert!(
        !new.contains("\"ben\"") && new.matches("\"bernard\"").count() == FOXES.matches("\"ben\"").count()
    );
    assert_eq!(window.state().steps(), (1, 1));
    assert!(window.query_by_label("bernard, role").is_some());
}

#[test]
fn a_double_click_renames_things_of_every_kind_and_a_button_opens_the_model() {
    for row in ["ben, role", "sun, light"] {
        let mut window = window();
        let at = window.get_by_label(row).rect().left_center() + egui::vec2(40.0, 0.0);
        for _ in 0..2 {
            press(&mut window, at);
            release(&mut window, at);
        }
        window.run_steps(2);
        let renamed = window.state().state.read().scene_editing.renaming().map(str::to_owned);
        assert_eq!(renamed.as_deref(), row.split(',').next());
    }
    let window = window();
    assert!(window.query_by_label("Open the model of ben").is_some());
    assert!(window.query_by_label("Open the model of sun").is_none(), "a light has none");
}

#[test]
fn an_added_thing_is_one_line_and_selected() {
    let mut window = window();
    run(&mut window, Id::AddSceneCamera);
    let line = r#"<camera id="camera" at="0 1.6 6" look="0 1 0" lens="35mm"/>"#;
    assert_eq!(new_lines(FOXES, &text(&window)), [line]);
    assert_eq!(things(&window), ["camera"]);
    run(&mut window, Id::AddMark);
    assert_eq!(things(&window), ["mark"]);
}

#[test]
fn the_rows_stay_in_their_places_while_things_are_added_and_the_search_finds_one_of_few() {
    let mut window = window();
    let anna = |window: &mut Window| {
        let anna = SceneRequest::SelectThings(vec!["anna".into()], Choice::Replace);
        window.state_mut().state.execute(Request::Scene(anna));
        window.run_steps(3);
        window.get_by_label("anna, role").rect().top()
    };
    let before = anna(&mut window);
    for _ in 0..6 {
        run(&mut window, Id::AddMark);
        assert_eq!(anna(&mut window), before);
    }
    let mut window = self::window();
    type_into(&mut window, "Find a thing", "be", Key::Enter);
    assert!(window.query_by_label("ben, role").is_some() && window.query_by_label("anna, role").is_none());
}

#[test]
fn lines_are_listed_while_a_search_finds_no_thing_and_in_a_project_without_things() {
    let lines = r#"<lines version="1"><line id="note" points="0 0 0  1 0 0  2 0 0  3 0 0"/></lines>"#;
    let window = project(r#"<script version="1"/>"#, lines).window();
    assert!(window.query_by_label("note, line").is_some());
}

#[test]
fn a_value_typed_into_the_attributes_is_written_and_a_wrong_one_is_refused() {
    let mut window = window();
    window.get_by_label("wide, camera").click();
    window.run_steps(2);
    type_into(&mut window, "lens", "50mm", Key::Enter);
    let line = r#"<camera id="wide"  at="0 1 5" look="0 0.5 0" lens="50mm"/>"#;
    assert_eq!(new_lines(FOXES, &text(&window)), [line]);
    type_into(&mut window, "lens", "wide", Key::Enter);
    assert_eq!(new_lines(FOXES, &text(&window)), [line], "no focal length");
    type_into(&mut window, "look", "nobody", Key::Enter);
    assert_eq!(new_lines(FOXES, &text(&window)), [line], "nothing is called that");
}

#[test]
fn a_scene_has_its_panels_and_a_model_has_its_own() {
    let window = window();
    for label in ["Scene", "Scene timeline", "Script", "History"] {
        assert!(window.query_all_by_label(label).count() > 0, "{label}");
    }
    for label in ["Curves", "Takes", "Layers"] {
        assert_eq!(window.query_all_by_label(label).count(), 0, "{label}");
    }
    let model = crate::workbench::Workbench::full().window();
    assert_eq!(model.query_all_by_label("Scene timeline").count(), 0);
    assert!(model.query_all_by_label("Curves").count() > 0);
}

#[test]
fn only_the_rows_in_sight_are_drawn_and_a_name_that_is_typed_is_brought_into_sight() {
    let marks: String =
        (0..3_000).map(|mark| format!("    <mark id=\"m{mark}\" at=\"{mark} 0 0\"/>\n")).collect();
    let mut window = scene(&FOXES.replace("  </cast>", &format!("{marks}  </cast>"))).window();
    let shown = |window: &Window| window.query_all_by_label_contains(", mark").count();
    assert!((1..200).contains(&shown(&window)), "{} rows", shown(&window));
    assert!(window.query_by_label("m2500, mark").is_none());
    window.state_mut().state.execute(Request::Scene(SceneRequest::Rename(Some("m2500".into()))));
    window.run_steps(30);
    assert!(window.query_by_label("m2501, mark").is_some(), "the list was scrolled there");
    assert!(shown(&window) < 200);
    // The field has the focus, and its text is selected.
    window.event(egui::Event::Text("goal".to_owned()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    let named: Vec<String> =
        text(&window).lines().filter(|line| line.contains("2500 0 0")).map(str::to_owned).collect();
    assert_eq!(named, ["    <mark id=\"goal\" at=\"2500 0 0\"/>"]);
}

#[test]
fn the_hint_of_a_row_is_shown_while_the_pointer_rests_on_it() {
    let mut window = window();
    for (row, hint) in [("anna, role", "Double-click: rename"), ("sun, light", "Double-click: rename")] {
        window.get_by_label(row).hover();
        window.run_steps(60);
        assert!(window.query_all_by_label_contains(hint).count() == 1, "{row}");
    }
}

#[test]
fn the_menu_of_a_row_hides_frames_and_looks_through_its_thing() {
    let mut window = window();
    window.get_by_label("close, camera").click_secondary();
    window.run_steps(3);
    assert_eq!(things(&window), ["close"]);
    window.get_by_label("Look through it").click();
    window.run_steps(3);
    assert_eq!(*window.state().state.read().through, ThroughCamera::Of("close".into()));
    window.get_by_label("ben, role").click_secondary();
    window.run_steps(3);
    for entry in ["Frame selected", "Hide things", "Lock things", "Drop to the ground"] {
        assert!(window.query_all_by_label_contains(entry).next().is_some(), "{entry}");
    }
}

#[test]
fn a_drag_that_begins_elsewhere_ends_the_field_of_a_name_so_that_undo_is_not_that_of_its_text() {
    let mut window = window();
    window.get_by_label("wide, camera").click();
    window.run_steps(2);
    window.key_press(Key::F2);
    window.run_steps(4);
    assert!(window.state().state.read().scene_editing.renaming().is_some());
    let lanes = window.query_by_label_contains("Lanes of the scene").expect("lanes").rect();
    let at = lanes.center_bottom() - egui::vec2(0.0, 8.0);
    window.event(egui::Event::PointerMoved(at));
    let (button, modifiers) = (egui::PointerButton::Primary, Modifiers::NONE);
    window.event(egui::Event::PointerButton { pos: at, button, pressed: true, modifiers });
    window.run_steps(2);
    assert_eq!(window.state().state.read().scene_editing.renaming(), None, "while the button is held");
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_sound_is_added_by_a_command_and_the_sound_track_of_a_model_is_not_offered() {
    let mut window = window();
    let effect = window.state_mut().state.execute(Request::Command(Id::AddSceneSound));
    assert!(matches!(effect, Some(Effect::Choose(FileChoice::SceneSound, _))), "{effect:?}");
    let effect = window.state_mut().state.execute(Request::AddSound("/scenes/steps.wav".into()));
    let effect = looked(&mut window, effect);
    let Some(Effect::Change(change)) = effect else { panic!("{effect:?}") };
    window.state_mut().change(change);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<sound src="steps.wav"/>"#]);
    let effect = window.state_mut().state.execute(Request::Command(Id::ChooseSound));
    assert_eq!(effect, None, "a scene has its own sounds");
}

#[test]
fn the_names_that_an_attribute_may_have_are_offered_in_a_list() {
    let mut window = window();
    let action = FOXES.find("take=\"Run\"").expect("a run");
    let script =
        window.state().state.read().scene().and_then(|scene| scene.script.clone()).expect("a script");
    let of = |element: &dragonfly_anim::stage::script::ScriptElement| element.range.contains(&action);
    let run = (0..script.actions().len()).rfind(|&at| of(script.element(at))).expect("an action");
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(Some(run))));
    window.run_steps(3);
    let [first, other] = ["take", "repeat"].map(|name| window.get_by_label(name).rect().top());
    let unwritten = window.get_by_label("fade-out").rect().top();
    assert!(first < unwritten && other < unwritten, "what is written comes first");
    window.get_by_label("Choose take").click();
    window.run_steps(3);
    assert!(window.query_by_label("Survey").is_some(), "its takes are listed");
    window.get_all_by_label("Walk").last().expect("a take").click();
    window.run_steps(3);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new, [r#"<play who="anna" take="Walk" begin="-0.5" fade-in="0.5" repeat="3"/>"#]);
}

#[test]
fn what_is_selected_elsewhere_is_brought_into_sight_in_the_list() {
    let mut cast = String::new();
    for number in 0..60 {
        cast += &format!("    <mark id=\"m{number}\" at=\"0 0 {number}\"/>\n");
    }
    let script = FOXES.replace("  </cast>", &format!("{cast}  </cast>"));
    let mut window = scene(&script).window();
    assert!(window.query_by_label("m55, mark").is_none(), "it is below");
    let things = SceneRequest::SelectThings(vec!["m55".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(things));
    window.run_steps(6);
    assert!(window.query_by_label("m55, mark").is_some());
}

#[test]
fn the_button_that_adds_things_has_the_margin_of_the_first_buttons_of_other_panels() {
    let window = window();
    let button = window.get_by_label("Add a thing to the scene").rect();
    let row = window.get_by_label("anna, role").rect();
    assert_eq!(button.left() - row.left(), 8.0, "{button}, {row}");
}
