//! Several bones at once, and bones under parents that are stretched or mirrored.

use crate::gizmo_rig::{Rig, SPACES, Screen, between};
use dragonfly::control::gizmo::Gizmo;
use dragonfly::control::{Key, Modifiers};
use dragonfly_anim::data::Transform;
use dragonfly_picture::gizmo::{GizmoDelta, GizmoSettings, GizmoSpace, Pivot, Tool};
use glam::{Mat3, Mat4, Quat, Vec2, Vec3};

/// Returns a gizmo that is dragged by typed keys.
fn dragged(rig: &Rig, tool: Tool, settings: GizmoSettings, selected: &[u32], keys: &str) -> Gizmo {
    let mut gizmo = Gizmo::new(tool);
    gizmo.settings = settings;
    rig.select(&mut gizmo, selected);
    gizmo.look(Screen::plain().view());
    assert!(gizmo.begin(None, Vec2::new(300.0, 300.0)));
    for letter in keys.chars() {
        gizmo.key_down(Key::letter(letter), Modifiers::default());
    }
    gizmo
}

fn settings(space: GizmoSpace, pivot: Pivot) -> GizmoSettings {
    GizmoSettings { space, pivot, ..GizmoSettings::default() }
}

fn near(a: Vec3, b: Vec3) -> bool {
    a.distance(b) < 1e-5 * (1.0 + b.length())
}

#[test]
fn descendants_of_a_selected_bone_are_not_moved_twice() {
    let rig = Rig::new();
    for pivot in [Pivot::Individual, Pivot::Median, Pivot::Active] {
        let gizmo = dragged(&rig, Tool::Move, settings(GizmoSpace::World, pivot), &[2, 1, 3], "y2");
        let bones: Vec<u32> = gizmo.drag().bones.iter().map(|bone| bone.bone).collect();
        assert_eq!(bones, [1, 3], "2 hangs on 1");
        let (before, after) = (rig.to_root(), rig.to_root_of(&rig.after(&gizmo)));
        for bone in [1, 2, 3] {
            let way = after[bone].w_axis.truncate() - before[bone].w_axis.truncate();
            assert!(near(way, Vec3::Y * 2.0), "{bone} {way} {pivot:?}");
        }
    }
    // The ancestor may be selected with bones between that are not.
    let gizmo = dragged(&rig, Tool::Rotate, settings(GizmoSpace::World, Pivot::Median), &[2, 0], "z10");
    assert_eq!(gizmo.drag().bones.len(), 1);
}

#[test]
fn about_a_common_pivot_the_selection_rotates_and_scales_as_one() {
    let rig = Rig::new();
    let before = rig.to_root();
    let joints = [1, 3].map(|bone| rig.joint(bone));
    let middle = (joints[0] + joints[1]) / 2.0;
    for (pivot, center) in [(Pivot::Median, middle), (Pivot::Active, joints[1])] {
        let gizmo = dragged(&rig, Tool::Rotate, settings(GizmoSpace::World, pivot), &[1, 3], "z40");
        let after = rig.to_root_of(&rig.after(&gizmo));
        let turn = Mat4::from_translation(center)
            * Mat4::from_rotation_z(40f32.to_radians())
            * Mat4::from_translation(-center);
        for bone in [1, 2, 3] {
            assert!((turn * before[bone]).abs_diff_eq(after[bone], 1e-5), "{bone} {pivot:?}");
        }
        let gizmo = dragged(&rig, Tool::Scale, settings(GizmoSpace::World, pivot), &[1, 3], "2");
        let after = rig.to_root_of(&rig.after(&gizmo));
        for bone in [1, 3] {
            let expected = center + (before[bone].w_axis.truncate() - center) * 2.0;
            assert!(near(after[bone].w_axis.truncate(), expected), "{bone} {pivot:?}");
        }
    }
}

#[test]
fn bones_rotated_about_their_own_joints_keep_their_positions() {
    let rig = Rig::new();
    for space in SPACES {
        let gizmo = dragged(&rig, Tool::Rotate, settings(space, Pivot::Individual), &[1, 3], "x30");
        assert_eq!(gizmo.drag().bones.len(), 2);
        for change in &gizmo.drag().bones {
            let start = rig.poses[change.bone as usize];
            assert_eq!(change.to_parent.translation, start.translation);
            if space == GizmoSpace::Local {
                let expected = start.rotation * Quat::from_rotation_x(30f32.to_radians());
                assert!(between(change.to_parent.rotation, expected) < 1e-6, "each about its own axis");
            }
        }
    }
}

#[test]
fn a_drag_in_the_view_plane_moves_all_bones_equally() {
    let (rig, screen) = (Rig::new(), Screen::plain());
    let before = rig.to_root();
    for tool in [Tool::Move, Tool::Rotate] {
        let mut gizmo = Gizmo::new(tool);
        rig.select(&mut gizmo, &[1, 3]);
        gizmo.look(screen.view());
        assert!(gizmo.begin(None, Vec2::new(300.0, 300.0)));
        gizmo.pointer(Vec2::new(360.0, 250.0), Modifiers::default());
        let after = rig.to_root_of(&rig.after(&gizmo));
        let way = |bone: usize| after[bone].w_axis.truncate() - before[bone].w_axis.truncate();
        let turn = |bone: usize| Mat3::from_mat4(after[bone]) * Mat3::from_mat4(before[bone]).inverse();
        assert!(near(way(1), way(3)), "{tool:?}");
        assert!(turn(1).abs_diff_eq(turn(3), 1e-5), "{tool:?}");
        assert!(after[1] != before[1]);
    }
}

#[test]
fn the_curl_setting_rotates_every_bone_of_a_chain_by_the_same_angle() {
    let rig = Rig::new();
    let curl = GizmoSettings { curl: true, ..settings(GizmoSpace::Local, Pivot::Individual) };
    let gizmo = dragged(&rig, Tool::Rotate, curl, &[0, 1, 2], "z30");
    assert_eq!(gizmo.drag().bones.len(), 3);
    for change in &gizmo.drag().bones {
        let expected = rig.poses[change.bone as usize].rotation * Quat::from_rotation_z(30f32.to_radians());
        assert!(between(change.to_parent.rotation, expected) < 1e-6);
    }
    // The setting does not apply to moving: that would tear the chain apart.
    assert_eq!(dragged(&rig, Tool::Move, curl, &[0, 1, 2], "z30").drag().bones.len(), 1);
}

/// Returns a rig whose bone 1 has a rotated parent with this scale.
fn under(scale: Vec3) -> Rig {
    let mut rig = Rig::new();
    rig.poses[0].scale = scale;
    rig
}

#[test]
fn rotating_and_moving_along_world_axes_is_exact_under_a_mirrored_parent() {
    for scale in [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(2.0, -2.0, 2.0), Vec3::splat(-1.5)] {
        let rig = under(scale);
        let before = rig.to_root()[1];
        let center = before.w_axis.truncate();
        let gizmo = dragged(&rig, Tool::Rotate, settings(GizmoSpace::World, Pivot::Individual), &[1], "z40");
        let after = rig.to_root_of(&rig.after(&gizmo))[1];
        let turn = Mat3::from_rotation_z(40f32.to_radians()) * Mat3::from_mat4(before);
        assert!(Mat3::from_mat4(after).abs_diff_eq(turn, 1e-5), "{scale}");
        assert!(near(after.w_axis.truncate(), center));
        let gizmo = dragged(&rig, Tool::Move, settings(GizmoSpace::World, Pivot::Individual), &[1], "x3");
        let after = rig.to_root_of(&rig.after(&gizmo))[1];
        assert!(near(after.w_axis.truncate() - center, Vec3::X * 3.0), "{scale}");
    }
}

#[test]
fn rotating_by_center_and_ring_follows_the_pointer_under_a_mirrored_parent() {
    let screen = Screen::plain();
    for space in SPACES {
        for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)] {
            let rig = under(scale);
            let mut gizmo = Gizmo::new(Tool::Rotate);
            gizmo.settings.space = space;
            rig.select(&mut gizmo, &[1]);
            gizmo.look(screen.view());
            let middle = screen.at(rig.joint(1));
            let before = Mat3::from_mat4(rig.to_root()[1]);
            let begin = |gizmo: &mut Gizmo, handle, at, to| {
                gizmo.begin(Some(handle), at);
                gizmo.pointer(to, Modifiers::default());
                Mat3::from_mat4(rig.to_root_of(&rig.after(gizmo))[1])
            };
            use dragonfly_picture::gizmo::{GizmoAxis, Handle};
            let at = middle + Vec2::X * 96.0;
            let to = middle + Vec2::new(0.0, -96.0);
            let found = begin(&mut gizmo, Handle::Ring, at, to);
            let quarter = Mat3::from_axis_angle(screen.camera.back(), 90f32.to_radians());
            assert!(found.abs_diff_eq(quarter * before, 1e-4), "{space:?} {scale}");
            gizmo.cancel();
            let found = begin(&mut gizmo, Handle::Center, middle, middle + Vec2::X * 39.0);
            let half = Mat3::from_axis_angle(screen.camera.up(), 0.5);
            assert!(found.abs_diff_eq(half * before, 1e-4), "{space:?} {scale}");
            gizmo.cancel();
            // Seen from the front, an axis ring turns the way the pointer goes round it.
            gizmo.begin(Some(Handle::Axis(GizmoAxis::Z)), at);
            gizmo.pointer(middle + Vec2::new(95.0, -10.0), Modifiers::default());
            let found = Mat3::from_mat4(rig.to_root_of(&rig.after(&gizmo))[1]);
            let turn = Quat::from_mat3(&(found * before.inverse()));
            let axis = turn.to_axis_angle().0;
            assert!(axis.dot(screen.towards(rig.joint(1))) > 0.0, "{space:?} {scale} {axis}");
        }
    }
}

#[test]
fn under_a_nonuniformly_scaled_parent_joints_and_local_axes_are_exact() {
    for scale in [Vec3::new(3.0, 0.5, 1.0), Vec3::new(-2.0, 1.0, 0.3)] {
        let rig = under(scale);
        let start = rig.poses[1];
        let joint = rig.joint(1);
        let by = settings(GizmoSpace::Local, Pivot::Individual);
        let turned = dragged(&rig, Tool::Rotate, by, &[1], "y30").drag().bones[0].to_parent;
        let expected = start.rotation * Quat::from_rotation_y(30f32.to_radians());
        assert!(between(turned.rotation, expected) < 1e-6);
        let grown = dragged(&rig, Tool::Scale, by, &[1], "z3").drag().bones[0].to_parent;
        assert!(near(grown.scale, start.scale * Vec3::new(1.0, 1.0, 3.0)), "{}", grown.scale);
        // In parent space the bone rotates about the axis of its parent.
        let by = settings(GizmoSpace::Parent, Pivot::Individual);
        let turned = dragged(&rig, Tool::Rotate, by, &[1], "y30").drag().bones[0].to_parent;
        let expected = Quat::from_rotation_y(30f32.to_radians()) * start.rotation;
        assert!(between(turned.rotation, expected) < 1e-6);
        // The joint is where a world move and a turn about a common middle bring it, exactly.
        let world = settings(GizmoSpace::World, Pivot::Active);
        let gizmo = dragged(&rig, Tool::Move, world, &[1], "y3");
        assert!(near(rig.to_root_of(&rig.after(&gizmo))[1].w_axis.truncate(), joint + Vec3::Y * 3.0));
        let active = rig.joint(3);
        let gizmo = dragged(&rig, Tool::Rotate, world, &[1, 3], "x50");
        let expected = active + Quat::from_rotation_x(50f32.to_radians()) * (joint - active);
        assert!(near(rig.to_root_of(&rig.after(&gizmo))[1].w_axis.truncate(), expected));
        // The bone is rotated by 50 degrees. The axis is not exactly that of the world, because a pose cannot store
        // shear.
        let angle = between(gizmo.drag().bones[0].to_parent.rotation, start.rotation);
        assert!((angle - 50f32.to_radians()).abs() < 1e-5);
    }
}

#[test]
fn scaling_along_a_world_axis_is_shared_among_the_local_axes_by_their_direction() {
    let mut rig = Rig::new();
    rig.poses[0] = Transform { rotation: Quat::from_rotation_z(45f32.to_radians()), ..Transform::IDENTITY };
    let gizmo = dragged(&rig, Tool::Scale, settings(GizmoSpace::World, Pivot::Individual), &[0], "x3");
    assert_eq!(gizmo.readout().unwrap().delta, GizmoDelta::Scale(glam::DVec3::new(3.0, 1.0, 1.0)));
    assert!(near(gizmo.drag().bones[0].to_parent.scale, Vec3::new(2.0, 2.0, 1.0)), "half of it each");
    rig.poses[0].rotation = Quat::from_rotation_z(90f32.to_radians());
    let gizmo = dragged(&rig, Tool::Scale, settings(GizmoSpace::World, Pivot::Individual), &[0], "x3");
    assert!(near(gizmo.drag().bones[0].to_parent.scale, Vec3::new(1.0, 3.0, 1.0)), "all of it to one");
}

#[test]
fn under_a_parent_scaled_to_zero_the_joint_stays_and_all_values_are_finite() {
    for scale in [Vec3::new(0.0, 1.0, 1.0), Vec3::ZERO] {
        let rig = under(scale);
        for (tool, keys) in [(Tool::Move, "x3"), (Tool::Rotate, "y30"), (Tool::Scale, "z2")] {
            for pivot in [Pivot::Individual, Pivot::Median] {
                let gizmo = dragged(&rig, tool, settings(GizmoSpace::World, pivot), &[1, 3], keys);
                for change in &gizmo.drag().bones {
                    assert!(change.to_parent.is_finite());
                    let start = rig.poses[change.bone as usize];
                    assert_eq!(change.to_parent.translation, start.translation);
                    if tool == Tool::Rotate {
                        assert!(between(change.to_parent.rotation, start.rotation) > 0.5, "it still rotates");
                    }
                }
            }
        }
    }
}
