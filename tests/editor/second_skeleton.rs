//! The second skeleton in the viewport: the end of a loop, the source of a retargeted take, a take of another file.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::Id;
use dragonfly::panels::compared::CompareWith;
use dragonfly::panels::prompts::Overlay;
use dragonfly::panels::{Effect, FileAction, Request};
use dragonfly_anim::data::HumanBone;
use dragonfly_document::{BoneMap, DocumentMessage, LoadedModel, Source};
use dragonfly_kit::document::fixture;
use dragonfly_picture::SecondSkeleton;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;

fn second(animator: &Animator) -> Option<SecondSkeleton> {
    animator.harness.state().state.read().second_skeleton()
}

fn click(animator: &mut Animator, label: &str) {
    animator.steps(2);
    let at = animator.harness.get_by_label(label).rect().center();
    animator.click(at);
    animator.steps(2);
}

/// Returns another model, whose bones have the names of those of the fixture.
fn other(takes: &[(&str, f32, usize)]) -> Arc<LoadedModel> {
    let view = fixture::view("other.glb", fixture::skeleton(1), takes);
    view.loaded
}

#[test]
fn while_the_loop_dialog_is_open_the_end_is_shown_over_the_start() {
    let mut animator = Animator::new(fixture::full());
    assert_eq!(second(&animator), None);
    animator.request(Request::Command(Id::LoopDialog));
    animator.steps(3);
    let take = animator.harness.state().state.read().shown_take().cloned().expect("a take");
    let shown = second(&animator).expect("a skeleton");
    assert!(Arc::ptr_eq(&shown.take, &take));
    assert_eq!((shown.times, shown.scale), (Some([take.end(), take.start]), 1.0));
    assert!(shown.other.is_none());
    click(&mut animator, "Show the end over the start");
    assert_eq!(second(&animator), None);
    click(&mut animator, "Show the end over the start");
    assert!(second(&animator).is_some());
    animator.request(Request::Overlay(None));
    animator.steps(2);
    assert_eq!(second(&animator), None, "the dialog is closed");
}

#[test]
fn the_source_of_a_take_stands_beside_the_model_while_the_dialog_is_open() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::Retarget));
    animator.steps(2);
    assert_eq!(second(&animator), None, "no file was read");
    let source = other(&[("Jump", 1.0, 5), ("Run", 2.0, 5)]);
    animator.harness.state_mut().state.source_read(Arc::clone(&source));
    animator.steps(3);
    let shown = second(&animator).expect("a skeleton");
    assert!(Arc::ptr_eq(&shown.take, &source.model.animation.takes[0]));
    assert_eq!(shown.times, None, "at the time of the playhead");
    let beside = shown.other.expect("another skeleton");
    assert!(Arc::ptr_eq(&beside.skeleton, &source.model.animation.skeleton));
    assert!(beside.first_of.is_empty() && shown.offset.x < 0.0, "{}", shown.offset);
    assert_eq!(beside.marked, None, "no bone is selected");
    // The bone that moves the selected one is emphasized, also after the map was corrected.
    animator.request(Request::Select(Some(5)));
    animator.steps(3);
    let marked =
        |animator: &Animator| second(animator).and_then(|shown| shown.other).and_then(|other| other.marked);
    assert_eq!(marked(&animator), Some(5), "both skeletons have the same names");
    let name = animator.harness.state().state.read().bone_name(5);
    let label = format!("The bone that moves {name}: {name}");
    click(&mut animator, &label);
    animator.harness.query_all_by_label("rests").last().expect("an entry").click();
    animator.steps(3);
    assert_eq!(marked(&animator), None, "nothing moves it");
    // Typed letters filter the menu, and Enter takes the first that is left.
    let wanted = animator.harness.state().state.read().bone_name(7);
    click(&mut animator, &format!("The bone that moves {name}: rests"));
    animator.harness.event(egui::Event::Text(wanted));
    animator.steps(3);
    animator.harness.key_press(egui::Key::Enter);
    animator.steps(3);
    assert_eq!(marked(&animator), Some(7));
    animator.harness.get_by_label("Take: Jump").click();
    animator.steps(3);
    // The last one is in the menu; the panel of takes has another.
    animator.harness.query_all_by_label("Run").last().expect("an entry").click();
    animator.steps(3);
    let shown = second(&animator).expect("a skeleton");
    assert!(Arc::ptr_eq(&shown.take, &source.model.animation.takes[1]));
    click(&mut animator, "Show the source beside the model");
    assert_eq!(second(&animator), None);
}

/// Parts of the body, and the bones of the fixture that are to be them; none is below another one.
const PARTS: [&str; 8] =
    ["hips", "spine", "head", "leftUpperArm", "rightUpperArm", "leftUpperLeg", "rightUpperLeg", "jaw"];

/// Makes the bones `first`, `first + 1` … of a model the parts of the body.
fn make_figure(loaded: &mut Arc<LoadedModel>, first: u32) {
    let loaded = Arc::make_mut(loaded);
    let human = |(bone, name): (u32, &&str)| HumanBone { name: (*name).to_owned(), bone };
    Arc::make_mut(&mut loaded.model).avatar.bones = (first..).zip(&PARTS).map(human).collect();
}

#[test]
fn parts_of_the_body_that_both_files_name_are_the_first_guess_of_the_map() {
    let mut view = fixture::full();
    make_figure(&mut view.loaded, 0);
    let mut animator = Animator::new(view);
    let mut source = fixture::view("other.glb", fixture::skeleton(4), &[("Jump", 1.0, 5)]).loaded;
    make_figure(&mut source, 3);
    let skeleton = &mut Arc::make_mut(&mut Arc::make_mut(&mut source).model).animation.skeleton;
    for (index, bone) in Arc::make_mut(skeleton).bones.iter_mut().enumerate() {
        bone.name = format!("S{index}");
    }
    animator.request(Request::Command(Id::Retarget));
    animator.steps(2);
    animator.harness.state_mut().state.source_read(source);
    animator.steps(3);
    let text = format!("{} of 64 bones move", PARTS.len());
    assert!(animator.harness.query_by_label_contains(&text).is_some(), "the bones have no name in common");
}

/// A bone of the source, and the bone of the model that it moves.
const PAIR: [&str; 2] = ["rib_00_left_tip", "rib_00_right_tip"];

#[test]
fn files_are_chosen_for_the_map_that_the_dialog_shows() {
    let mut animator = Animator::new(fixture::full());
    let unmapped = animator.harness.state_mut().state.execute(Request::ImportMapped(Vec::new()));
    assert_eq!(unmapped, None, "no map was chosen");
    animator.request(Request::Command(Id::Retarget));
    animator.steps(2);
    animator.harness.state_mut().state.source_read(other(&[("Jump", 1.0, 5)]));
    animator.steps(3);
    // A map that was read is the one that is shown.
    let map = r#"{"bone_map": 1, "bones": [["PAIR"]]}"#.replace("PAIR", &PAIR.join("\", \""));
    animator.harness.state_mut().state.map_read(BoneMap::parse(&map).expect("a map"));
    click(&mut animator, "Keep contacts");
    click(&mut animator, "Import files…");
    let files = vec!["/models/run.bvh".into()];
    let effect = animator.harness.state_mut().state.execute(Request::ImportMapped(files.clone()));
    let Some(Effect::File(FileAction::Send(DocumentMessage::ImportTakes(order)))) = effect else {
        panic!("{effect:?}")
    };
    assert_eq!((&order.files, order.contacts), (&files, false));
    assert_eq!(order.map.expect("a map").bones, [PAIR]);
    assert_eq!(animator.harness.state().state.read().overlay, None);
}

#[test]
fn a_take_of_another_file_is_compared_bone_by_bone_of_the_same_names() {
    let mut animator = Animator::new(fixture::full());
    let name = animator.harness.state().state.read().shown_take().expect("a take").name.clone();
    let file = other(&[("Jump", 1.0, 5), (&name, 2.0, 5)]);
    let effect = animator.harness.state_mut().state.compared_read(Arc::clone(&file));
    let Some(Effect::ShowPanel(panel)) = effect else { panic!("{effect:?}") };
    assert!(
        animator.harness.query_by_label_contains("Compare with: ").is_none(),
        "the panel is behind another"
    );
    animator.harness.state_mut().desk.show_panel(panel);
    animator.steps(3);
    let panels = animator.harness.state().state.read();
    assert_eq!(panels.compared, CompareWith::File(1), "the take of the same name");
    assert!(Arc::ptr_eq(panels.compared_take().expect("a take"), &file.model.animation.takes[1]));
    let own = &panels.loaded().expect("a model").model.animation.skeleton;
    let skeleton = &file.model.animation.skeleton;
    let pairs = panels.compared_file.first_of();
    assert_eq!(pairs.len(), skeleton.len());
    for (second, first) in pairs.iter().enumerate() {
        let first = first.map(|first| own.bones[first as usize].name.as_str());
        let same = own.find(&skeleton.bones[second].name).is_some();
        assert_eq!(first, same.then_some(skeleton.bones[second].name.as_str()));
    }
    let shown = second(&animator).expect("a skeleton");
    assert!(shown.other.is_some_and(|other| Arc::ptr_eq(&other.skeleton, skeleton)));
    // The panel comes to the front and lists the takes of the file.
    animator.harness.get_by_label_contains("Compare with: other.glb").click();
    animator.steps(3);
    animator.harness.get_by_label("other.glb – Jump").click();
    animator.steps(3);
    assert_eq!(animator.harness.state().state.read().compared, CompareWith::File(0));
    animator.request(Request::CompareWith(CompareWith::File(7)));
    animator.steps(3);
    assert!(animator.harness.query_by_label("The file has no such take").is_some());
}

#[test]
fn a_file_without_takes_or_without_a_common_bone_is_reported() {
    let mut animator = Animator::new(fixture::full());
    let effect = animator.harness.state_mut().state.compared_read(other(&[]));
    assert_eq!(effect, None, "there is nothing to show");
    assert!(animator.said().contains("other.glb has no takes"), "{}", animator.said());
    assert_eq!(animator.harness.state().state.read().compared, CompareWith::Nothing);
    let mut skeleton = fixture::skeleton(1);
    skeleton.bones.iter_mut().for_each(|bone| bone.name.insert_str(0, "strange "));
    let strange = fixture::view("other.glb", skeleton, &[("Jump", 1.0, 5)]).loaded;
    animator.harness.state_mut().state.compared_read(strange);
    assert!(animator.said().contains("No bone of other.glb has the name"), "{}", animator.said());
    animator.harness.get_by_label("Differences").click();
    animator.steps(3);
    assert!(animator.harness.query_by_label_contains("No bone of the file has the name").is_some());
}

#[test]
fn a_path_that_is_typed_is_read_by_the_document_to_be_compared() {
    let mut animator = Animator::new(fixture::full());
    let effect = animator.harness.state_mut().state.execute(Request::Command(Id::CompareFile));
    assert_eq!(effect, Some(Effect::CompareDialog));
    animator.request(Request::Overlay(Some(Overlay::ComparePath)));
    animator.steps(3);
    animator.harness.event(egui::Event::Text("/models/walk.glb".to_owned()));
    animator.steps(2);
    animator.harness.get_by_label("Compare").click();
    animator.steps(3);
    let source = Source::File("/models/walk.glb".into());
    let wanted = Effect::File(dragonfly::panels::FileAction::Send(DocumentMessage::ReadCompared(source)));
    assert!(animator.harness.state().effects.contains(&wanted), "{:?}", animator.harness.state().effects);
    assert_eq!(animator.harness.state().state.read().overlay, None);
}
