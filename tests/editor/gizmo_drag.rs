//! Dragging a handle by a distance moves, rotates and scales the bones by exactly that amount, from any view.

use crate::gizmo_rig::{Rig, SPACES, Screen, along, between, unit};
use dragonfly::control::gizmo::{Gizmo, GizmoAnswer};
use dragonfly::control::{Key, Modifiers};
use dragonfly_anim::data::Transform;
use dragonfly_kit::counting;
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::gizmo::{
    AXIS_TO, GizmoAxis, GizmoDelta, GizmoSettings, GizmoSpace, GizmoView, Handle, OUTER, Pivot, RING, Tool,
};
use glam::{DVec3, Mat3, Quat, Vec2, Vec3};

const BONE: usize = 1;
const NONE: Modifiers = Modifiers { shift: false, ctrl: false, alt: false };
const SHIFT: Modifiers = Modifiers { shift: true, ..NONE };
const CTRL: Modifiers = Modifiers { ctrl: true, ..NONE };

fn gizmo(rig: &Rig, screen: &Screen, tool: Tool, space: GizmoSpace) -> Gizmo {
    let mut gizmo = Gizmo::new(tool);
    gizmo.settings.space = space;
    rig.select(&mut gizmo, &[BONE as u32]);
    gizmo.look(screen.view());
    gizmo
}

/// Returns the bone's local rotation after a rotation about `axis` in `space`, for parents without scale.
fn turned(rig: &Rig, space: GizmoSpace, axes: Mat3, axis: Vec3, angle: f32) -> Quat {
    let own = rig.poses[BONE].rotation;
    match space {
        GizmoSpace::Local => own * Quat::from_axis_angle(axis, angle),
        GizmoSpace::Parent => Quat::from_axis_angle(axis, angle) * own,
        GizmoSpace::World | GizmoSpace::View => {
            let parent = Quat::from_mat4(&rig.to_root()[0]);
            parent.inverse() * Quat::from_axis_angle(axes * axis, angle) * parent * own
        }
    }
}

#[test]
fn a_ring_dragged_by_30_degrees_turns_by_30_degrees_about_its_axis() {
    let rig = Rig::new();
    let mut tested = 0;
    for screen in Screen::all() {
        for space in SPACES {
            let axes = rig.axes(BONE, space, &screen.camera);
            for axis in GizmoAxis::ALL {
                let joint = rig.joint(BONE);
                let normal = axes * unit(axis);
                if normal.dot(screen.towards(joint)).abs() < 0.2 {
                    continue;
                }
                let [a, b] = axis.others().map(unit);
                let on_ring = |degrees: f32| {
                    let (sin, cos) = degrees.to_radians().sin_cos();
                    screen.at(along(&screen, joint, axes, (a * cos + b * sin) * RING as f32))
                };
                let mut gizmo = gizmo(&rig, &screen, Tool::Rotate, space);
                assert!(gizmo.begin(Some(Handle::Axis(axis)), on_ring(20.0)));
                for (to, angle) in [(50.0, 30.0), (20.0 - 90.0, -90.0), (50.0, 30.0)] {
                    gizmo.pointer(on_ring(to), NONE);
                    let expected = turned(&rig, space, axes, unit(axis), f32::to_radians(angle));
                    let found = gizmo.drag().bones[0].to_parent;
                    let off = between(found.rotation, expected);
                    assert!(off < 1e-4, "{off} off by {angle} about {axis:?} in {space:?}, {screen:?}");
                    assert_eq!((found.translation, found.scale), {
                        let start = rig.poses[BONE];
                        (start.translation, start.scale)
                    });
                }
                tested += 1;
            }
        }
    }
    assert!(tested > 150, "{tested}");
}

#[test]
fn a_ring_counts_more_than_one_full_rotation() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let joint = rig.joint(BONE);
    let on_ring = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        screen.at(joint) + Vec2::new(cos, -sin) * OUTER as f32
    };
    let mut gizmo = gizmo(&rig, &screen, Tool::Rotate, GizmoSpace::World);
    gizmo.begin(Some(Handle::Ring), on_ring(0.0));
    for degrees in (0..=800).step_by(20) {
        gizmo.pointer(on_ring(degrees as f32), NONE);
    }
    let Some(GizmoDelta::Rotate { angle, .. }) = gizmo.readout().map(|readout| readout.delta) else {
        panic!()
    };
    assert!((angle.to_degrees() - 800.0).abs() < 1e-3, "{}", angle.to_degrees());
    let expected = turned(
        &rig,
        GizmoSpace::View,
        rig.axes(BONE, GizmoSpace::View, &screen.camera),
        Vec3::Z,
        80f32.to_radians(),
    );
    assert!(between(gizmo.drag().bones[0].to_parent.rotation, expected) < 1e-4);
    // With the pointer at the center there is no angle, so the rotation stays.
    gizmo.pointer(screen.at(joint), NONE);
    let Some(GizmoDelta::Rotate { angle, .. }) = gizmo.readout().map(|readout| readout.delta) else {
        panic!()
    };
    assert!((angle.to_degrees() - 800.0).abs() < 1e-3);
}

#[test]
fn a_ring_seen_edge_on_rotates_in_proportion_to_the_drag_across_its_axis() {
    let rig = Rig::new();
    for screen in Screen::all() {
        // The x and y axes of the view are parallel to the image plane: from its center, their rings are seen edge on.
        let mut screen = screen;
        screen.camera.target = rig.joint(BONE);
        for (axis, way) in [(GizmoAxis::X, Vec2::Y), (GizmoAxis::Y, Vec2::X)] {
            let mut gizmo = gizmo(&rig, &screen, Tool::Rotate, GizmoSpace::View);
            let start = screen.at(rig.joint(BONE)) + Vec2::splat(5.0);
            gizmo.begin(Some(Handle::Axis(axis)), start);
            gizmo.pointer(start + way * (30f32.to_radians() * RING as f32), NONE);
            let axes = rig.axes(BONE, GizmoSpace::View, &screen.camera);
            let expected = turned(&rig, GizmoSpace::View, axes, unit(axis), 30f32.to_radians());
            let off = between(gizmo.drag().bones[0].to_parent.rotation, expected);
            assert!(off < 1e-4, "{off} {axis:?} {screen:?}");
        }
    }
}

#[test]
fn dragging_the_center_rotates_freely_with_the_pointer() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let mut gizmo = gizmo(&rig, &screen, Tool::Rotate, GizmoSpace::Local);
    let start = screen.at(rig.joint(BONE));
    gizmo.begin(Some(Handle::Center), start);
    gizmo.pointer(start + Vec2::X * (0.5 * RING as f32), NONE);
    let axes = rig.axes(BONE, GizmoSpace::View, &screen.camera);
    let expected = turned(&rig, GizmoSpace::View, axes, Vec3::Y, 0.5);
    assert!(between(gizmo.drag().bones[0].to_parent.rotation, expected) < 1e-4);
    gizmo.pointer(start + Vec2::Y * (0.5 * RING as f32), NONE);
    let expected = turned(&rig, GizmoSpace::View, axes, Vec3::X, 0.5);
    assert!(between(gizmo.drag().bones[0].to_parent.rotation, expected) < 1e-4);
}

#[test]
fn arrows_and_squares_move_by_the_dragged_distance() {
    let rig = Rig::new();
    let joint = rig.joint(BONE);
    for screen in Screen::all() {
        for space in SPACES {
            let axes = rig.axes(BONE, space, &screen.camera);
            let step = screen.unit(joint);
            for axis in GizmoAxis::ALL {
                let facing = (axes * unit(axis)).dot(screen.towards(joint)).abs();
                let [a, b] = axis.others().map(unit);
                for (handle, from, way) in [
                    (Handle::Axis(axis), unit(axis) * 60.0, unit(axis) * 50.0),
                    (Handle::Plane(axis), (a + b) * 30.0, a * 40.0 - b * 25.0),
                ] {
                    let is_flat = if handle == Handle::Plane(axis) { facing < 0.2 } else { facing > 0.97 };
                    if is_flat {
                        continue;
                    }
                    let mut gizmo = gizmo(&rig, &screen, Tool::Move, space);
                    assert!(gizmo.begin(Some(handle), screen.at(along(&screen, joint, axes, from))));
                    gizmo.pointer(screen.at(along(&screen, joint, axes, from + way)), NONE);
                    let after = rig.to_root_of(&rig.after(&gizmo))[BONE].w_axis.truncate();
                    let expected = along(&screen, joint, axes, way);
                    let off = after.distance(expected) / step;
                    assert!(off < 0.02, "{off} points off: {handle:?} in {space:?}, {screen:?}");
                    assert_eq!(gizmo.drag().bones[0].to_parent.rotation, rig.poses[BONE].rotation);
                }
            }
        }
    }
}

#[test]
fn the_scale_factor_is_the_ratio_of_the_pointer_distances_from_the_joint() {
    let rig = Rig::new();
    let joint = rig.joint(BONE);
    for screen in Screen::all() {
        let axes = rig.axes(BONE, GizmoSpace::Local, &screen.camera);
        for axis in GizmoAxis::ALL {
            if (axes * unit(axis)).dot(screen.towards(joint)).abs() > 0.9 {
                continue;
            }
            let at = |points: f32| screen.at(along(&screen, joint, axes, unit(axis) * points));
            for (to, factor) in [(60.0, 1.5), (20.0, 0.5), (-40.0, -1.0)] {
                let mut gizmo = gizmo(&rig, &screen, Tool::Scale, GizmoSpace::Local);
                gizmo.begin(Some(Handle::Axis(axis)), at(40.0 + 20.0));
                gizmo.pointer(at(to * 1.5), NONE);
                let expected = Vec3::ONE + unit(axis) * (factor - 1.0);
                let found = gizmo.drag().bones[0].to_parent.scale;
                assert!(found.distance(expected) < 1e-3, "{found} {expected} {screen:?}");
            }
        }
        let middle = screen.at(joint);
        let mut gizmo = gizmo(&rig, &screen, Tool::Scale, GizmoSpace::World);
        gizmo.begin(Some(Handle::Ring), middle + Vec2::new(0.0, OUTER as f32));
        gizmo.pointer(middle + Vec2::new(OUTER as f32 * 2.5, 0.0), NONE);
        let found = gizmo.drag().bones[0].to_parent.scale;
        assert!(found.distance(Vec3::splat(2.5)) < 1e-4, "{found}");
        // A drag from the center has no distance to divide by: moving right and up enlarges.
        gizmo.cancel();
        gizmo.begin(Some(Handle::Center), middle);
        gizmo.pointer(middle + Vec2::new(AXIS_TO as f32 / 2.0, -AXIS_TO as f32 / 2.0), NONE);
        let found = gizmo.drag().bones[0].to_parent.scale;
        assert!(found.distance(Vec3::splat(2.0)) < 1e-4, "{found}");
    }
}

#[test]
fn a_drag_up_moves_a_bone_along_an_axis_that_points_at_the_viewer_without_a_jump() {
    let rig = Rig::new();
    for mut screen in Screen::all() {
        screen.camera.target = rig.joint(BONE);
        let step = screen.unit(rig.joint(BONE));
        let mut gizmo = gizmo(&rig, &screen, Tool::Move, GizmoSpace::View);
        let start = screen.size / 2.0;
        gizmo.begin(Some(Handle::Axis(GizmoAxis::Z)), start);
        for up in [0.0, 1.0, 10.0, 300.0] {
            gizmo.pointer(start - Vec2::Y * up, NONE);
            let Some(GizmoDelta::Move(by)) = gizmo.readout().map(|readout| readout.delta) else { panic!() };
            let expected = DVec3::Z * f64::from(up * step);
            assert!(by.distance(expected) <= f64::from(step) * 1e-3, "{by} {expected}");
        }
    }
}

#[test]
fn a_bone_on_an_axis_never_moves_back_while_the_pointer_moves_forward() {
    let seed = seed(41);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let rig = Rig::new();
    for _ in 0..400 {
        let mut screen = Screen::plain();
        screen.camera.yaw = random.between(-3.0, 3.0);
        screen.camera.pitch = random.between(-1.5, 1.5);
        screen.camera.field_of_view = random.between(0.3, 2.0);
        let joint = rig.joint(BONE);
        let (from, to) = (screen.at(joint), screen.at(joint + Vec3::X * 0.01));
        // The pointer moves farther than any screen is large, also past the point where the axis vanishes.
        let way = (to - from).normalize_or(Vec2::X);
        let is_line = from.distance(to) / (0.01 / screen.unit(joint)) > 0.12;
        if !is_line {
            continue;
        }
        let mut gizmo = gizmo(&rig, &screen, Tool::Move, GizmoSpace::World);
        gizmo.begin(Some(Handle::Axis(GizmoAxis::X)), from + way * 60.0);
        let aside = way.perp() * random.between(-200.0, 200.0);
        let mut last = f64::NEG_INFINITY;
        for step in -3000..3000 {
            gizmo.pointer(from + way * (step * 2) as f32 + aside, NONE);
            let Some(GizmoDelta::Move(by)) = gizmo.readout().map(|readout| readout.delta) else { panic!() };
            assert!(by.x >= last - 1e-9 && by.x.is_finite(), "{} after {last} at {step}", by.x);
            last = by.x;
        }
    }
}

#[test]
fn shift_slows_a_drag_to_a_tenth_without_a_jump() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let middle = screen.at(rig.joint(BONE));
    let on_ring = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        middle + Vec2::new(cos, -sin) * OUTER as f32
    };
    let mut gizmo = gizmo(&rig, &screen, Tool::Rotate, GizmoSpace::World);
    gizmo.begin(Some(Handle::Ring), on_ring(0.0));
    let steps = [
        (on_ring(30.0), NONE, 30.0),
        (on_ring(30.0), SHIFT, 30.0),
        (on_ring(60.0), SHIFT, 33.0),
        (on_ring(60.0), NONE, 33.0),
        (on_ring(80.0), NONE, 53.0),
        (on_ring(80.0), CTRL, 55.0),
        (on_ring(80.4), CTRL, 55.0),
        (on_ring(80.0), NONE, 53.0),
        (on_ring(80.0), Modifiers { shift: true, ..CTRL }, 53.0),
    ];
    for (at, modifiers, degrees) in steps {
        gizmo.pointer(at, modifiers);
        let Some(GizmoDelta::Rotate { angle, .. }) = gizmo.readout().map(|readout| readout.delta) else {
            panic!()
        };
        let found = angle.to_degrees();
        assert!((found - degrees).abs() < 1e-3, "{found} {degrees} {modifiers:?}");
    }
}

#[test]
fn ctrl_snaps_to_the_steps_of_the_settings() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let joint = rig.joint(BONE);
    let at = |points: f32| screen.at(along(&screen, joint, Mat3::IDENTITY, Vec3::Y * points));
    for (settings, step) in [
        (GizmoSettings::default(), 0.1),
        (GizmoSettings { move_step: 0.25, ..GizmoSettings::default() }, 0.25),
    ] {
        let mut gizmo = gizmo(&rig, &screen, Tool::Move, GizmoSpace::World);
        gizmo.settings = GizmoSettings { space: GizmoSpace::World, ..settings };
        gizmo.begin(Some(Handle::Axis(GizmoAxis::Y)), at(50.0));
        let mut seen = 0.0_f64;
        for points in 50..400 {
            gizmo.pointer(at(points as f32), CTRL);
            let Some(GizmoDelta::Move(by)) = gizmo.readout().map(|readout| readout.delta) else { panic!() };
            let off = (by.y / step - (by.y / step).round()).abs();
            assert!(off < 1e-9 && by.x == 0.0 && by.z == 0.0, "{by}");
            seen = seen.max(by.y);
        }
        assert!(seen > 0.4, "{seen}");
    }
}

#[test]
fn cancelling_restores_the_poses_bit_for_bit_and_dragging_back_almost_exactly() {
    let seed = seed(42);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let screens = Screen::all();
    for _ in 0..2_000 {
        let screen = screens[random.below(screens.len())];
        let mut rig = Rig::new();
        for pose in &mut rig.poses {
            let mut number = || random.between(-1.0, 1.0);
            pose.translation = Vec3::new(number(), number(), number());
            pose.rotation = Quat::from_xyzw(number(), number(), number(), number() + 1.5).normalize();
            pose.scale = Vec3::new(number(), number(), number()) + 1.5;
        }
        let tool = random.choice(&[Tool::Move, Tool::Rotate, Tool::Scale]);
        let axis = random.choice(&GizmoAxis::ALL);
        let handle = random.choice(&[Handle::Axis(axis), Handle::Plane(axis), Handle::Center, Handle::Ring]);
        let mut gizmo = Gizmo::new(tool);
        gizmo.settings.space = random.choice(&SPACES);
        gizmo.settings.pivot = random.choice(&[Pivot::Individual, Pivot::Median, Pivot::Active]);
        gizmo.settings.curl = random.below(2) == 0;
        rig.select(&mut gizmo, &[1, 3, 2][..1 + random.below(3)]);
        gizmo.look(screen.view());
        // A point where a drag could start, away from the center.
        let start =
            screen.size / 2.0 + Vec2::from_angle(random.between(0.0, 6.0)) * random.between(60.0, 90.0);
        if !gizmo.begin((random.below(4) > 0).then_some(handle), start) {
            continue;
        }
        assert_eq!(rig.after(&gizmo), rig.poses, "nothing has happened yet");
        let mut changed = false;
        let mut at = start;
        for _ in 0..10 {
            at += Vec2::new(random.between(-15.0, 15.0), random.between(-15.0, 15.0));
            assert_eq!(gizmo.pointer(at, NONE), GizmoAnswer::Changed);
            changed |= rig.after(&gizmo) != rig.poses;
        }
        assert!(changed, "{tool:?} {handle:?}");
        assert!(rig.after(&gizmo).iter().all(Transform::is_finite));
        // The pointer moves back, but not straight over the center, where the gizmo could count a full turn.
        for share in 1..=20 {
            gizmo.pointer(at.lerp(start, share as f32 / 20.0), NONE);
        }
        let is_ring = tool == Tool::Rotate && handle != Handle::Center;
        for (bone, (after, before)) in rig.after(&gizmo).iter().zip(&rig.poses).enumerate() {
            let near = |a: Vec3, b: Vec3| a.distance(b) <= 1e-5 * (1.0 + b.length());
            let same = near(after.translation, before.translation)
                && near(after.scale, before.scale)
                && between(after.rotation, before.rotation) < 1e-5;
            assert!(same || is_ring, "{bone} {after:?} {before:?} {tool:?} {handle:?}");
        }
        gizmo.pointer(at, NONE);
        if random.below(2) == 0 {
            assert_eq!(gizmo.cancel(), GizmoAnswer::Cancelled);
        } else {
            assert_eq!(gizmo.key_down(Key::Escape, NONE), GizmoAnswer::Cancelled);
        }
        let bits = |pose: &Transform| {
            let numbers = [pose.translation.to_array(), pose.scale.to_array()].concat();
            let all = numbers.into_iter().chain(pose.rotation.to_array());
            all.map(f32::to_bits).collect::<Vec<_>>()
        };
        for (after, before) in rig.after(&gizmo).iter().zip(&rig.poses) {
            assert_eq!(bits(after), bits(before));
        }
        assert_eq!(gizmo.cancel(), GizmoAnswer::Ignored);
    }
}

#[test]
fn the_camera_may_move_during_a_drag_without_a_jump() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    for tool in [Tool::Move, Tool::Rotate, Tool::Scale] {
        for handle in [Handle::Axis(GizmoAxis::Y), Handle::Center] {
            let mut gizmo = gizmo(&rig, &screen, tool, GizmoSpace::World);
            let start = screen.at(along(&screen, rig.joint(BONE), Mat3::IDENTITY, Vec3::Y * 60.0));
            gizmo.begin(Some(handle), start);
            let at = start + Vec2::new(20.0, -30.0);
            gizmo.pointer(at, NONE);
            let before = rig.after(&gizmo);
            let mut moved = screen;
            moved.camera.orbit(0.3, 0.1);
            moved.camera.dolly(1.2);
            gizmo.look(moved.view());
            gizmo.pointer(at, NONE);
            let (after, before) = (rig.after(&gizmo)[BONE], before[BONE]);
            assert!(after.translation.distance(before.translation) < 1e-5, "{tool:?} {handle:?}");
            assert!(after.scale.distance(before.scale) < 1e-5, "{tool:?} {handle:?}");
            assert!(between(after.rotation, before.rotation) < 1e-5, "{tool:?} {handle:?}");
        }
    }
}

#[test]
fn a_drag_allocates_nothing_per_move() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let mut gizmo = gizmo(&rig, &screen, Tool::Move, GizmoSpace::World);
    let start = screen.at(rig.joint(BONE));
    gizmo.begin(Some(Handle::Center), start);
    let (count, ()) = counting::count(|| {
        for step in 0..100 {
            gizmo.pointer(start + Vec2::splat(step as f32), if step % 7 == 0 { SHIFT } else { NONE });
        }
        for letter in "12.5".chars() {
            gizmo.key_down(Key::Letter(letter), NONE);
        }
        gizmo.key_down(Key::letter('X'), NONE);
    });
    assert_eq!(count.allocations, 0, "{count:?}");
}

#[test]
fn any_input_leaves_every_pose_finite() {
    let seed = seed(43);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let odd = [0.0, f32::NAN, f32::INFINITY, 1e30, -1e30, 1e-30, 400.0];
    let keys = [
        Key::Letter('x'),
        Key::Letter('y'),
        Key::Letter('z'),
        Key::Letter('1'),
        Key::Letter('0'),
        Key::Letter('-'),
        Key::Letter('/'),
        Key::Letter('e'),
        Key::Letter('9'),
        Key::Tab,
        Key::Backspace,
        Key::Enter,
        Key::Escape,
    ];
    for _ in 0..1_500 {
        let mut rig = Rig::new();
        for pose in &mut rig.poses {
            if random.below(3) == 0 {
                pose.scale = Vec3::new(
                    random.choice(&odd),
                    random.between(-2.0, 2.0),
                    random.choice(&[0.0, -1.0, 1e-20, 1e20]),
                );
            }
            if random.below(12) == 0 {
                pose.translation.x = random.choice(&odd);
            }
        }
        let mut gizmo = Gizmo::new(random.choice(&[Tool::Move, Tool::Rotate, Tool::Scale]));
        gizmo.settings.space = random.choice(&SPACES);
        gizmo.settings.pivot = random.choice(&[Pivot::Individual, Pivot::Median, Pivot::Active]);
        if random.below(8) == 0 {
            gizmo.settings.move_step = f64::from(random.choice(&odd));
            gizmo.settings.precise = f64::from(random.choice(&odd));
        }
        let mut screen = Screen::plain();
        for _ in 0..30 {
            let mut place =
                || if random.below(10) == 0 { random.choice(&odd) } else { random.between(0.0, 800.0) };
            let at = Vec2::new(place(), place());
            let modifiers = Modifiers { shift: random.below(3) == 0, ctrl: random.below(3) == 0, alt: false };
            match random.below(8) {
                0 => {
                    screen.camera.orbit(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
                    screen.camera.dolly(random.between(0.1, 3.0));
                    screen.size =
                        Vec2::new(random.choice(&[0.0, 1.0, 50.0, 4000.0]), random.between(1.0, 900.0));
                    gizmo.look(GizmoView::of_pixels(&screen.camera, screen.size, random.choice(&odd)));
                }
                1 => rig.select(&mut gizmo, &[random.below(6) as u32, random.below(4) as u32]),
                2 => _ = gizmo.hover(Some(at)),
                3 => {
                    let handle = gizmo.hover(Some(at)).or(Some(Handle::Axis(random.choice(&GizmoAxis::ALL))));
                    gizmo.begin(handle.filter(|_| random.below(3) > 0), at);
                }
                4 => _ = gizmo.key_down(random.choice(&keys), modifiers),
                _ => _ = gizmo.pointer(at, modifiers),
            }
            let start = &rig.poses;
            for change in &gizmo.drag().bones {
                let sound = change.to_parent.is_finite() || !start[change.bone as usize].is_finite();
                assert!(sound, "{:?}", change.to_parent);
            }
        }
        gizmo.cancel();
        assert!(!gizmo.is_dragging());
    }
}
