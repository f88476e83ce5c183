//! The layers of a take in the window: a new layer is active, poses become its keys, and the panels show these keys.

use crate::scene_lines::run;
use crate::timeline_rig::Animator;
use crate::workbench::{Window, Workbench, button};
use dragonfly::panels::commands::Id;
use dragonfly::panels::{FileAction, Request};
use dragonfly_anim::retarget::FigureOptions;
use dragonfly_anim::sample::sample_channel;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{AddLayer, BonePose, BoneRef, Edit, LayerKind, TakeRef};
use dragonfly_document::{DocumentMessage, RetargetOrder};
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;

/// Returns a window with two layers, the lower one with a key of bone 3.
fn animator() -> Animator {
    let mut animator = Animator::new(fixture::full());
    animator.harness.get_by_label("Layers").click();
    animator.steps(2);
    animator.request(Request::Select(Some(3)));
    animator.request(Request::Command(Id::AddLayer));
    pose(&mut animator, 0.4);
    animator
}

/// Rotates bone 3 as a gizmo or a number does.
fn pose(animator: &mut Animator, angle: f32) {
    let panels = animator.harness.state().state.read();
    let rotation = Some(glam::Quat::from_rotation_y(angle).to_array());
    let poses = vec![BonePose { bone: BoneRef::Index(3), translation: None, rotation, scale: None }];
    let edit = panels.pose_edit(poses).expect("an edit");
    animator.request(Request::Change(dragonfly_document::Change::Edit(edit, None)));
}

fn layers(animator: &Animator) -> Vec<(String, usize)> {
    let layers = animator.edited.adapter().slots()[0].layers().iter();
    layers.map(|layer| (layer.settings.name.clone(), layer.keys.result.keys())).collect()
}

fn shown_keys(animator: &Animator) -> usize {
    animator.harness.state().state.read().take().expect("keys").keys()
}

#[test]
fn a_new_layer_is_active_and_a_pose_becomes_its_key_and_not_one_of_the_take() {
    let mut animator = Animator::new(fixture::full());
    let before = Arc::clone(&animator.edited.adapter().slots()[0].result);
    animator.request(Request::Select(Some(3)));
    animator.request(Request::Command(Id::AddLayer));
    let panels = animator.harness.state().state.read();
    assert_eq!(panels.layer(), Some(0));
    assert!(matches!(panels.take_ref(), Some(TakeRef::Layer { .. })));
    pose(&mut animator, 0.4);
    assert_eq!(layers(&animator), [("Layer".to_owned(), 1)]);
    assert!(Arc::ptr_eq(&before, &animator.edited.adapter().slots()[0].result));
    assert_eq!(shown_keys(&animator), 1);
    let panels = animator.harness.state().state.read();
    let take = &panels.shown_take().expect("a take").name;
    let caption = format!("Shown take: {take}  ·  layer Layer");
    assert!(animator.harness.query_by_label(&caption).is_some());
    // The pose that is seen is the one that was asked for.
    let track = &panels.shown_take().expect("a take").tracks[3];
    let seen = sample_channel(&track.rotation, glam::Quat::IDENTITY, panels.time());
    assert!(seen.angle_between(glam::Quat::from_rotation_y(0.4)) < 1e-3, "{seen}");
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Command(Id::Undo));
    assert_eq!(shown_keys(&animator), before.keys());
    assert_eq!(animator.harness.state().state.read().layer(), None);
}

#[test]
fn keys_of_the_active_layer_are_selected_and_deleted_and_those_of_the_take_stay() {
    let mut animator = animator();
    let before = animator.edited.adapter().slots()[0].result.keys();
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.request(Request::Command(Id::DeleteKeys));
    assert_eq!(layers(&animator), [("Layer".to_owned(), 0)]);
    assert_eq!(animator.edited.adapter().slots()[0].result.keys(), before);
    animator.request(Request::ChooseLayer(None));
    assert_eq!(shown_keys(&animator), before);
    animator.request(Request::Command(Id::LayerAbove));
    assert_eq!((shown_keys(&animator), animator.said()), (0, "Layer Layer".to_owned()));
    animator.request(Request::Command(Id::LayerAbove));
    assert_eq!(animator.harness.state().state.read().layer(), None);
}

#[test]
fn no_key_stays_selected_when_another_layer_becomes_active() {
    let mut animator = animator();
    animator.request(Request::Command(Id::SelectAllKeys));
    assert!(!animator.harness.state().state.read().keys.selection().is_empty());
    animator.request(Request::ChooseLayer(None));
    assert!(animator.harness.state().state.read().keys.selection().is_empty());
}

#[test]
fn a_click_in_the_list_chooses_mutes_and_selects_the_base() {
    let mut animator = animator();
    animator.request(Request::Command(Id::AddOverrideLayer));
    assert_eq!(layers(&animator).len(), 2);
    let press = |animator: &mut Animator, name: &str| {
        // The upper line of a row has the name; the slider of the weight is below it.
        let rect = animator.harness.get_by_label(name).rect();
        animator.click(egui::pos2(rect.center().x, rect.top() + 8.0));
    };
    press(&mut animator, "Layer");
    assert_eq!(animator.harness.state().state.read().layer(), Some(0));
    press(&mut animator, "Mute Layer");
    let muted = |animator: &Animator| animator.edited.adapter().slots()[0].layers()[0].settings.is_muted;
    assert!(muted(&animator));
    press(&mut animator, "Mute Layer");
    assert!(!muted(&animator));
    press(&mut animator, "Solo Override");
    assert!(animator.edited.adapter().slots()[0].layers()[1].settings.is_solo);
    let base = animator.edited.adapter().slots()[0].result.name.clone();
    press(&mut animator, &format!("{base} (base)"));
    assert_eq!(animator.harness.state().state.read().layer(), None);
}

#[test]
fn the_weight_is_dragged_as_one_step_and_escape_leaves_no_trace() {
    let mut animator = animator();
    let steps = animator.edited.steps().0.len();
    let weight = |animator: &Animator| animator.edited.adapter().slots()[0].layers()[0].settings.weight;
    let slider = animator.harness.get_by_label("Weight of Layer, slider").rect();
    let (right, left) = (slider.right_center() - egui::vec2(1.0, 0.0), slider.center());
    animator.drag(right, left);
    animator.release(left);
    assert!((0.3..0.7).contains(&weight(&animator)), "{}", weight(&animator));
    assert_eq!(animator.edited.steps().0.len(), steps + 1);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(weight(&animator), 1.0);
    animator.drag(right, left);
    assert!(weight(&animator) < 0.9);
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(2);
    animator.release(left);
    assert_eq!((weight(&animator), animator.edited.steps().1), (1.0, steps));
}

#[test]
fn commands_copy_mask_move_and_merge_the_active_layer() {
    let mut animator = animator();
    animator.request(Request::Command(Id::DuplicateLayer));
    assert_eq!(layers(&animator), [("Layer".to_owned(), 1), ("Layer copy".to_owned(), 1)]);
    assert_eq!(animator.harness.state().state.read().layer(), Some(1));
    animator.request(Request::SelectBones(vec![2, 3], Choice::Replace));
    animator.request(Request::Command(Id::MaskLayer));
    let mask = |animator: &Animator| animator.edited.adapter().slots()[0].layers()[1].settings.bones.clone();
    assert_eq!(mask(&animator).as_deref(), Some(&[2, 3][..]));
    animator.request(Request::Command(Id::UnmaskLayer));
    assert_eq!(mask(&animator), None);
    animator.request(Request::Command(Id::MoveLayerDown));
    assert_eq!(layers(&animator)[0].0, "Layer copy");
    assert_eq!(animator.harness.state().state.read().layer(), Some(0), "the same layer stays active");
    animator.request(Request::Command(Id::KeyLayerWeight));
    assert_eq!(animator.edited.adapter().slots()[0].layers()[0].settings.weights.len(), 1);
    animator.request(Request::Command(Id::MoveLayerUp));
    animator.request(Request::Command(Id::MergeLayerDown));
    assert_eq!(layers(&animator).len(), 1);
    assert_eq!(animator.harness.state().state.read().layer(), Some(0), "the merged layer is active");
    animator.request(Request::Command(Id::MergeLayers));
    assert_eq!(layers(&animator).len(), 0);
    assert!(animator.edited.adapter().slots()[0].result.keys() > 0);
}

#[test]
fn another_take_becomes_a_layer_by_the_menu_of_the_panel() {
    let mut animator = Animator::new(fixture::full());
    for label in ["Layers", "More commands for layers", "Add layer from take"] {
        animator.harness.get_by_label(label).click();
        animator.steps(4);
    }
    let name = animator.edited.adapter().slots()[1].result.name.to_string();
    animator.harness.query_all_by_label(&name).last().expect("an entry").click();
    animator.steps(3);
    let layers = animator.edited.adapter().slots()[0].layers();
    assert_eq!(layers.len(), 1, "{}", animator.said());
    assert_eq!(layers[0].settings.name, name);
    assert!(layers[0].keys.result.keys() > 0);
}

#[test]
fn whole_takes_are_edited_as_takes_while_a_layer_is_active() {
    let mut animator = animator();
    animator.request(Request::Command(Id::ReverseTake));
    assert!(
        matches!(animator.edits().last(), Some(Edit::ReverseTake(edit)) if matches!(edit.take, TakeRef::Index(0)))
    );
    animator.request(Request::Command(Id::AddOverrideLayer));
    assert!(
        matches!(animator.edits().last(), Some(Edit::AddLayer(edit)) if edit.kind == LayerKind::Override)
    );
    assert_eq!(animator.edited.adapter().slots()[0].layers()[1].settings.name, "Override");
}

#[test]
fn offsets_are_pasted_into_additive_layers_only_and_poses_never() {
    let mut animator = animator();
    let key_text = |animator: &mut Animator| {
        animator.request(Request::Command(Id::SelectAllKeys));
        animator.request(Request::Command(Id::CopyKeys));
        let effects = &animator.harness.state().effects;
        let copied = effects.iter().rev().find_map(|effect| match effect {
            dragonfly::panels::Effect::Copy(text) => Some(text.clone()),
            _ => None,
        });
        copied.expect("a text")
    };
    let paste = |animator: &mut Animator, text: &str| {
        let before = animator.edited.steps().1;
        animator.request(Request::PastePose { text: text.to_owned(), mirrored: false });
        let said = animator.harness.state().state.read().status.last().map(|line| line.text.clone());
        (animator.edited.steps().1 - before, said.unwrap_or_default())
    };
    let offsets = key_text(&mut animator);
    let layer = animator.harness.state().state.read().layers()[0].keys.id;
    animator.request(Request::ChooseLayer(None));
    let (steps, said) = paste(&mut animator, &offsets);
    assert_eq!(steps, 0);
    assert!(said.contains("offsets of an additive layer"), "{said}");
    let poses = key_text(&mut animator);
    animator.request(Request::ChooseLayer(Some(layer)));
    let (steps, said) = paste(&mut animator, &poses);
    assert_eq!(steps, 0);
    assert!(said.contains("are poses"), "{said}");
    animator.request(Request::Seek(0.75));
    assert_eq!(paste(&mut animator, &offsets).0, 1, "into the layer they are of");
}

#[test]
fn undo_of_a_merge_into_the_take_makes_the_layer_active_again() {
    let mut animator = animator();
    animator.request(Request::Command(Id::MergeLayerDown));
    assert_eq!(animator.harness.state().state.read().layer(), None, "the take is edited");
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.harness.state().state.read().layer(), Some(0), "the next pose belongs to the layer");
    animator.request(Request::Command(Id::Redo));
    assert_eq!(animator.harness.state().state.read().layer(), None);
}

#[test]
fn a_layer_from_a_take_is_active_and_a_second_one_has_another_name() {
    let mut animator = Animator::new(fixture::full());
    let name = animator.edited.adapter().slots()[1].result.name.to_string();
    let names =
        |animator: &Animator| -> Vec<String> { layers(animator).into_iter().map(|(name, _)| name).collect() };
    animator.request(Request::AddLayerFrom(1));
    let panels = animator.harness.state().state.read();
    assert_eq!((names(&animator), panels.layer()), (vec![name.clone()], Some(0)));
    animator.request(Request::AddLayerFrom(1));
    let panels = animator.harness.state().state.read();
    assert_eq!((names(&animator), panels.layer()), (vec![name.clone(), format!("{name} 2")], Some(1)));
    animator.request(Request::AddLayerFrom(99));
    assert_eq!(layers(&animator).len(), 2, "there is no such take");
}

#[test]
fn a_layer_of_another_model_is_active_when_it_comes() {
    let mut animator = animator();
    animator.request(Request::ChooseLayer(None));
    let panels = animator.harness.state().state.read();
    let layer_of = panels.shown_take_ref();
    let over = layer_of.clone().expect("a take");
    let (pairs, options) = (Vec::new(), FigureOptions::default());
    let order = RetargetOrder { take: 0, layer_of, pairs, options };
    animator.request(Request::Answer(FileAction::Send(DocumentMessage::Retarget(order))));
    // The edit of the document when the take was computed.
    let layer = Edit::AddLayer(AddLayer::new(over, "Walk".to_owned(), LayerKind::Override));
    animator.request(Request::Change(dragonfly_document::Change::Edit(layer, None)));
    assert_eq!(animator.harness.state().state.read().layer(), Some(1));
    assert_eq!(layers(&animator)[1].0, "Walk");
}

#[test]
fn what_is_typed_replaces_the_name_of_a_layer_and_escape_gives_it_up() {
    let mut window = Workbench::full().window();
    window.get_by_label("Layers").click();
    window.run_steps(2);
    run(&mut window, Id::AddLayer);
    let name = |window: &Window| {
        window.state().edited.as_ref().expect("a document").adapter().slots()[0].layers()[0]
            .settings
            .name
            .clone()
    };
    for (end, expected) in [(egui::Key::Escape, "Layer"), (egui::Key::Enter, "Breath")] {
        // Longer than the clicks before count for a double click.
        window.run_steps(60);
        // The upper line of the row.
        let pos = window.get_by_label("Layer").rect().left_top() + egui::vec2(30.0, 8.0);
        window.event(egui::Event::PointerMoved(pos));
        window.run_steps(1);
        for pressed in [true, false, true, false] {
            button(&mut window, pos, pressed);
        }
        window.run_steps(3);
        assert!(window.query_by_label("Name of the layer").is_some());
        window.event(egui::Event::Text("Breath".to_owned()));
        window.run_steps(2);
        window.key_press(end);
        window.run_steps(3);
        assert!(window.query_by_label("Name of the layer").is_none());
        assert_eq!(name(&window), expected);
    }
}
