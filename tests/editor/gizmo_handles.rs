//! Handles are hit where they are drawn, and have the same size on every screen.

use crate::gizmo_rig::{Rig, SPACES, Screen, along, unit};
use dragonfly::control::gizmo::Gizmo;
use dragonfly::control::{Key, Modifiers};
use dragonfly_kit::counting;
use dragonfly_picture::gizmo::{
    AXIS_TO, CENTER, GizmoAxis, GizmoRole, GizmoShape, GizmoSpace, GizmoVertex, Handle, OUTER, PLANE, RING,
    Tool,
};
use glam::{Vec2, Vec3};

const BONE: usize = 1;
const TOOLS: [Tool; 3] = [Tool::Move, Tool::Rotate, Tool::Scale];

fn gizmo(rig: &Rig, screen: &Screen, tool: Tool, space: GizmoSpace) -> Gizmo {
    let mut gizmo = Gizmo::new(tool);
    gizmo.settings.space = space;
    rig.select(&mut gizmo, &[BONE as u32]);
    gizmo.look(screen.view());
    gizmo
}

#[test]
fn every_handle_is_hit_where_it_is_drawn_on_every_screen() {
    let rig = Rig::new();
    let joint = rig.joint(BONE);
    for screen in Screen::all() {
        for space in SPACES {
            let axes = rig.axes(BONE, space, &screen.camera);
            let facing = |axis: GizmoAxis| (axes * unit(axis)).dot(screen.towards(joint)).abs();
            for tool in [Tool::Move, Tool::Scale] {
                let mut gizmo = gizmo(&rig, &screen, tool, space);
                for axis in GizmoAxis::ALL {
                    let [a, b] = axis.others().map(unit);
                    let tip = along(&screen, joint, axes, unit(axis) * (AXIS_TO as f32 - 2.0));
                    // Near other arrows or squares on the screen, either one is a valid hit.
                    if facing(axis) < 0.7 && GizmoAxis::ALL.into_iter().all(|other| facing(other) < 0.8) {
                        assert_eq!(gizmo.hover(Some(screen.at(tip))), Some(Handle::Axis(axis)), "{screen:?}");
                        let beyond = along(&screen, joint, axes, unit(axis) * (AXIS_TO as f32 * 2.0));
                        assert_eq!(gizmo.hover(Some(screen.at(beyond))), None);
                    }
                    if facing(axis) > 0.9 {
                        let square =
                            along(&screen, joint, axes, (a + b) * (PLANE[0] + PLANE[1]) as f32 / 2.0);
                        assert_eq!(gizmo.hover(Some(screen.at(square))), Some(Handle::Plane(axis)));
                    }
                }
                assert_eq!(gizmo.hover(Some(screen.at(joint))), Some(Handle::Center));
                let beside = screen.at(joint) + Vec2::new(CENTER as f32 + 200.0, 0.0);
                assert_eq!(gizmo.hover(Some(beside)), None);
            }
            let mut gizmo = gizmo(&rig, &screen, Tool::Rotate, space);
            let around = screen.at(joint) + Vec2::from_angle(1.0) * OUTER as f32;
            assert_eq!(gizmo.hover(Some(around)), Some(Handle::Ring));
            for axis in GizmoAxis::ALL.into_iter().filter(|&axis| facing(axis) > 0.5) {
                let [a, _] = axis.others().map(unit);
                let mut place =
                    along(&screen, joint, axes, (a * 0.6 + axis.others().map(unit)[1] * 0.8) * RING as f32);
                if (place - joint).dot(screen.towards(joint)) < 0.0 {
                    place = 2.0 * joint - place;
                }
                let met = gizmo.hover(Some(screen.at(place)));
                assert!(matches!(met, Some(Handle::Axis(_))), "{met:?}");
            }
        }
    }
}

#[test]
fn a_gizmo_has_the_same_size_on_every_screen() {
    let rig = Rig::new();
    let mut shape = GizmoShape::default();
    for screen in Screen::all() {
        let mut screen = screen;
        // In the center of the image, perspective distorts nothing.
        screen.camera.target = rig.joint(BONE);
        let gizmo = gizmo(&rig, &screen, Tool::Rotate, GizmoSpace::View);
        gizmo.present(&mut shape);
        let middle = screen.at(rig.joint(BONE));
        let largest = shape.lines().iter().map(|vertex| screen.at(vertex.position).distance(middle));
        let largest = largest.fold(0.0, f32::max);
        assert!((largest - OUTER as f32).abs() < 0.1, "{largest} points, {screen:?}");
    }
}

#[test]
fn axis_lines_are_hit_before_squares_and_squares_before_the_center() {
    let rig = Rig::new();
    let joint = rig.joint(BONE);
    let mut screen = Screen::plain();
    screen.camera.target = joint;
    let axes = rig.axes(BONE, GizmoSpace::View, &screen.camera);
    let at = |points: Vec3| screen.at(along(&screen, joint, axes, points));
    let mut gizmo = gizmo(&rig, &screen, Tool::Move, GizmoSpace::View);
    // The square's edge is 26 points from the axis; the arrow reaches 7 to either side of it.
    assert_eq!(gizmo.hover(Some(at(Vec3::new(35.0, 6.0, 0.0)))), Some(Handle::Axis(GizmoAxis::X)));
    assert_eq!(gizmo.hover(Some(at(Vec3::new(35.0, 15.0, 0.0)))), None);
    assert_eq!(gizmo.hover(Some(at(Vec3::new(35.0, 27.0, 0.0)))), Some(Handle::Plane(GizmoAxis::Z)));
    assert_eq!(gizmo.hover(Some(at(Vec3::new(8.0, 0.0, 0.0)))), Some(Handle::Axis(GizmoAxis::X)));
    assert_eq!(gizmo.hover(Some(at(Vec3::new(-8.0, 0.0, 0.0)))), Some(Handle::Center));
    // Arrows seen end-on and squares seen edge-on are hidden.
    assert_eq!(gizmo.hover(Some(at(Vec3::new(0.0, 0.0, 60.0)))), Some(Handle::Center));
    assert_eq!(gizmo.hovered(), Some(Handle::Center));
    assert_eq!(gizmo.hover(None), None);
    assert_eq!(gizmo.hover(Some(Vec2::NAN)), None);
}

#[test]
fn no_handle_can_be_hit_behind_the_camera() {
    let (rig, mut screen) = (Rig::new(), Screen::plain());
    screen.camera.target = rig.joint(BONE) + screen.camera.back() * -10.0;
    screen.camera.distance = 1.0;
    screen.camera.target = rig.joint(BONE) - screen.camera.back() * 5.0;
    let mut gizmo = gizmo(&rig, &screen, Tool::Move, GizmoSpace::World);
    let mut shape = GizmoShape::default();
    gizmo.present(&mut shape);
    assert!(shape.lines().is_empty() && shape.triangles().is_empty());
    assert_eq!(gizmo.hover(Some(Vec2::new(400.0, 300.0))), None);
    assert!(!gizmo.begin(None, Vec2::new(400.0, 300.0)));
}

fn has(list: &[GizmoVertex], role: GizmoRole) -> bool {
    list.iter().any(|vertex| vertex.role == role as u32)
}

#[test]
fn hovered_and_dragged_handles_are_highlighted() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let mut shape = GizmoShape::default();
    for tool in TOOLS {
        let mut gizmo = gizmo(&rig, &screen, tool, GizmoSpace::World);
        gizmo.present(&mut shape);
        for role in [GizmoRole::X, GizmoRole::Y, GizmoRole::Z] {
            assert!(has(shape.lines(), role), "{tool:?} {role:?}");
        }
        assert!(has(shape.triangles(), GizmoRole::View));
        assert!(!has(shape.triangles(), GizmoRole::Hover) && !has(shape.lines(), GizmoRole::Active));
        let middle = screen.at(rig.joint(BONE));
        gizmo.hover(Some(middle - Vec2::new(3.0, -3.0)));
        gizmo.present(&mut shape);
        assert!(has(shape.triangles(), GizmoRole::Hover), "{tool:?}");
        gizmo.begin(Some(Handle::Axis(GizmoAxis::Y)), middle + Vec2::new(5.0, -60.0));
        gizmo.pointer(middle + Vec2::new(40.0, -70.0), Modifiers::default());
        gizmo.present(&mut shape);
        assert!(has(shape.lines(), GizmoRole::Active) && !has(shape.lines(), GizmoRole::X));
        assert!(has(shape.lines(), GizmoRole::Y), "the line it is bound to");
        assert!(has(shape.triangles(), GizmoRole::Active), "{tool:?}");
        let finite = shape.lines().iter().chain(shape.triangles()).all(|vertex| vertex.position.is_finite());
        assert!(finite);
        assert_eq!((shape.lines().len() % 2, shape.triangles().len() % 3), (0, 0));
        gizmo.key_down(Key::Escape, Modifiers::default());
    }
}

#[test]
fn drawing_the_gizmo_again_allocates_nothing() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let mut shape = GizmoShape::default();
    for tool in TOOLS {
        let mut gizmo = gizmo(&rig, &screen, tool, GizmoSpace::Local);
        gizmo.present(&mut shape);
        let (poses, matrices) = (rig.poses.clone(), rig.to_root());
        let (count, ()) = counting::count(|| {
            for _ in 0..10 {
                gizmo.select(&rig.skeleton, &poses, &matrices, &[1], None);
                gizmo.hover(Some(Vec2::new(400.0, 300.0)));
                gizmo.present(&mut shape);
            }
        });
        assert_eq!(count.allocations, 0, "{count:?}");
    }
}
