//! The dialogs for root motion, loops, mirroring and retargeting send the edits that they show.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::prompts::Overlay;
use dragonfly_document::bones::BodySide;
use dragonfly_document::edit::{BoneRef, Edit, TRAVEL, TravelPart};
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;

/// Clicks the button with this label.
fn click(animator: &mut Animator, label: &str) {
    animator.steps(2);
    let at = animator.harness.get_by_label(label).rect().center();
    animator.click(at);
    animator.steps(2);
}

#[test]
fn travel_is_removed_and_put_back_by_the_buttons_of_the_dialog() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::RootMotion));
    assert_eq!(animator.harness.state().state.read().overlay, Some(Overlay::RootMotion));
    let take = |animator: &Animator| animator.edited.adapter().slots()[0].clone();
    let before = take(&animator);
    // The path is on the ground, and has no keys to drag.
    let path = animator.harness.state().state.read().tools.path().look().cloned().expect("a path");
    assert!(path.keys.is_empty() && path.points.iter().all(|(_, place)| place.y == 0.0));
    click(&mut animator, "In place");
    let Some(Edit::RemoveTravel(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!(edit.parts, TravelPart::usual());
    assert!(take(&animator).original.extras.get(TRAVEL).is_some());
    click(&mut animator, "Put back");
    assert!(matches!(animator.edits()[..], [Edit::RemoveTravel(_), Edit::RestoreTravel(_)]));
    assert!(take(&animator).original.extras.get(TRAVEL).is_none());
    for (was, is) in before.result.tracks.iter().zip(&take(&animator).result.tracks) {
        for key in 0..was.translation.len() {
            let time = was.translation.times[key];
            let is = dragonfly_anim::sample::sample_channel(&is.translation, glam::Vec3::ZERO, time);
            assert!(was.translation.value(key).unwrap().distance(is) < 1e-4, "bone {}, key {key}", was.bone);
        }
    }
}

#[test]
fn one_side_is_mirrored_to_the_other_by_the_dialog() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::MirrorDialog));
    click(&mut animator, "Left to right");
    animator.request(Request::Select(Some(3)));
    click(&mut animator, "Selected bones");
    click(&mut animator, "Mirror take");
    let Some(Edit::MirrorTake(edit)) = animator.edits().last().copied() else {
        panic!("no edit: {}", animator.said())
    };
    assert_eq!((edit.side, &edit.bones[..]), (Some(BodySide::Left), &[BoneRef::Index(3)][..]));
    assert!(edit.pairs.is_empty());
}

#[test]
fn without_a_source_the_dialog_for_retargeting_has_only_a_field_for_its_path() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::Retarget));
    animator.harness.run_steps(2);
    assert!(animator.harness.query_by_label("Read").is_some());
    assert!(animator.harness.query_by_label("Add take").is_none());
}

#[test]
fn a_loop_is_closed_shifted_and_found_by_the_dialog() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::LoopDialog));
    assert_eq!(animator.harness.state().state.read().overlay, Some(Overlay::Loop));
    let rate = animator.harness.state().state.read().frame_rate as f32;
    click(&mut animator, "Close loop");
    let Some(Edit::CloseLoop(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!((edit.frames, edit.rate, edit.contacts.len()), (8, Some(rate), 0));
    assert!(animator.harness.query_by_label("The end leads into the start").is_some());
    let edits = animator.edits().len();
    click(&mut animator, "Shift");
    assert_eq!(animator.edits().len(), edits, "by 0 frames");
    let field = animator.harness.get_by_label("all keys by").rect().center();
    animator.drag(field, field + egui::vec2(60.0, 0.0));
    animator.release(field + egui::vec2(60.0, 0.0));
    click(&mut animator, "Shift");
    let Some(Edit::ShiftLoop(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    let frames = edit.by * rate;
    assert!(frames > 0.5 && (frames - frames.round()).abs() < 1e-3, "{frames}");
    click(&mut animator, "Find loops");
    animator.steps(20);
    let found = animator.harness.query_all_by_label_contains("mm apart").count();
    assert!(found > 1, "{found}");
    let first =
        animator.harness.query_all_by_label_contains("mm apart").next().expect("a loop").rect().center();
    animator.click(first);
    let range = animator.harness.state().state.read().keys.range().expect("a play range");
    assert!(range[1] - range[0] > 0.45, "{range:?}");
    let edits = animator.edits().len();
    let trim = animator.harness.query_all_by_label("Trim").next().expect("a button").rect().center();
    animator.click(trim);
    let Some(Edit::TrimTake(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!((animator.edits().len(), [edit.from, edit.to]), (edits + 1, range));
}

#[test]
fn the_path_of_a_source_is_typed_at_once_or_chosen_in_the_dialog_of_the_system() {
    use dragonfly::panels::{Effect, FileAction, FileChoice};
    use dragonfly_document::{DocumentMessage, Source};
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::Retarget));
    animator.steps(2);
    animator.harness.event(egui::Event::Text("fox.glb".to_owned()));
    animator.steps(2);
    animator.harness.key_press(egui::Key::Enter);
    animator.steps(2);
    let reads = |effect: &Effect| {
        let wanted = std::path::Path::new("fox.glb");
        matches!(effect, Effect::File(FileAction::Send(DocumentMessage::ReadSource(Source::File(path)))) if path == wanted)
    };
    let effects = &animator.harness.state().effects;
    assert!(effects.iter().any(reads), "{:?}", effects.last());
    click(&mut animator, "Choose file…");
    let effects = &animator.harness.state().effects;
    assert!(matches!(effects.last(), Some(Effect::Choose(FileChoice::RetargetSource, _))), "{effects:?}");
}
