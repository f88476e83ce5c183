//! The motion path of the selected bone, its keys that can be dragged, and ghosts.

use crate::viewport_tools_rig::{PICTURE, ViewportHarness};
use dragonfly::control::Key;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly::panels::settings::GhostSettings;
use dragonfly_document::bones::Choice;
use dragonfly_document::{Cancel, LoadError, OpenedModel, Progress, Source};
use dragonfly_kit::document::arm;
use dragonfly_picture::gizmo::GizmoView;
use glam::{Vec2, Vec3};
use std::sync::Arc;

fn load(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(Arc::into_inner(arm::loaded()).expect("the only one").into())
}

/// Opens the arm with its tip selected and the path of the tip shown.
fn tip() -> ViewportHarness {
    let mut viewport = ViewportHarness::new(load);
    viewport.state.execute(Request::Select(Some(2)));
    viewport.command(Id::TogglePath);
    viewport
}

/// Returns the window position of a point in the scene.
fn seen(viewport: &ViewportHarness, place: Vec3) -> Vec2 {
    let view = GizmoView::new(&viewport.state.read().camera, Vec2::new(PICTURE[2], PICTURE[3]));
    view.to_screen(place.as_dvec3()).expect("in front of the camera").as_vec2()
        + Vec2::new(PICTURE[0], PICTURE[1])
}

#[test]
fn the_motion_path_follows_the_joint() {
    let mut viewport = tip();
    let path = Arc::clone(viewport.state.read().tools.path().look().expect("a path"));
    assert_eq!(path.points.len(), 31, "a second at 30 frames");
    for &(time, place) in path.points.iter().chain(&path.keys) {
        viewport.state.execute(Request::Seek(time));
        viewport.state.begin_frame(viewport.state.read().now);
        let joint = viewport.state.read().posed.animation().expect("posed").to_root()[2].w_axis.truncate();
        assert!(joint.distance(place) < 1e-4, "at {time}: {place} is not {joint}");
    }
    let travelled: f32 = path.points.windows(2).map(|pair| pair[0].1.distance(pair[1].1)).sum();
    assert!(travelled > 0.1, "it moves: {travelled}");
    viewport.command(Id::TogglePath);
    assert!(viewport.state.read().tools.path().look().is_none());
}

#[test]
fn a_key_of_the_path_is_dragged_to_the_pointer_in_one_step() {
    let mut viewport = tip();
    let (time, place) =
        *viewport.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    let from = seen(&viewport, place);
    let to = from + Vec2::new(37.0, -21.0);
    viewport.press(from);
    assert!(viewport.state.read().tools.controls().edits());
    viewport.to(from + Vec2::new(10.0, 0.0));
    viewport.to(to);
    viewport.release();
    assert!(viewport.refused.is_empty(), "{:?}", viewport.refused);
    assert_eq!(viewport.steps(), ["Move"]);
    let keys = &viewport.state.read().tools.path().look().expect("a path").keys;
    let now = keys.iter().find(|key| key.0 == time).expect("the key is there").1;
    assert!(seen(&viewport, now).distance(to) < 0.1, "{} is not {to}", seen(&viewport, now));
    viewport.command(Id::Undo);
    let keys = &viewport.state.read().tools.path().look().expect("a path").keys;
    let now = keys.iter().find(|key| key.0 == time).expect("the key is there").1;
    assert!(now.distance(place) < 1e-5);
    // Escape cancels a drag.
    viewport.press(from);
    viewport.to(to);
    assert_eq!(viewport.steps(), ["Move"]);
    viewport.key(Key::Escape);
    viewport.release();
    assert!(viewport.steps().is_empty());
}

#[test]
fn ghosts_are_drawn_before_and_after_within_the_take() {
    let mut viewport = tip();
    viewport.command(Id::ToggleGhosts);
    let ghosts = GhostSettings { shown: true, count: [2, 3], step: 6, keys: false, skin: false };
    viewport.state.execute(Request::Ghosts(ghosts));
    viewport.state.execute(Request::Seek(0.5));
    viewport.state.begin_frame(viewport.state.read().now);
    let mut times = Vec::new();
    viewport.state.read().ghost_times(&mut times);
    let places: Vec<i32> = times.iter().map(|time| time.1).collect();
    assert_eq!(places, [-1, -2, 1, 2]);
    for (time, place) in &times {
        assert!((time - (0.5 + *place as f32 * 0.2)).abs() < 1e-4, "{time} {place}");
    }
    viewport.command(Id::PlayPause);
    viewport.state.read().ghost_times(&mut times);
    assert!(times.is_empty(), "not while time passes");
    let odd = GhostSettings { count: [9999, 0], step: 0, ..ghosts };
    viewport.state.execute(Request::Ghosts(odd));
    assert_eq!(viewport.state.read().settings.tools.ghosts.count, [GhostSettings::MOST[0], 0]);
    assert_eq!(viewport.state.read().settings.tools.ghosts.step, 1);
}

#[test]
fn with_ik_on_a_dragged_path_key_moves_its_chain_and_pinned_bones_stay() {
    let mut viewport = tip();
    viewport.command(Id::ToggleIk);
    let (time, place) =
        *viewport.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    let stood = at(&mut viewport, time);
    let from = seen(&viewport, place);
    let root = viewport.state.read().posed.animation().expect("posed").to_root()[0].w_axis.truncate();
    // Away from the gizmo, which is at the joint's position at the playhead.
    at(&mut viewport, 0.0);
    // Towards the root, so that it can be reached.
    let to = from + (seen(&viewport, root) - from) * 0.3;
    viewport.press(from);
    viewport.to(from + (to - from) * 0.4);
    viewport.to(to);
    viewport.release();
    assert!(viewport.refused.is_empty(), "{:?}", viewport.refused);
    assert_eq!(viewport.steps().len(), 1, "{:?}", viewport.steps());
    let after = at(&mut viewport, time);
    assert_eq!(after[2].translation, stood[2].translation, "not pulled off its parent");
    assert!(after[0].rotation != stood[0].rotation && after[1].rotation != stood[1].rotation, "they follow");
    let keys = &viewport.state.read().tools.path().look().expect("a path").keys;
    let now = keys.iter().find(|key| key.0 == time).expect("the key is there").1;
    assert!(seen(&viewport, now).distance(to) < 0.5, "{} is not {to}", seen(&viewport, now));
    // The root moves along its path, and a pinned tip stays where it was at that time.
    let mut viewport = ViewportHarness::new(load);
    viewport.state.execute(Request::Select(Some(2)));
    viewport.command(Id::Pin);
    viewport.state.execute(Request::Select(Some(0)));
    at(&mut viewport, 0.5);
    viewport.command(Id::Key);
    viewport.command(Id::ToolSelect);
    viewport.command(Id::TogglePath);
    let key = viewport.state.read().tools.path().look().expect("a path").keys.last().copied();
    let (time, place) = key.expect("a key");
    let tip_at = |viewport: &mut ViewportHarness| {
        at(viewport, time);
        viewport.state.read().posed.animation().expect("posed").to_root()[2].w_axis.truncate()
    };
    let stood = tip_at(&mut viewport);
    at(&mut viewport, 0.0);
    let from = seen(&viewport, place);
    viewport.press(from);
    for part in 1..=4 {
        // Towards the tip, which is nearly as far away as the arm is long.
        viewport.to(from + Vec2::new(2.0, -3.0) * part as f32);
    }
    viewport.release();
    assert_eq!(viewport.steps().len(), 2, "{:?}", viewport.steps());
    assert!(tip_at(&mut viewport).distance(stood) < 1e-3, "{} is not {stood}", tip_at(&mut viewport));
}

#[test]
fn a_path_key_is_hit_before_gizmo_handles_but_not_before_the_gizmo_center() {
    let mut viewport = tip();
    viewport.command(Id::ToolRotate);
    let path = Arc::clone(viewport.state.read().tools.path().look().expect("a path"));
    let &(time, place) = path.keys.last().expect("a key");
    let key = seen(&viewport, place);
    let near = path.points.iter().map(|&(time, joint)| (time, seen(&viewport, joint).distance(key)));
    let (beside, far) =
        near.clone().find(|(_, far)| (20.0..70.0).contains(far)).expect("a time near the key");
    at(&mut viewport, beside);
    viewport.to(key);
    assert_eq!(
        viewport.state.read().tools.controls().path().hovered(),
        Some(time),
        "{far} points from the middle"
    );
    assert_eq!(
        viewport.state.read().tools.controls().gizmo().gizmo.hovered(),
        None,
        "one thing lies under the pointer"
    );
    viewport.press(key);
    viewport.to(key + Vec2::new(9.0, 6.0));
    viewport.release();
    assert_eq!(viewport.steps(), ["Move"]);
    viewport.command(Id::Undo);
    // At the time of the key, the center of the gizmo covers it.
    at(&mut viewport, time);
    viewport.press(key);
    viewport.to(key + Vec2::new(9.0, 6.0));
    viewport.release();
    assert_eq!(viewport.steps(), ["Rotate"]);
}

#[test]
fn path_keys_of_an_unlocked_bone_can_be_dragged_in_any_selection() {
    let mut viewport = tip();
    viewport.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 1, true)));
    let select = |viewport: &mut ViewportHarness, bones: &[u32]| {
        viewport.state.execute(Request::SelectBones(bones.to_vec(), Choice::Replace));
        viewport.state.begin_frame(viewport.state.read().now);
        viewport.state.read().tools.controls().path().is_editable()
    };
    // The bone that was selected last is the active one, whose path is shown.
    for (bones, wanted) in [(&[2, 1][..], false), (&[2], true), (&[2, 1], false), (&[1, 2], true)] {
        assert_eq!(select(&mut viewport, bones), wanted, "{bones:?}");
    }
}

/// The poses at a time.
fn at(viewport: &mut ViewportHarness, time: f32) -> Vec<dragonfly_anim::data::Transform> {
    viewport.state.execute(Request::Seek(time));
    viewport.state.begin_frame(viewport.state.read().now);
    viewport.state.read().posed.animation().expect("posed").poses().to_vec()
}
