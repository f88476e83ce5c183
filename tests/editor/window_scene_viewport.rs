//! A scene in the real window: a fox is clicked and dragged in the viewport, the shot is looked through, and everything is undone.

use crate::drag::{Drag, address};
use crate::scene_bench::{FOXES, new_lines};
use crate::screen::key;
use crate::window::alone;
use crate::window_bone_rotation::numbers;
use crate::window_visit::Visit;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec3, Vec2, Vec3};

/// Returns the camera of the window.
pub(crate) fn camera(visit: &mut Visit) -> Camera {
    let [x, y, z, distance, yaw, pitch] = numbers(&visit.shown("camera"));
    Camera { target: Vec3::new(x, y, z), distance, yaw, pitch, ..Camera::default() }
}

/// Returns where the window shows a point.
pub(crate) fn place(visit: &mut Visit, point: DVec3) -> Vec2 {
    let camera = camera(visit);
    let [left, top, width, height] = numbers(&visit.shown("viewport"));
    let view = GizmoView::new(&camera, Vec2::new(width, height));
    view.to_screen(point).expect("in front of the camera").as_vec2() + Vec2::new(left, top)
}

/// Waits until all of the scene is framed, which is when its models were read.
fn framed(visit: &mut Visit) {
    let first = Camera::default().distance;
    visit.until("a framed scene", |visit| {
        let distance = camera(visit).distance;
        (distance > 1.5 && distance != first).then_some(())
    });
}

#[test]
fn a_thing_is_clicked_dragged_and_seen_through_the_shot_and_undo_restores_the_text() {
    let _one = alone();
    let mut visit = Visit::of_scene("scene viewport", FOXES);
    visit.control("Lanes of the scene");
    framed(&mut visit);
    let flank = place(&mut visit, DVec3::new(1.0, 0.4, 0.0));
    visit.screen.click(flank.x as i16, flank.y as i16);
    // The attributes of a role.
    visit.control("facing");
    visit.screen.press(key::of('w'));
    let pivot = place(&mut visit, DVec3::new(1.0, 0.0, 0.0));
    visit.screen.point(pivot.x as i16, pivot.y as i16);
    visit.screen.hold();
    for step in 1..=5 {
        visit.screen.point(pivot.x as i16 + 12 * step, pivot.y as i16);
    }
    visit.screen.release_button();
    visit.until_steps(1, 1);
    visit.screen.press(key::of('0'));
    visit.until("the view of the shot", |visit| {
        (camera(visit).eye().distance(Vec3::new(0.0, 1.0, 5.0)) < 0.01).then_some(())
    });
    visit.screen.keep("shot");
    visit.control_and(key::Z);
    visit.until_steps(0, 1);
    assert_eq!(visit.save(), FOXES.as_bytes(), "everything is undone");
    visit.end();
}

#[test]
fn a_model_that_is_dropped_from_another_program_stands_where_the_pointer_is() {
    let _one = alone();
    let mut visit = Visit::of_scene("scene drop", FOXES);
    visit.control("Lanes of the scene");
    framed(&mut visit);
    let wanted = DVec3::new(0.5, 0.0, 1.0);
    let at = place(&mut visit, wanted).round();
    let mut drag = Drag::new(&visit.screen);
    drag.take_pointer();
    // Into the window, which the window system reports, and on, which it does not.
    visit.screen.point(at.x as i16 - 120, at.y as i16 - 40);
    visit.screen.point(at.x as i16, at.y as i16);
    let file = visit.folder.join("Fox.glb");
    assert!(drag.hold(visit.editor.window, &[address(&file)]), "the window does not take files");
    drag.drop(visit.editor.window);
    visit.until_steps(1, 1);
    // Not before: then the window would get the position after all.
    drag.give_pointer_back();
    let text = String::from_utf8(visit.save()).expect("a text");
    let new = new_lines(FOXES, &text);
    let found = new[0].split("at=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a place");
    let found: Vec<f64> = found.split(' ').map(|number| number.parse().expect("a number")).collect();
    // A pixel of the ground, seen from the side.
    assert!(DVec3::from_slice(&found).distance(wanted) < 0.05, "{new:?}");
    visit.end();
}
