//! The motion path of the selected bone, its keys that can be dragged, and ghosts.

use crate::hands_rig::{Hand, PICTURE};
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

/// The tip of the arm is selected, and its path shown.
fn tip() -> Hand {
    let mut hand = Hand::new(load);
    hand.state.execute(Request::Select(Some(2)));
    hand.command(Id::TogglePath);
    hand
}

/// Returns the window position of a point in the scene.
fn seen(hand: &Hand, place: Vec3) -> Vec2 {
    let view = GizmoView::new(&hand.state.read().camera, Vec2::new(PICTURE[2], PICTURE[3]));
    view.to_screen(place.as_dvec3()).expect("before the eye").as_vec2() + Vec2::new(PICTURE[0], PICTURE[1])
}

#[test]
fn the_motion_path_follows_the_joint() {
    let mut hand = tip();
    let path = Arc::clone(hand.state.read().tools.path().look().expect("a path"));
    assert_eq!(path.points.len(), 31, "a second at 30 frames");
    for &(time, place) in path.points.iter().chain(&path.keys) {
        hand.state.execute(Request::Seek(time));
        hand.state.begin_frame(hand.state.read().now);
        let joint = hand.state.read().posed.animation().expect("posed").to_root()[2].w_axis.truncate();
        assert!(joint.distance(place) < 1e-4, "at {time}: {place} is not {joint}");
    }
    let travelled: f32 = path.points.windows(2).map(|pair| pair[0].1.distance(pair[1].1)).sum();
    assert!(travelled > 0.1, "it moves: {travelled}");
    hand.command(Id::TogglePath);
    assert!(hand.state.read().tools.path().look().is_none());
}

#[test]
fn a_key_of_the_path_is_dragged_to_the_pointer_in_one_step() {
    let mut hand = tip();
    let (time, place) = *hand.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    let from = seen(&hand, place);
    let to = from + Vec2::new(37.0, -21.0);
    hand.press(from);
    assert!(hand.state.read().tools.controls().edits());
    hand.to(from + Vec2::new(10.0, 0.0));
    hand.to(to);
    hand.release();
    assert!(hand.refused.is_empty(), "{:?}", hand.refused);
    assert_eq!(hand.steps(), ["Move"]);
    let keys = &hand.state.read().tools.path().look().expect("a path").keys;
    let now = keys.iter().find(|key| key.0 == time).expect("the key is there").1;
    assert!(seen(&hand, now).distance(to) < 0.1, "{} is not {to}", seen(&hand, now));
    hand.command(Id::Undo);
    let keys = &hand.state.read().tools.path().look().expect("a path").keys;
    let now = keys.iter().find(|key| key.0 == time).expect("the key is there").1;
    assert!(now.distance(place) < 1e-5);
    // Escape takes a drag back.
    hand.press(from);
    hand.to(to);
    assert_eq!(hand.steps(), ["Move"]);
    hand.key(Key::Escape);
    hand.release();
    assert!(hand.steps().is_empty());
}

#[test]
fn ghosts_are_drawn_before_and_after_within_the_take() {
    let mut hand = tip();
    hand.command(Id::ToggleGhosts);
    let ghosts = GhostSettings { shown: true, count: [2, 3], step: 6, keys: false, skin: false };
    hand.state.execute(Request::Ghosts(ghosts));
    hand.state.execute(Request::Seek(0.5));
    hand.state.begin_frame(hand.state.read().now);
    let mut times = Vec::new();
    hand.state.read().ghost_times(&mut times);
    let places: Vec<i32> = times.iter().map(|time| time.1).collect();
    assert_eq!(places, [-1, -2, 1, 2]);
    for (time, place) in &times {
        assert!((time - (0.5 + *place as f32 * 0.2)).abs() < 1e-4, "{time} {place}");
    }
    hand.command(Id::PlayPause);
    hand.state.read().ghost_times(&mut times);
    assert!(times.is_empty(), "not while time passes");
    let odd = GhostSettings { count: [9999, 0], step: 0, ..ghosts };
    hand.state.execute(Request::Ghosts(odd));
    assert_eq!(hand.state.read().settings.tools.ghosts.count, [GhostSettings::MOST[0], 0]);
    assert_eq!(hand.state.read().settings.tools.ghosts.step, 1);
}

#[test]
fn a_key_of_the_path_moves_the_chain_with_ik_on_and_pins_hold() {
    let mut hand = tip();
    hand.command(Id::ToggleIk);
    let (time, place) = *hand.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    let stood = at(&mut hand, time);
    let from = seen(&hand, place);
    let root = hand.state.read().posed.animation().expect("posed").to_root()[0].w_axis.truncate();
    // Away from the gizmo, which is at the joint's position at the playhead.
    at(&mut hand, 0.0);
    // Towards the root, so that it can be reached.
    let to = from + (seen(&hand, root) - from) * 0.3;
    hand.press(from);
    hand.to(from + (to - from) * 0.4);
    hand.to(to);
    hand.release();
    assert!(hand.refused.is_empty(), "{:?}", hand.refused);
    assert_eq!(hand.steps().len(), 1, "{:?}", hand.steps());
    let after = at(&mut hand, time);
    assert_eq!(after[2].translation, stood[2].translation, "not pulled off its parent");
    assert!(after[0].rotation != stood[0].rotation && after[1].rotation != stood[1].rotation, "they follow");
    let keys = &hand.state.read().tools.path().look().expect("a path").keys;
    let now = keys.iter().find(|key| key.0 == time).expect("the key is there").1;
    assert!(seen(&hand, now).distance(to) < 0.5, "{} is not {to}", seen(&hand, now));
    // The root moves along its path, and a pinned tip stays where it was at that time.
    let mut hand = Hand::new(load);
    hand.state.execute(Request::Select(Some(2)));
    hand.command(Id::Pin);
    hand.state.execute(Request::Select(Some(0)));
    at(&mut hand, 0.5);
    hand.command(Id::Key);
    hand.command(Id::ToolSelect);
    hand.command(Id::TogglePath);
    let key = hand.state.read().tools.path().look().expect("a path").keys.last().copied();
    let (time, place) = key.expect("a key");
    let tip_at = |hand: &mut Hand| {
        at(hand, time);
        hand.state.read().posed.animation().expect("posed").to_root()[2].w_axis.truncate()
    };
    let stood = tip_at(&mut hand);
    at(&mut hand, 0.0);
    let from = seen(&hand, place);
    hand.press(from);
    for part in 1..=4 {
        // Towards the tip, which is nearly as far away as the arm is long.
        hand.to(from + Vec2::new(2.0, -3.0) * part as f32);
    }
    hand.release();
    assert_eq!(hand.steps().len(), 2, "{:?}", hand.steps());
    assert!(tip_at(&mut hand).distance(stood) < 1e-3, "{} is not {stood}", tip_at(&mut hand));
}

#[test]
fn a_path_key_wins_over_gizmo_handles_but_not_over_the_center() {
    let mut hand = tip();
    hand.command(Id::ToolRotate);
    let path = Arc::clone(hand.state.read().tools.path().look().expect("a path"));
    let &(time, place) = path.keys.last().expect("a key");
    let key = seen(&hand, place);
    let near = path.points.iter().map(|&(time, joint)| (time, seen(&hand, joint).distance(key)));
    let (beside, far) =
        near.clone().find(|(_, far)| (20.0..70.0).contains(far)).expect("a time near the key");
    at(&mut hand, beside);
    hand.to(key);
    assert_eq!(
        hand.state.read().tools.controls().path().hovered(),
        Some(time),
        "{far} points from the middle"
    );
    assert_eq!(
        hand.state.read().tools.controls().gizmo().gizmo.hovered(),
        None,
        "one thing lies under the pointer"
    );
    hand.press(key);
    hand.to(key + Vec2::new(9.0, 6.0));
    hand.release();
    assert_eq!(hand.steps(), ["Move"]);
    hand.command(Id::Undo);
    // At the time of the key, the center of the gizmo covers it.
    at(&mut hand, time);
    hand.press(key);
    hand.to(key + Vec2::new(9.0, 6.0));
    hand.release();
    assert_eq!(hand.steps(), ["Rotate"]);
}

#[test]
fn path_keys_of_an_unlocked_bone_can_be_dragged_in_any_selection() {
    let mut hand = tip();
    hand.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 1, true)));
    let select = |hand: &mut Hand, bones: &[u32]| {
        hand.state.execute(Request::SelectBones(bones.to_vec(), Choice::Replace));
        hand.state.begin_frame(hand.state.read().now);
        hand.state.read().tools.controls().path().editable
    };
    // The last one is the active one, of which the path is.
    for (bones, wanted) in [(&[2, 1][..], false), (&[2], true), (&[2, 1], false), (&[1, 2], true)] {
        assert_eq!(select(&mut hand, bones), wanted, "{bones:?}");
    }
}

/// The poses at a time.
fn at(hand: &mut Hand, time: f32) -> Vec<dragonfly_anim::data::Transform> {
    hand.state.execute(Request::Seek(time));
    hand.state.begin_frame(hand.state.read().now);
    hand.state.read().posed.animation().expect("posed").poses().to_vec()
}
