//! A scene in the real window: a clip is dragged, the script is typed in, a camera is cut to, everything is undone and redone, and the
//! saved file has the same bytes when it is opened again.

use crate::scene_bench::{FOXES, scene};
use crate::screen::{key, pass};
use crate::window::{SOON, alone};
use crate::window_visit::Visit;
use dragonfly::panels::keys::TimeScale;
use dragonfly::panels::scene::timeline::SceneLaneLayout;
use egui::{Rect, pos2, vec2};

/// Returns the rectangle of a control.
fn place(visit: &mut Visit, name: &str) -> Rect {
    let control = visit.control(name);
    let [x, y, width, height] = [0, 1, 2, 3].map(|at| control["place"][at].as_f64().expect("a place") as f32);
    Rect::from_min_size(pos2(x, y), vec2(width, height))
}

#[test]
fn a_scene_is_dragged_typed_cut_undone_redone_saved_and_opened_with_the_same_bytes() {
    let _one = alone();
    let mut visit = Visit::of_scene("scene", FOXES);
    let canvas = place(&mut visit, "Lanes of the scene");
    visit.until_steps(0, 0);

    // The walk of the second fox, half a second later.
    let bench = scene(FOXES);
    let read = bench.state.read();
    let lanes = read.scene_editing.lanes();
    let layout = SceneLaneLayout::of(lanes);
    let scale = TimeScale {
        left: canvas.left() + 16.0,
        width: canvas.width() - 32.0,
        window: read.scene_editing.window(),
    };
    let (index, bar) = lanes
        .list
        .iter()
        .enumerate()
        .find_map(|(index, lane)| Some((index, lane.bars.iter().find(|bar| bar.action == 7)?)))
        .expect("the walk");
    let from = layout.bar(index, bar, canvas.top(), &scale).center();
    let by = (0.5 * scale.per_second()) as f32;
    visit.screen.point(from.x as i16, from.y as i16);
    pass(visit.screen.pace);
    visit.screen.hold();
    for step in 1..=12 {
        visit.screen.point((from.x + by * step as f32 / 12.0) as i16, from.y as i16);
        pass(visit.screen.pace);
    }
    visit.until_steps(1, 1);
    visit.screen.release_button();

    // A word more in the comment of the third line.
    // The text is scrolled to the action, so its upper end may be out of sight.
    let script = place(&mut visit, "Script of the scene");
    visit.screen.click((script.left() + 80.0) as i16, canvas.center().y as i16);
    visit.control_and(key::HOME);
    for key in [key::DOWN, key::DOWN, key::END, key::LEFT, key::LEFT, key::LEFT, key::LEFT] {
        visit.screen.press(key);
    }
    visit.screen.type_text("12");
    visit.until_steps(2, 2);

    // The other camera at the start.
    visit.click_on("Cut to the next camera here");
    visit.until_steps(3, 3);

    for done in (0..3).rev() {
        visit.control_and(key::Z);
        visit.until_steps(done, 3);
    }
    assert_eq!(visit.save(), FOXES.as_bytes(), "everything is undone");
    for done in 1..=3 {
        visit.control_and(key::Y);
        visit.until_steps(done, 3);
    }
    let saved = String::from_utf8(visit.save()).unwrap();
    let expected = FOXES
        .replace("take=\"Walk\" begin=\"1\"", "take=\"Walk\" begin=\"1.5\"")
        .replace("Two foxes meet. -->", "Two foxes meet.12 -->")
        .replace("<shot who=\"wide\" begin=\"0\"/>", "<shot who=\"close\" begin=\"0\"/>");
    assert_eq!(saved, expected);

    visit.screen.close(visit.editor.window);
    assert_eq!(visit.editor.ends(SOON).code(), Some(0), "{}", visit.editor.log());
    visit.again(Some("scene-again"));
    place(&mut visit, "Lanes of the scene");
    // The history is the one before.
    visit.until_steps(3, 3);
    assert_eq!(std::fs::read_to_string(&visit.file).unwrap(), saved);
    visit.end();
}
