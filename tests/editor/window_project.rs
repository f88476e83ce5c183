//! A project in the real window, from an empty scene on: models are dropped, placed and given takes, a path is drawn, cameras are cut, the script is
//! typed in; everything is undone, redone, saved, and opened again with the same bytes in every file.

use crate::drag::{Drag, address};
use crate::screen::{key, pass};
use crate::window::{SOON, alone};
use crate::window_scene_viewport::{camera, place};
use crate::window_visit::Visit;
use dragonfly_kit::folder::data;
use glam::DVec3;
use std::collections::BTreeMap;

const PROJECT: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<project version="1" fps="24" size="1280x720">
  <lines src="foxes.lines.xml"/>
  <script id="main" src="foxes.xml"/>
</project>
"#;

const SCRIPT: &str = r#"<script version="1">
  <!-- Two foxes -->
  <cast>
    <camera id="wide" at="0 1 5" look="0 0.5 0"/>
    <camera id="close" at="-2 0.6 2" look="0 0.5 0" lens="85mm"/>
  </cast>
  <par>
    <shot who="wide" begin="0"/>
    <title text="The End" begin="6" dur="1"/>
  </par>
</script>
"#;

const LINES: &str = "<lines version=\"1\">\n</lines>\n";

const NAMES: [&str; 3] = ["foxes.meproj", "foxes.xml", "foxes.lines.xml"];

/// Returns the texts of the files.
fn texts(visit: &Visit) -> BTreeMap<&'static str, String> {
    NAMES.map(|name| (name, std::fs::read_to_string(visit.folder.join(name)).expect("a text"))).into()
}

/// Returns the middle of a control, pixels.
fn middle(visit: &mut Visit, name: &str) -> [i16; 2] {
    let control = visit.control(name);
    let [x, y, width, height] = [0, 1, 2, 3].map(|at| control["place"][at].as_f64().expect("a place"));
    [(x + width / 2.0) as i16, (y + height / 2.0) as i16]
}

/// Drags from one place to another.
fn drag(visit: &mut Visit, from: [i16; 2], to: [i16; 2]) {
    visit.screen.point(from[0], from[1]);
    pass(visit.screen.pace);
    visit.screen.hold();
    for step in 1..=10_i32 {
        let at = |axis: usize| {
            (i32::from(from[axis]) + (i32::from(to[axis]) - i32::from(from[axis])) * step / 10) as i16
        };
        visit.screen.point(at(0), at(1));
        pass(visit.screen.pace);
    }
    visit.screen.release_button();
}

/// Drops the model where a place of the scene is seen.
fn drop_model(visit: &mut Visit, at: DVec3) {
    let at = place(visit, at).round();
    let file = visit.folder.join("figure.glb");
    let mut hand = Drag::new(&visit.screen);
    hand.take_pointer();
    visit.screen.point(at.x as i16 - 120, at.y as i16 - 40);
    visit.screen.point(at.x as i16, at.y as i16);
    assert!(hand.hold(visit.editor.window, &[address(&file)]), "the window does not take files");
    hand.drop(visit.editor.window);
    let steps: usize = visit.shown("steps").parse().expect("a number");
    visit.until_steps(steps + 1, steps + 1);
    hand.give_pointer_back();
}

#[test]
fn a_scene_is_made_from_nothing_in_the_window_and_every_file_of_its_project_is_the_same_when_it_is_opened_again()
 {
    let _one = alone();
    let files = [(NAMES[0], PROJECT), (NAMES[1], SCRIPT), (NAMES[2], LINES)];
    let mut visit = Visit::of_project("project visit", &files);
    std::fs::copy(data("collection/kenney_character_nodes.glb"), visit.folder.join("figure.glb"))
        .expect("a copy");
    visit.control("Lanes of the scene");
    visit.until_steps(0, 0);
    let before = texts(&visit);

    // Two figures.
    visit.until("a camera", |visit| (camera(visit).distance > 0.1).then_some(()));
    drop_model(&mut visit, DVec3::new(-1.0, 0.0, 0.0));
    drop_model(&mut visit, DVec3::new(1.0, 0.0, 0.2));
    let mut steps = 2;

    // The second one is placed with the gizmo.
    visit.screen.press(key::of('w'));
    visit.click_on("figure-2, role");
    visit.control("facing");
    let pivot = place(&mut visit, DVec3::new(1.0, 0.0, 0.2)).round();
    let from = [pivot.x as i16, pivot.y as i16];
    drag(&mut visit, from, [from[0] + 40, from[1]]);
    steps += 1;
    visit.until_steps(steps, steps);

    // A take is dragged onto its lane.
    let (take, lane) = (middle(&mut visit, "Take static"), middle(&mut visit, "Lane of figure-2"));
    let canvas = middle(&mut visit, "Lanes of the scene");
    drag(&mut visit, take, [canvas[0] - 100, lane[1]]);
    steps += 1;
    visit.until_steps(steps, steps);

    // A path on the ground.
    visit.screen.press_with(key::SHIFT, key::of('n'));
    let points = [DVec3::new(-0.6, 0.0, 0.6), DVec3::new(0.2, 0.0, 0.9)]
        .map(|point| place(&mut visit, point).round())
        .map(|at| [at.x as i16, at.y as i16]);
    drag(&mut visit, points[0], points[1]);
    steps += 1;
    visit.until_steps(steps, steps);
    visit.screen.press(key::ESCAPE);

    // The other camera.
    visit.click_on("Cut to the next camera here");
    steps += 1;
    visit.until_steps(steps, steps);
    visit.screen.keep("scene made from nothing");

    // The comment of the second line.
    let script = visit.control("Script of the scene");
    let [x, y] = [0, 1].map(|at| script["place"][at].as_f64().expect("a place"));
    visit.screen.click((x + 80.0) as i16, (y.max(100.0) + 40.0).max(f64::from(canvas[1])) as i16);
    visit.control_and(key::HOME);
    for key in [key::DOWN, key::END, key::LEFT, key::LEFT, key::LEFT, key::LEFT] {
        visit.screen.press(key);
    }
    visit.screen.type_text("12");
    steps += 1;
    visit.until_steps(steps, steps);

    for done in (0..steps).rev() {
        visit.control_and(key::Z);
        visit.until_steps(done, steps);
    }
    visit.save();
    assert_eq!(texts(&visit), before, "everything is undone");
    for done in 1..=steps {
        visit.control_and(key::Y);
        visit.until_steps(done, steps);
    }
    visit.save();
    let made = texts(&visit);
    let text = &made["foxes.xml"];
    assert_eq!(text.matches("<role ").count(), 2, "{text}");
    for part in ["take=\"static\"", "<path id=\"path\"", "<shot who=\"close\"", "<!-- Two foxes12 -->"] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    assert_eq!(made["foxes.lines.xml"], LINES);

    visit.screen.close(visit.editor.window);
    assert_eq!(visit.editor.ends(SOON).code(), Some(0), "{}", visit.editor.log());
    visit.again(Some("project-again"));
    visit.control("Lanes of the scene");
    visit.until_steps(steps, steps);
    assert_eq!(texts(&visit), made);
    visit.end();
}
