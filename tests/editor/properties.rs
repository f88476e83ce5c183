//! Numbers of the selected bones are dragged and typed, and the pose becomes what they say.

use crate::workbench::{Window, Workbench, drag, move_to, press, release, type_into};
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use glam::{Quat, Vec3};

/// Bone 3 at a key of the first take.
fn window() -> Window {
    let mut bench = Workbench::full();
    bench.state.select(Some(3));
    bench.window()
}

#[test]
fn a_typed_number_is_the_pose() {
    let mut window = window();
    let before = window.state().pose(3);
    type_into(&mut window, "Translation result Y", "1/4 + 10cm", Key::Enter);
    let pose = window.state().pose(3);
    assert_eq!(pose.translation, Vec3 { y: 0.35, ..before.translation });
    assert_eq!(window.state().steps(), (1, 1));
    type_into(&mut window, "Scale change X", "200%", Key::Tab);
    assert_eq!(window.state().pose(3).scale, Vec3::new(2.0, 1.0, 1.0));
    type_into(&mut window, "Rotation change X", "pi/4 rad", Key::Enter);
    let turned = Quat::from_rotation_x(45_f32.to_radians()) * before.rotation;
    assert!(window.state().pose(3).rotation.angle_between(turned) < 1e-3);
    assert_eq!(window.state().steps(), (3, 3));
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn enter_and_tab_go_on_to_the_next_number() {
    let mut window = window();
    window.get_by_label("Translation result X").click();
    window.run_steps(2);
    for (text, key) in [("1", Key::Enter), ("2", Key::Tab), ("3", Key::Enter)] {
        window.event(egui::Event::Text(text.to_owned()));
        window.run_steps(1);
        window.key_press(key);
        window.run_steps(1);
    }
    assert_eq!(window.state().pose(3).translation, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(window.state().steps(), (3, 3));
}

#[test]
fn a_drag_is_one_step() {
    let mut window = window();
    let before = window.state().pose(3);
    drag(&mut window, "Translation change X", vec2(40.0, 0.0), Modifiers::NONE);
    let after = window.state().pose(3);
    assert!(after.translation.x > before.translation.x);
    assert_eq!(after.translation.y, before.translation.y);
    assert_eq!(window.state().steps(), (1, 1));
    assert!(window.state().changes.len() > 2, "it was seen on the way");
    let from = window.get_by_label("Rotation result Z").rect().center();
    press(&mut window, from);
    move_to(&mut window, from + vec2(30.0, 0.0), Modifiers::NONE);
    assert!(window.state().pose(3).rotation != after.rotation);
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert_eq!(window.state().pose(3), after, "Escape takes the drag back");
    assert_eq!(window.state().state.selected(), Some(3), "and nothing else");
    move_to(&mut window, from + vec2(60.0, 0.0), Modifiers::NONE);
    release(&mut window, from + vec2(60.0, 0.0));
    assert_eq!(window.state().pose(3), after);
    assert_eq!(window.state().steps(), (1, 1));
}
