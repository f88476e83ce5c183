//! The sliders and commands of in-betweens: live while dragged, one step of undo, nothing left of a cancelled drag.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::{self, Category, Id};
use dragonfly_anim::data::Take;
use dragonfly_document::Change;
use dragonfly_document::edit::{
    BlendKeys, BonePose, BoneRef, CurveFilter, Edit, KeyTarget, SetPose, TakeRef,
};
use egui::{Key, Pos2, pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::Quat;
use std::sync::Arc;

/// Creates a user who sees the sliders instead of the curves, with the keys 3 to 5 of a bone selected.
fn animator() -> Animator {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("In-between").click();
    animator.steps(3);
    let (from, to) = (animator.at(animator.key(3) - 0.04, 3), animator.at(animator.key(5) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 3);
    animator
}

/// Returns the place on a slider: -1 is its left end, 1 its right end.
fn place(animator: &Animator, name: &str, at: f32) -> Pos2 {
    let rect = animator.harness.get_by_label(&format!("{name} slider")).rect();
    pos2(rect.center().x + at * rect.width() / 2.0, rect.center().y)
}

/// Makes the window large enough for all sliders.
fn enlarge(animator: &mut Animator) {
    animator.harness.set_size(egui::vec2(1920.0, 1400.0));
    animator.steps(4);
}

/// Types the number of a slider.
fn type_number(animator: &mut Animator, name: &str, number: &str) {
    animator.harness.get_by_role_and_label(egui::accesskit::Role::SpinButton, name).click();
    animator.steps(2);
    animator.harness.event(egui::Event::Text(number.to_owned()));
    animator.steps(2);
    animator.harness.key_press(Key::Enter);
    animator.steps(4);
}

fn shown(animator: &Animator) -> Arc<Take> {
    Arc::clone(&animator.edited.adapter().slots()[0].result)
}

fn rotations(animator: &Animator) -> Vec<Quat> {
    shown(animator).tracks[3].rotation.values.to_vec()
}

fn steps(animator: &Animator) -> usize {
    animator.edited.steps().0.len()
}

#[test]
fn a_slider_moves_the_selected_keys_while_it_is_dragged_and_leaves_one_step() {
    let mut animator = animator();
    let before = rotations(&animator);
    let (from, to) = (place(&animator, "Tween", 0.0), place(&animator, "Tween", 2.0 / 3.0));
    animator.drag(from, to);
    let during = rotations(&animator);
    // 100 %: at the key after the selected ones.
    for key in 0..before.len() {
        let wanted = if (3..=5).contains(&key) { before[6] } else { before[key] };
        assert!(during[key].dot(wanted).abs() > 1.0 - 1e-5, "key {key}");
    }
    animator.release(to);
    assert_eq!(rotations(&animator), during);
    assert_eq!(steps(&animator), 1);
    assert_eq!(animator.selected(), 3);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(rotations(&animator), before);
}

#[test]
fn escape_cancels_the_drag_of_a_slider_and_nothing_is_left_of_it() {
    let mut animator = animator();
    let before = shown(&animator);
    let (from, to) = (place(&animator, "Push, pull", 0.0), place(&animator, "Push, pull", 0.6));
    animator.drag(from, to);
    assert_ne!(shown(&animator), before);
    animator.harness.key_press(Key::Escape);
    animator.steps(3);
    assert_eq!(shown(&animator), before);
    animator.move_to(from);
    animator.release(from);
    assert_eq!((shown(&animator), steps(&animator)), (before, 0));
}

#[test]
fn a_slider_that_returns_to_where_it_was_leaves_no_step() {
    let mut animator = animator();
    let before = shown(&animator);
    let (from, to) = (place(&animator, "Relax", 0.0), place(&animator, "Relax", 0.5));
    animator.drag(from, to);
    assert_ne!(shown(&animator), before);
    animator.move_to(from);
    animator.release(from);
    assert_eq!((shown(&animator), steps(&animator)), (before, 0));
}

#[test]
fn a_typed_number_is_applied_once() {
    let mut animator = animator();
    type_number(&mut animator, "Smooth", "1.5");
    assert_eq!(steps(&animator), 1);
    let [Edit::FilterKeys(edit)] = animator.edits()[..] else { panic!("{:?}", animator.edits()) };
    let frame = 1.0 / animator.harness.state().state.read().frame_rate as f32;
    assert_eq!(edit.filter, CurveFilter::Gaussian(1.5 * frame));
}

#[test]
fn without_selected_keys_the_sliders_do_nothing_and_say_why() {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("In-between").click();
    animator.steps(3);
    let (from, to) = (place(&animator, "Tween", 0.0), place(&animator, "Tween", 0.5));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.changes.len(), 0);
    assert!(animator.harness.query_by_label_contains("No key is selected").is_some());
}

#[test]
fn every_command_of_in_betweens_changes_the_selected_keys_in_one_step() {
    for command in commands::of(Category::InBetween) {
        let mut animator = animator();
        let before = shown(&animator);
        // A peak, so that there is one to remove.
        if command.id == Id::RemovePeaks {
            let time = animator.key(4);
            let far = BonePose {
                bone: BoneRef::Index(3),
                translation: None,
                rotation: Some([1.0, 0.0, 0.0, 0.0]),
                scale: None,
            };
            let peak = SetPose { take: TakeRef::Index(0), time, poses: vec![far], unstep: false };
            animator.request(Request::Change(Change::Edit(Edit::SetPose(peak), None)));
        }
        // After a full turn the next key has the other sign.
        if command.id == Id::UnrollKeys {
            animator.request(Request::Command(Id::FullTurn));
        }
        if command.id == Id::BlendToPose {
            animator.request(Request::Command(Id::CopyPose));
        }
        let (peaked, done) = (shown(&animator), steps(&animator));
        animator.request(Request::Command(command.id));
        assert_eq!(steps(&animator), done + 1, "{}", command.title);
        let after = shown(&animator);
        // The keys are less than 12 per second, so nothing is faster than 6 Hz.
        if command.id != Id::SmoothButterworth {
            assert!(after != peaked, "{}", command.title);
        }
        for bone in (0..after.tracks.len()).filter(|&bone| bone != 3) {
            assert!(after.tracks[bone] == before.tracks[bone], "{}", command.title);
        }
        for _ in 0..steps(&animator) {
            animator.request(Request::Command(Id::Undo));
        }
        assert!(shown(&animator) == before, "{}", command.title);
    }
}

#[test]
fn the_tween_command_moves_keys_halfway_between_their_neighbors() {
    let mut animator = animator();
    animator.request(Request::Command(Id::TweenKeys));
    let [Edit::BlendKeys(BlendKeys { toward, factor, .. })] = animator.edits()[..] else {
        panic!("{:?}", animator.edits())
    };
    assert_eq!((toward, *factor), (&KeyTarget::Between(0.5), 1.0));
}

#[test]
fn the_palette_finds_the_tools_by_the_words_of_other_programs() {
    for (word, id) in [
        ("breakdown", Id::TweenKeys),
        ("in-between", Id::TweenKeys),
        ("exaggerate", Id::PushKeys),
        ("flatten", Id::PullKeys),
        ("average", Id::RelaxKeys),
        ("neighbor", Id::BlendToNext),
        ("time offset", Id::DelayKeys),
        ("jitter", Id::NoiseKeys),
        ("butterworth", Id::SmoothButterworth),
        ("low-pass", Id::SmoothButterworth),
        ("spikes", Id::RemovePeaks),
        ("bake", Id::BakeKeys),
        ("on twos", Id::ResampleKeys),
    ] {
        let command = commands::get(id);
        let text = format!("{} {}", command.title, command.help).to_lowercase();
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn keys_move_toward_the_pose_that_was_copied_at_another_frame() {
    let mut animator = animator();
    enlarge(&mut animator);
    let before = rotations(&animator);
    assert!(animator.harness.get_by_label("To pose").accesskit_node().is_read_only(), "no pose was copied");
    animator.request(Request::Seek(animator.key(20)));
    animator.request(Request::Command(Id::CopyPose));
    let (from, to) = (place(&animator, "To pose", 0.0), place(&animator, "To pose", 2.0 / 3.0));
    animator.drag(from, to);
    animator.release(to);
    let after = rotations(&animator);
    for key in 0..before.len() {
        let wanted = if (3..=5).contains(&key) { before[20] } else { before[key] };
        assert!(after[key].dot(wanted).abs() > 1.0 - 1e-5, "key {key}");
    }
    assert_eq!(steps(&animator), 1);
}

#[test]
fn full_turns_and_cycles_follow_their_sliders_as_whole_numbers_and_zero_leaves_no_trace() {
    for (name, keys) in [("Full turns", 2 * 4 * 4), ("Repeat", 4 * 2), ("Mirror", 4 * 2)] {
        let mut animator = animator();
        enlarge(&mut animator);
        let before = shown(&animator);
        let count = |animator: &Animator| rotations(animator).len();
        // 10 is at the right end of the slider.
        let (from, to) = (place(&animator, name, 0.0), place(&animator, name, 0.42));
        animator.drag(from, to);
        let during = count(&animator);
        if name == "Full turns" {
            // Four turns between three keys: a key at each quarter.
            assert!((keys - 2..=keys + 41).contains(&during), "{name}: {during} keys");
            assert!(during >= 41 + 2 * 15, "{name}: {during} keys");
        } else {
            assert_ne!(shown(&animator), before, "{name}");
        }
        animator.move_to(from);
        animator.release(from);
        assert_eq!(shown(&animator), before, "{name} back at zero");
        assert_eq!(steps(&animator), 0, "{name}");
    }
}

#[test]
fn keys_of_the_same_rotation_turn_about_the_axis_that_is_chosen() {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("In-between").click();
    animator.steps(3);
    animator.request(Request::Command(Id::CopyPose));
    animator.request(Request::Command(Id::SelectAllKeys));
    enlarge(&mut animator);
    type_number(&mut animator, "To pose", "100");
    let rotations_before = rotations(&animator);
    assert!(
        rotations_before.windows(2).all(|pair| pair[0].angle_between(pair[1]) < 1e-3),
        "the same rotations"
    );
    for (axis, direction) in [("X", glam::Vec3::X), ("Z", glam::Vec3::Z), ("Y", glam::Vec3::Y)] {
        animator.harness.get_by_label_contains("Turn axis").click();
        animator.steps(2);
        animator.harness.get_by_label(axis).click();
        animator.steps(2);
        type_number(&mut animator, "Full turns", "1");
        let keys = rotations(&animator);
        let turned = keys[0].inverse() * keys[1];
        let along = turned.xyz().normalize().dot(direction).abs();
        assert!(keys.len() > rotations_before.len() && along > 0.999, "{axis}: {turned}");
        animator.request(Request::Command(Id::Undo));
        assert_eq!(rotations(&animator), rotations_before);
    }
}

#[test]
fn the_reduce_slider_shows_the_number_of_keys_and_the_largest_error_before_it_is_released() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.harness.get_by_label("In-between").click();
    animator.steps(3);
    enlarge(&mut animator);
    let before = shown(&animator);
    let (from, to) = (place(&animator, "Reduce", -1.0), place(&animator, "Reduce", 0.5));
    animator.drag(from, to);
    animator.steps(3);
    let during = shown(&animator);
    assert!(during.keys() < before.keys(), "{} of {} keys", during.keys(), before.keys());
    let grouped = |keys: usize| format!("{}\u{2009}{:03}", keys / 1000, keys % 1000);
    let text = format!("{} → {} keys · ", grouped(before.keys()), grouped(during.keys()));
    assert!(animator.harness.query_all_by_label_contains(&text).count() > 0, "{text}");
    assert!(animator.harness.query_all_by_label_contains(" mm ").count() > 0);
    let limit = 7.5;
    let adapter = animator.edited.adapter();
    let settings = dragonfly_anim::reduce::ReduceSettings { tolerance: limit, ..Default::default() };
    let measured = dragonfly_anim::reduce::measure(&before, &during, adapter.skeleton(), &settings).unwrap();
    assert!(measured.largest.unwrap().millimeters <= f64::from(limit), "{measured:?}");
    animator.harness.key_press(Key::Escape);
    animator.steps(3);
    assert_eq!(shown(&animator), before);
    animator.release(to);
    assert_eq!(steps(&animator), 0);
}

#[test]
fn after_a_drag_the_status_line_says_what_the_whole_drag_did() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.harness.get_by_label("In-between").click();
    animator.steps(3);
    enlarge(&mut animator);
    let before = shown(&animator).keys();
    let (from, to) = (place(&animator, "Reduce", -1.0), place(&animator, "Reduce", 0.9));
    animator.drag(from, to);
    let first = animator.said();
    animator.release(to);
    animator.steps(2);
    let fewer = before - shown(&animator).keys();
    let said = animator.said();
    assert!(said.contains(&format!("  ·  {fewer} keys fewer  ·  ")), "{fewer} keys: {said}");
    assert_ne!(first, said, "the first move of the drag removed as many keys, so the test is not meaningful");
    // A bone that does not move, or does not turn, is not named as the one that does it most.
    assert!(!said.contains(" 0.00"), "{said}");
    assert_eq!(steps(&animator), 1);
}
