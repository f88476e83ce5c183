//! Keys lock a drag to an axis, and typed numbers are applied exactly.

use crate::gizmo_rig::{Rig, Screen};
use dragonfly::control::gizmo::{Gizmo, GizmoAnswer};
use dragonfly::control::{Key, Modifiers};
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::gizmo::{GizmoAxis, GizmoDelta, GizmoSpace, Handle, Tool};
use glam::{DVec3, Vec2, Vec3};

const NONE: Modifiers = Modifiers { shift: false, ctrl: false, alt: false };
const SHIFT: Modifiers = Modifiers { shift: true, ..NONE };

/// Starts a drag of bone 0, which is a root, by a key.
fn dragging(tool: Tool, space: GizmoSpace) -> (Rig, Gizmo) {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let mut gizmo = Gizmo::new(tool);
    gizmo.settings.space = space;
    rig.select(&mut gizmo, &[0]);
    gizmo.look(screen.view());
    assert!(gizmo.begin(None, Vec2::new(250.0, 180.0)));
    (rig, gizmo)
}

/// Presses keys: `X` is Shift and x, `<` Backspace, `>` Tab, `\n` Enter.
fn press(gizmo: &mut Gizmo, keys: &str) -> GizmoAnswer {
    let mut last = GizmoAnswer::Ignored;
    for letter in keys.chars() {
        let key = match letter {
            '<' => Key::Backspace,
            '>' => Key::Tab,
            '\n' => Key::Enter,
            letter => Key::letter(letter),
        };
        last = gizmo.key_down(key, if letter.is_uppercase() { SHIFT } else { NONE });
    }
    last
}

fn delta(gizmo: &Gizmo) -> GizmoDelta {
    gizmo.readout().unwrap().delta
}

#[test]
fn a_typed_number_moves_the_bone_by_exactly_that_distance() {
    let moves = [
        ("x2", [2.0, 0.0, 0.0]),
        ("2x", [2.0, 0.0, 0.0]),
        ("y-1.5", [0.0, -1.5, 0.0]),
        ("z45/2", [0.0, 0.0, 22.5]),
        ("z.5", [0.0, 0.0, 0.5]),
        ("z,5", [0.0, 0.0, 0.5]),
        ("x10cm", [0.1, 0.0, 0.0]),
        ("x12<5", [15.0, 0.0, 0.0]),
        ("x3/", [3.0, 0.0, 0.0]),
        ("1>2>3", [1.0, 2.0, 3.0]),
        ("1>>3>5", [15.0, 0.0, 3.0]),
        ("Y1>3", [1.0, 0.0, 3.0]),
        ("X1>3", [0.0, 1.0, 3.0]),
        ("1x2y", [0.0, 12.0, 0.0]),
    ];
    for (keys, by) in moves {
        let (rig, mut gizmo) = dragging(Tool::Move, GizmoSpace::World);
        press(&mut gizmo, keys);
        assert_eq!(delta(&gizmo), GizmoDelta::Move(DVec3::from_array(by)), "{keys}");
        let expected = (rig.poses[0].translation.as_dvec3() + DVec3::from_array(by)).as_vec3();
        assert_eq!(gizmo.drag().bones[0].to_parent.translation, expected, "{keys}");
        // Once a number is typed, the pointer has no effect.
        gizmo.pointer(Vec2::new(700.0, 500.0), NONE);
        assert_eq!(delta(&gizmo), GizmoDelta::Move(DVec3::from_array(by)), "{keys}");
        assert_eq!(press(&mut gizmo, "\n"), GizmoAnswer::Confirmed);
    }
}

#[test]
fn typed_angles_are_degrees_and_typed_factors_are_factors() {
    let turns = [("x45", 45.0), ("z45/2", 22.5), ("y-720", -720.0), ("x1*pi rad", 180.0)];
    for (keys, degrees) in turns {
        let (_, mut gizmo) = dragging(Tool::Rotate, GizmoSpace::Local);
        press(&mut gizmo, keys);
        let GizmoDelta::Rotate { angle, .. } = delta(&gizmo) else { panic!("{keys}") };
        assert_eq!(angle, f64::to_radians(degrees), "{keys}");
    }
    let (rig, mut gizmo) = dragging(Tool::Rotate, GizmoSpace::Local);
    press(&mut gizmo, "z90");
    let expected = rig.poses[0].rotation * glam::Quat::from_rotation_z(90f32.to_radians());
    assert!(gizmo.drag().bones[0].to_parent.rotation.abs_diff_eq(expected, 1e-6));
    let factors = [
        ("2", [2.0, 2.0, 2.0]),
        ("y.5", [1.0, 0.5, 1.0]),
        ("Y3", [3.0, 1.0, 3.0]),
        ("150%", [1.5, 1.5, 1.5]),
    ];
    for (keys, by) in factors {
        let (_, mut gizmo) = dragging(Tool::Scale, GizmoSpace::Local);
        press(&mut gizmo, keys);
        assert_eq!(delta(&gizmo), GizmoDelta::Scale(DVec3::from_array(by)), "{keys}");
        let scale = gizmo.drag().bones[0].to_parent.scale;
        assert!(scale.distance(Vec3::from_array(by.map(|by| by as f32))) < 1e-6, "{keys} {scale}");
    }
}

#[test]
fn random_typed_numbers_are_applied_exactly() {
    let seed = seed(51);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    for _ in 0..500 {
        let number = (random.between(-1000.0, 1000.0) * 100.0).round() / 100.0;
        let (_, mut gizmo) = dragging(Tool::Move, GizmoSpace::World);
        press(&mut gizmo, &format!("y{number}"));
        let typed: f64 = number.to_string().parse().unwrap();
        assert_eq!(delta(&gizmo), GizmoDelta::Move(DVec3::Y * typed));
    }
}

#[test]
fn an_axis_key_locks_the_axis_then_changes_the_space_then_unlocks() {
    for (space, other) in [
        (GizmoSpace::Local, GizmoSpace::World),
        (GizmoSpace::Parent, GizmoSpace::World),
        (GizmoSpace::World, GizmoSpace::Local),
        (GizmoSpace::View, GizmoSpace::Local),
    ] {
        for tool in [Tool::Move, Tool::Rotate, Tool::Scale] {
            let (_, mut gizmo) = dragging(tool, space);
            let free = gizmo.readout().unwrap().handle;
            let bound =
                |gizmo: &Gizmo| gizmo.readout().map(|readout| (readout.handle, readout.space)).unwrap();
            press(&mut gizmo, "x");
            assert_eq!(bound(&gizmo), (Handle::Axis(GizmoAxis::X), space));
            press(&mut gizmo, "x");
            assert_eq!(bound(&gizmo), (Handle::Axis(GizmoAxis::X), other));
            press(&mut gizmo, "y");
            assert_eq!(bound(&gizmo), (Handle::Axis(GizmoAxis::Y), space));
            press(&mut gizmo, "Z");
            let plane =
                if tool == Tool::Rotate { Handle::Axis(GizmoAxis::Z) } else { Handle::Plane(GizmoAxis::Z) };
            assert_eq!(bound(&gizmo), (plane, space));
            press(&mut gizmo, "ZZ");
            assert_eq!(bound(&gizmo), (free, space));
        }
    }
}

#[test]
fn an_axis_locked_drag_is_measured_from_its_start() {
    let (_, mut gizmo) = dragging(Tool::Move, GizmoSpace::World);
    gizmo.pointer(Vec2::new(300.0, 100.0), NONE);
    press(&mut gizmo, "y");
    let GizmoDelta::Move(by) = delta(&gizmo) else { panic!() };
    assert!(by.x == 0.0 && by.z == 0.0 && by.y > 0.0, "{by}");
    let (_, mut other) = dragging(Tool::Move, GizmoSpace::World);
    press(&mut other, "y");
    other.pointer(Vec2::new(300.0, 100.0), NONE);
    assert_eq!(delta(&other), delta(&gizmo), "whichever came first");
}

#[test]
fn while_the_typed_number_is_incomplete_the_last_complete_one_applies() {
    let (_, mut gizmo) = dragging(Tool::Move, GizmoSpace::World);
    gizmo.pointer(Vec2::new(300.0, 100.0), NONE);
    let dragged = delta(&gizmo);
    press(&mut gizmo, "x4");
    assert!(gizmo.readout().unwrap().is_number);
    press(&mut gizmo, "/");
    let readout = gizmo.readout().unwrap();
    assert_eq!((readout.typed[0], readout.is_number), ("4/", false));
    assert_eq!(readout.delta, GizmoDelta::Move(DVec3::X * 4.0));
    press(&mut gizmo, "0");
    assert_eq!(delta(&gizmo), GizmoDelta::Move(DVec3::X * 4.0), "nothing is divided by nought");
    assert_eq!(press(&mut gizmo, "<<<xx"), GizmoAnswer::Changed);
    assert_eq!(delta(&gizmo), dragged, "with nothing typed the pointer counts again");
    assert_eq!(press(&mut gizmo, "<"), GizmoAnswer::Ignored);
    assert_eq!(press(&mut gizmo, "g"), GizmoAnswer::Ignored, "a letter begins no number");
    press(&mut gizmo, &"9".repeat(1000));
    assert!(gizmo.readout().unwrap().typed[0].len() < 100);
}

#[test]
fn keys_do_nothing_without_a_drag() {
    let mut gizmo = Gizmo::new(Tool::Move);
    assert_eq!(press(&mut gizmo, "x12\n"), GizmoAnswer::Ignored);
    assert!(!gizmo.begin(None, Vec2::ONE), "nothing is selected");
    assert_eq!(gizmo.confirm(), GizmoAnswer::Ignored);
    assert!(gizmo.readout().is_none());
}
