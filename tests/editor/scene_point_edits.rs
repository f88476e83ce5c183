//! Points of paths and lines that are added with the mouse and removed.

use crate::scene_bench::{FOXES, named_text, new_lines, project, scene, text};
use crate::scene_lines::{at, points, send};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent, Modifiers};
use dragonfly::panels::Request;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_anim::stage::StagePath;
use dragonfly_anim::stage::line::{DrawnLines, LineSamples, line_place};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::Key;
use glam::DVec3;

const AISLE: [DVec3; 3] = [DVec3::NEG_X, DVec3::new(0.0, 0.0, 0.6), DVec3::X];

fn select(window: &mut Window, id: &str) {
    let request = SceneRequest::SelectThings(vec![id.into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(request));
    window.run_steps(2);
}

fn click(window: &mut Window, place: DVec3, ctrl: bool) {
    let place = at(window, place);
    send(window, InputEvent::Modifiers(Modifiers { ctrl, ..Modifiers::default() }));
    send(window, InputEvent::MouseMove(place));
    send(window, InputEvent::MouseDown(Button::Left));
    send(window, InputEvent::MouseUp(Button::Left));
    send(window, InputEvent::Modifiers(Modifiers::default()));
}

fn delete(window: &mut Window) {
    window.key_press(Key::Delete);
    window.run_steps(3);
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
}

#[test]
fn ctrl_and_a_click_on_the_selected_path_add_a_point_there_and_delete_removes_it_again() {
    let mut window = scene(FOXES).window();
    let path = StagePath::new(&AISLE, true);
    for (share, index) in [(0.25, 1), (0.85, 2)] {
        let place = path.at(path.length() * share).position;
        click(&mut window, place, true);
        assert_eq!(text(&window), FOXES, "the path is not selected");
        select(&mut window, "aisle");
        click(&mut window, place, true);
        let new = new_lines(FOXES, &text(&window));
        assert_eq!((new.len(), window.state().steps()), (1, (1, 1)), "{new:?}");
        let found = points(&new[0]);
        assert_eq!(found.len(), 4, "{new:?}");
        assert!(found[index].distance(place) < 0.01, "{found:?} {place}");
        let others: Vec<DVec3> = found.iter().copied().filter(|point| *point != found[index]).collect();
        assert_eq!(others, AISLE);
        // The new point is the selected one.
        delete(&mut window);
        assert_eq!((text(&window).as_str(), window.state().steps()), (FOXES, (2, 2)));
        for _ in 0..2 {
            window.state_mut().change(Change::Undo);
        }
        window.run_steps(2);
        assert_eq!(text(&window), FOXES);
        window.state_mut().state.execute(Request::Scene(SceneRequest::SelectThings(vec![], Choice::Replace)));
        window.run_steps(2);
    }
}

fn is_any_point_selected(window: &Window) -> bool {
    let read = window.state().state.read();
    let lines = read.scene_editing.lines();
    lines.points().iter().any(|point| lines.is_point_selected(point))
}

#[test]
fn undo_of_a_point_that_was_added_selects_no_other_point_in_its_place() {
    let mut window = scene(FOXES).window();
    select(&mut window, "aisle");
    let path = StagePath::new(&AISLE, true);
    click(&mut window, path.at(path.length() * 0.25).position, true);
    window.run_steps(2);
    assert!(is_any_point_selected(&window), "the new point");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert!(!is_any_point_selected(&window), "the second point has its number");
    click(&mut window, AISLE[1], false);
    window.run_steps(2);
    assert!(is_any_point_selected(&window));
    window.state_mut().change(Change::Redo);
    window.run_steps(2);
    assert!(!is_any_point_selected(&window), "the new point has its number");
}

#[test]
fn delete_removes_the_point_that_was_clicked_but_leaves_two_and_the_path_after_it_is_selected_again() {
    let mut window = scene(FOXES).window();
    select(&mut window, "aisle");
    click(&mut window, AISLE[1], false);
    assert_eq!(text(&window), FOXES, "a click changes nothing");
    delete(&mut window);
    let two = text(&window);
    let new = new_lines(FOXES, &two);
    assert!(new.len() == 1 && new[0].contains("points=\"-1 0 0  1 0 0\" curve"), "{new:?}");
    click(&mut window, AISLE[2], false);
    delete(&mut window);
    assert_eq!(text(&window), two);
    assert!(said(&window, "aisle has only two points"));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
    // The first point, with what follows it moved up.
    click(&mut window, AISLE[0], false);
    delete(&mut window);
    assert!(text(&window).contains("points=\"0 0 0.6  1 0 0\" curve"));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    click(&mut window, AISLE[1], false);
    select(&mut window, "aisle");
    delete(&mut window);
    assert!(!text(&window).contains("<path"), "the path itself was selected last");
}

#[test]
fn a_locked_path_gets_no_point_and_a_click_beside_the_path_adds_none() {
    let mut window = scene(FOXES).window();
    select(&mut window, "aisle");
    click(&mut window, DVec3::new(0.0, 0.0, 1.4), true);
    assert_eq!(text(&window), FOXES);
    window.state_mut().state.execute(Request::Scene(SceneRequest::Lock(vec!["aisle".into()], true)));
    window.run_steps(2);
    let path = StagePath::new(&AISLE, true);
    click(&mut window, path.at(path.length() * 0.25).position, true);
    assert_eq!(text(&window), FOXES);
}

/// A line of two curves.
const LINES: &str = r#"<lines version="1">
  <line id="way" points="-1 0 0  -0.6 0 0.5  -0.4 0 0.5  0 0 0  0.4 0 -0.5  0.6 0 -0.5  1 0 0"/>
</lines>
"#;

#[test]
fn a_point_added_on_a_drawn_line_leaves_its_form_and_one_removed_joins_the_curves_beside_it() {
    let script = FOXES.replace("points=\"-1 0 0  0 0 0.6  1 0 0\" curve=\"smooth\"", "line=\"way\"");
    let mut window = project(&script, LINES).window();
    select(&mut window, "aisle");
    let control = |window: &Window| {
        let text = named_text(window, "scene.lines.xml");
        DrawnLines::read(text).unwrap().list()[0].points.clone()
    };
    let before = control(&window);
    let place = line_place(&before, 1, 0.4).unwrap();
    click(&mut window, place, true);
    let more = control(&window);
    assert_eq!((more.len(), window.state().steps()), (10, (1, 1)));
    assert!(more[6].distance(place) < 0.02, "{more:?} {place}");
    let [old, new] = [&before, &more].map(|control| LineSamples::new(control, false));
    assert!((old.length() - new.length()).abs() < 1e-3);
    for step in 0..=50 {
        let [old, new] = [&old, &new].map(|line| line.at(line.length() * f64::from(step) / 50.0).unwrap());
        assert!(old.distance(new) < 2e-3, "{old} {new}");
    }
    // The point that both curves had before.
    click(&mut window, DVec3::ZERO, false);
    delete(&mut window);
    let joined = control(&window);
    assert_eq!(joined.len(), 7);
    assert_eq!([joined[0], joined[1], joined[3]], [before[0], before[1], more[6]]);
    for point in [joined[3], joined[0]] {
        click(&mut window, point, false);
        delete(&mut window);
    }
    assert_eq!(control(&window).len(), 4);
    assert!(said(&window, "way has only two points"));
}
