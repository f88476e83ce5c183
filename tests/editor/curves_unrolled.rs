//! The angles of a rotation stay where they are while keys are dragged, and both panels show the same ones.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::properties::PropertiesLook;
use dragonfly_anim::joint::EulerOrder;
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, PoseAt, SetPoses, TakeRef};
use egui::{Pos2, Shape, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{EulerRot, Quat};

/// Angles of a key of bone 3, degrees: a little more about any axis, and the other set of angles for the same rotation
/// is nearer to zero.
fn angles(key: usize) -> [f32; 3] {
    [86.0 + 0.1 * key as f32, 74.0, 104.0]
}

/// Returns a window in which bone 3 has the rotations of [`angles`].
fn animator() -> Animator {
    let mut animator = Animator::with_bone(3);
    let at = (0..41).map(|key| {
        let [x, y, z] = angles(key).map(f32::to_radians);
        let rotation = Some(Quat::from_euler(EulerRot::XYZ, x, y, z).to_array());
        let pose = BonePose { bone: BoneRef::Index(3), translation: None, rotation, scale: None };
        PoseAt { time: animator.key(key), poses: vec![pose] }
    });
    let edit = Edit::SetPoses(SetPoses { take: TakeRef::Index(0), at: at.collect(), unstep: true });
    animator.request(Request::Change(Change::Edit(edit, None)));
    animator.steps(4);
    animator
}

/// Returns the height of a value in the curves: all values of the bone fit the panel.
fn height(animator: &Animator, value: f32) -> f32 {
    let curves = animator.curves();
    let (low, high) = (angles(0)[1], angles(0)[2]);
    let (middle, span) = ((low + high) / 2.0, (high - low) * 1.16);
    curves.bottom() - (value - (middle - span / 2.0)) / span * curves.height()
}

fn place(animator: &Animator, key: usize) -> Pos2 {
    pos2(animator.x_in(animator.curves(), animator.key(key)), height(animator, angles(key)[0]))
}

/// Returns the corners of what is drawn in the curves.
fn vertices(animator: &Animator) -> Vec<Pos2> {
    let curves = animator.curves();
    let shapes = animator.harness.output().shapes.iter();
    let shapes = shapes.filter(|shape| shape.clip_rect.center().distance(curves.center()) < 2.0);
    let meshes =
        shapes.filter_map(|shape| if let Shape::Mesh(mesh) = &shape.shape { Some(mesh) } else { None });
    meshes.flat_map(|mesh| mesh.vertices.iter().map(|vertex| vertex.pos)).collect()
}

/// Returns whether something is drawn at a point of the curves.
fn is_drawn_at(animator: &Animator, at: Pos2) -> bool {
    vertices(animator).into_iter().any(|vertex| vertex.distance(at) < 9.0)
}

/// Returns the number that a field shows.
fn number(animator: &Animator, field: &str) -> f32 {
    animator.harness.get_by_label(field).accesskit_node().numeric_value().unwrap() as f32
}

/// Selects a key in the timeline, goes there, and returns the angle about X that the curves show.
fn shown(animator: &mut Animator, key: usize) -> f32 {
    let time = animator.key(key);
    animator.request(Request::Seek(time));
    animator.click(animator.at(time, 2));
    assert_eq!(animator.selected(), 1);
    animator.steps(2);
    number(animator, "Value X")
}

/// Makes room for the fields of all components.
fn enlarge(animator: &mut Animator) {
    animator.harness.set_size(vec2(1920.0, 1080.0));
    animator.steps(4);
}

#[test]
fn the_curve_of_a_rotation_stays_under_the_pointer_while_all_its_keys_are_dragged() {
    let mut animator = animator();
    let at = place(&animator, 8);
    assert!(is_drawn_at(&animator, at), "the curve is where it was computed to be");
    animator.request(Request::Command(Id::SelectAllKeys));
    let to = at - vec2(0.0, height(&animator, 80.0) - height(&animator, 90.0));
    animator.drag(at, to);
    animator.steps(2);
    assert!(is_drawn_at(&animator, to), "while it is dragged");
    for key in [0, 20, 40] {
        let by = to.y - at.y;
        assert!(is_drawn_at(&animator, place(&animator, key) + vec2(0.0, by)), "key {key}");
    }
    animator.release(to);
    animator.steps(2);
    assert!(is_drawn_at(&animator, to), "and after it was released");
    enlarge(&mut animator);
    for key in [0, 8, 40] {
        let x = shown(&mut animator, key);
        assert!((x - angles(key)[0] - 10.0).abs() < 0.5, "key {key}: {x}");
    }
    animator.request(Request::Command(Id::Undo));
    let x = shown(&mut animator, 8);
    assert!((x - angles(8)[0]).abs() < 0.1, "undone: {x}");
}

#[test]
fn a_cancelled_drag_of_a_rotation_leaves_its_curve_where_it_was() {
    let mut animator = animator();
    let at = place(&animator, 8);
    animator.request(Request::Command(Id::SelectAllKeys));
    let to = at - vec2(0.0, height(&animator, 80.0) - height(&animator, 90.0));
    animator.drag(at, to);
    animator.release(to);
    animator.drag(to, at);
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(3);
    animator.release(at);
    assert!(is_drawn_at(&animator, to));
}

#[test]
fn a_key_dragged_beyond_half_a_turn_stays_under_the_pointer() {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("Component X").click();
    animator.harness.get_by_label("Component Y").click();
    animator.steps(2);
    // The view holds more than a whole turn.
    let values = animator.harness.get_by_label("Values").rect().center();
    for _ in 0..4 {
        animator.wheel(values, vec2(0.0, -200.0));
    }
    animator.steps(4);
    let x = animator.x_in(animator.curves(), animator.key(8));
    let there: Vec<f32> =
        vertices(&animator).into_iter().filter(|at| (at.x - x).abs() < 2.0).map(|at| at.y).collect();
    let y = there.iter().sum::<f32>() / there.len() as f32;
    let (from, to) = (pos2(x, y), pos2(x, animator.curves().top() + 12.0));
    assert!(is_drawn_at(&animator, from));
    animator.drag(from, to);
    animator.steps(2);
    let turned = {
        let rotation = animator.edited.adapter().slots()[0].result.tracks[3].rotation.clone();
        rotation.value(8).unwrap().to_euler(EulerRot::XYZ).2.to_degrees()
    };
    assert!(turned < 0.0, "beyond half a turn: {turned}");
    assert!(is_drawn_at(&animator, to), "{to} in {}: {:?}", animator.curves(), {
        let mut near: Vec<Pos2> =
            vertices(&animator).into_iter().filter(|at| (at.x - x).abs() < 2.0).collect();
        near.truncate(12);
        near
    });
}

#[test]
fn properties_and_curves_show_the_same_angles() {
    let mut animator = animator();
    enlarge(&mut animator);
    for key in [0, 8, 40] {
        shown(&mut animator, key);
        for axis in ["X", "Y", "Z"] {
            let of = [format!("Value {axis}"), format!("Rotation result {axis}")];
            let [curves, properties] = of.map(|field| number(&animator, &field));
            assert!((curves - properties).abs() < 0.01, "key {key} {axis}: {curves} and {properties}");
        }
    }
    // The other order is chosen for both.
    animator.harness.get_by_label("Euler XYZ").click();
    animator.steps(2);
    animator.harness.get_by_label("Euler ZYX").click();
    animator.steps(4);
    for axis in ["X", "Y", "Z"] {
        let of = [format!("Value {axis}"), format!("Rotation result {axis}")];
        let [curves, properties] = of.map(|field| number(&animator, &field));
        assert!((curves - properties).abs() < 0.01, "{axis}: {curves} and {properties}");
    }
}

#[test]
fn a_typed_angle_of_more_than_half_a_turn_is_shown_by_both_panels() {
    let mut animator = Animator::with_bone(3);
    enlarge(&mut animator);
    shown(&mut animator, 8);
    animator.harness.get_by_label("Rotation result Z").click();
    animator.steps(2);
    animator.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    animator.steps(1);
    animator.harness.event(egui::Event::Text("250".to_owned()));
    animator.steps(1);
    animator.harness.key_press(egui::Key::Enter);
    animator.steps(4);
    for field in ["Rotation result Z", "Value Z"] {
        let shown = number(&animator, field);
        assert!((shown - 250.0).abs() < 0.01, "{field}: {shown}");
    }
}

#[test]
fn original_and_change_add_up_to_the_result_or_the_panel_says_why_not() {
    let mut animator = Animator::with_bone(3);
    enlarge(&mut animator);
    let note = "Angles do not add up";
    let says = |animator: &Animator| animator.harness.query_by_label(note).is_some();
    assert!(!says(&animator), "without a change there is nothing to say");
    shown(&mut animator, 8);
    let z_first = EulerOrder::Zyx;
    for (order, [x, y, z]) in [
        (EulerOrder::Xyz, [0.0, 0.0, 30.0]),
        (EulerOrder::Xyz, [0.0, 0.0, 170.0]),
        (z_first, [0.0, 0.0, -120.0]),
        (z_first, [40.0, 50.0, 60.0]),
        (z_first, [150.0, -80.0, 160.0]),
    ] {
        let look = PropertiesLook { euler: order, ..PropertiesLook::default() };
        animator.request(Request::PropertiesLook(look));
        let [x, y, z] = [x, y, z].map(|angle: f32| angle.to_radians());
        let rotation = Some(Quat::from_euler(EulerRot::XYZ, x, y, z).to_array());
        let pose = BonePose { bone: BoneRef::Index(3), translation: None, rotation, scale: None };
        let edit = animator.harness.state().state.read().pose_edit(vec![pose]).unwrap();
        animator.request(Request::Change(Change::Edit(edit, None)));
        animator.steps(2);
        let adds = ["X", "Y", "Z"].into_iter().all(|axis| {
            let label = format!("Rotation original {axis}: ");
            let original = animator.harness.get_by_label_contains(&label);
            let text = original.accesskit_node().label().unwrap().replace('\u{2212}', "-");
            let original: f32 = text.rsplit(' ').next().unwrap().parse().unwrap();
            let change = number(&animator, &format!("Rotation change {axis}"));
            (original + change - number(&animator, &format!("Rotation result {axis}"))).abs() < 0.03
        });
        assert_eq!(says(&animator), !adds, "{order:?} {x} {y} {z}");
    }
    assert!(says(&animator), "rotations about several axes do not add");
}
