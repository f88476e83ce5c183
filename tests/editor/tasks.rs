//! Tasks of an animator with poses, keys and takes, done with mouse and keyboard alone, in no more actions than in Blender.

use crate::task_counts::{BONE, User};
use dragonfly::panels::commands::{KeySettings, Preset};
use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use glam::Quat;
use std::sync::Arc;

#[test]
fn playing_changing_the_take_and_undo_are_one_action_each() {
    let mut user = User::new();
    let read = |user: &User| {
        let context = user.animator.harness.state().state.read();
        (context.playback.moves(context.now), context.playback.take)
    };
    user.chord(Modifiers::NONE, Key::Space);
    assert!(read(&user).0);
    user.chord(Modifiers::NONE, Key::PageDown);
    assert_eq!(read(&user).1, Some(1));
    user.has_done("play, and change the take", 0);
}

#[test]
fn a_bone_is_rotated_by_a_typed_number_in_two_actions() {
    let mut user = User::new();
    user.select_bone();
    user.typed("Rotation change X", "30");
    user.has_done("choose a bone, and rotate it by a typed number", 0);
    assert_eq!(user.animator.edited.steps().1, 1);
}

#[test]
fn an_arm_is_raised_over_the_whole_take_in_four_actions_exactly() {
    let mut user = User::new();
    let before = user.take(0);
    user.select_bone();
    user.click("Edits apply to: This frame");
    user.actions += 1;
    user.animator.harness.get_by_label_contains("Edit whole take").click();
    user.animator.steps(3);
    user.typed("Rotation change X", "20");
    user.has_done("choose a bone, and rotate it over the whole take", 0);
    let after = user.take(0);
    let [before, after] = [before, after].map(|take| take.tracks[BONE.1 as usize].rotation.clone());
    let wanted = Quat::from_rotation_x(20_f32.to_radians());
    for (old, new) in before.values.iter().zip(after.values.iter()) {
        assert!((*new * old.inverse()).angle_between(wanted) < 1e-3);
    }
}

#[test]
fn a_jittering_curve_is_smoothed_in_three_actions_with_the_choice_of_the_bone() {
    let mut user = User::new();
    user.select_bone();
    let before = user.take(0);
    user.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::A);
    user.chord(Modifiers::ALT, Key::O);
    // Blender: Alt+O over a graph editor that shows the selected keys.
    user.has_done("choose a bone, and smooth its curves", 0);
    assert_ne!(
        before.tracks[BONE.1 as usize].rotation.values,
        user.take(0).tracks[BONE.1 as usize].rotation.values
    );
}

#[test]
fn a_loop_is_closed_in_three_actions_and_ends_in_its_first_pose() {
    let mut user = User::new();
    user.chord(Modifiers::NONE, Key::Home);
    user.menu("Take", "Close loop from here");
    user.has_done("make a loop seamless", 0);
    let take = user.take(0);
    for track in &take.tracks {
        if let (Some(first), Some(last)) =
            (track.rotation.value(0), track.rotation.value(track.rotation.len() - 1))
        {
            assert!(first.angle_between(last) < 2e-3, "bone {}", track.bone);
        }
    }
}

#[test]
fn a_pose_is_copied_to_another_take_in_three_actions_and_mirrored_in_two() {
    let mut user = User::new();
    user.select_bone();
    let chosen = user.actions;
    let text = user.copy();
    user.chord(Modifiers::NONE, Key::PageDown);
    user.paste(text.clone(), false);
    user.has_done("copy a pose to another take", chosen);
    assert_eq!(user.animator.edited.steps().1, 1);
    let before = user.actions;
    let _copied = user.copy();
    user.paste(text, true);
    user.has_done("copy a pose, and paste it mirrored", before);
}

#[test]
fn ghosts_and_the_motion_path_are_one_action_each() {
    let mut user = User::new();
    user.select_bone();
    let chosen = user.actions;
    user.chord(Modifiers::SHIFT, Key::G);
    user.chord(Modifiers::SHIFT, Key::P);
    user.has_done("ghosts, and the motion path", chosen);
    let tools = &user.animator.harness.state().state.read().settings.tools;
    assert!(tools.ghosts.shown && tools.path);
}

#[test]
fn keys_are_selected_moved_duplicated_and_deleted_with_one_or_two_actions_each() {
    let mut user = User::new();
    user.select_bone();
    let chosen = user.actions;
    let animator = &mut user.animator;
    let (from, to) = (animator.at(animator.key(3) - 0.04, 4), animator.at(animator.key(5) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 3, "a box is one drag");
    let at = animator.at(animator.key(4), 2);
    let by = vec2(animator.at(animator.key(1), 0).x - animator.at(0.0, 0).x, 0.0);
    animator.drag(at, at + by);
    animator.release(at + by);
    assert_eq!(animator.edited.steps().1, 1, "a move is one drag");
    user.actions += 2;
    let before = user.take(0).keys();
    user.chord(Modifiers::NONE, Key::Delete);
    assert_eq!(user.take(0).keys(), before - 3);
    user.chord(Modifiers::COMMAND, Key::Z);
    assert_eq!(user.take(0).keys(), before);
    user.has_done("select keys with a box, move, delete, undo", chosen);
}

#[test]
fn a_bone_is_found_by_name_in_three_actions() {
    let mut user = User::new();
    user.chord(Modifiers::COMMAND, Key::F);
    user.actions += 1;
    user.animator.harness.event(Event::Text("left_mid".to_owned()));
    user.animator.steps(3);
    user.chord(Modifiers::NONE, Key::Enter);
    user.has_done("find a bone by its name", 0);
    let context = user.animator.harness.state().state.read();
    let bone = context.selected().expect("a bone");
    assert!(context.bone_name(bone).contains("left_mid"));
}

#[test]
fn rotating_30_degrees_about_z_takes_the_four_keystrokes_of_blender() {
    let mut user = User::new();
    let keys = KeySettings { preset: Preset::Blender, ..KeySettings::default() };
    user.animator.request(dragonfly::panels::Request::Keys(keys));
    user.select_bone();
    let chosen = user.actions;
    // The pointer is over the viewport.
    let center = user.animator.harness.state().state.read().viewport.center();
    user.animator.move_to(center);
    user.chord(Modifiers::NONE, Key::R);
    user.chord(Modifiers::NONE, Key::Z);
    user.actions += 1;
    for digit in [Key::Num3, Key::Num0] {
        user.animator.harness.key_press(digit);
        user.animator.steps(1);
    }
    user.chord(Modifiers::NONE, Key::Enter);
    user.has_done("rotate by 30° about Z (shortcuts of Blender)", chosen);
}

#[test]
fn a_part_is_slowed_down_in_two_drags_and_no_key_comes_between_others() {
    let mut user = User::new();
    user.select_bone();
    let chosen = user.actions;
    let before = user.animator.times(BONE.1 as usize);
    let animator = &mut user.animator;
    let (from, to) = (animator.at(animator.key(2) - 0.04, 4), animator.at(animator.key(6) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 5);
    let grip = animator.harness.get_by_label("Scale keys by their end").rect().center();
    let [start, end] = [animator.key(2), animator.key(6)];
    let by = animator.at(end + (end - start), 0).x - animator.at(end, 0).x;
    animator.harness.event(Event::Key {
        key: Key::Num2,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    });
    animator.drag(grip, grip + vec2(by, 0.0));
    animator.release(grip + vec2(by, 0.0));
    user.actions += 2;
    // Blender: box select, S with a typed number, G for the keys after it, which are selected by another box.
    user.has_done("slow down a part, with the keys after it", chosen);
    let after = user.animator.times(BONE.1 as usize);
    assert_eq!((after.len(), user.animator.edited.steps().1), (before.len(), 1));
    let grown = after[6] - after[2] - (before[6] - before[2]);
    assert!(grown > 0.1, "{grown}");
    for key in 0..before.len() {
        let share = (key.clamp(2, 6) - 2) as f32 / 4.0;
        assert!((after[key] - before[key] - grown * share).abs() < 1e-3, "key {key}");
    }
}

#[test]
fn the_keys_of_a_bone_get_auto_tangents_in_two_actions() {
    let mut user = User::new();
    let keys = KeySettings { preset: Preset::Blender, ..KeySettings::default() };
    user.animator.request(dragonfly::panels::Request::Keys(keys));
    user.select_bone();
    user.animator
        .request(dragonfly::panels::Request::Command(dragonfly::panels::commands::Id::SelectAllKeys));
    let chosen = user.actions;
    let at = user.animator.keys().center();
    user.animator.move_to(at);
    user.chord(Modifiers::NONE, Key::V);
    user.actions += 1;
    user.animator.harness.get_by_label_contains("Auto tangents").click();
    user.animator.steps(3);
    // Blender: V and the entry of the menu.
    user.has_done("auto tangents of the selected keys", chosen);
    let track = &user.take(0).tracks[BONE.1 as usize];
    assert_eq!(track.rotation.interpolation, dragonfly_anim::data::Interpolation::CubicSpline);
}

#[test]
fn saving_is_one_action() {
    use dragonfly::panels::{Effect, FileAction};
    use dragonfly_document::DocumentMessage;
    let mut user = User::new();
    user.select_bone();
    user.typed("Rotation change X", "30");
    let chosen = user.actions;
    user.chord(Modifiers::COMMAND, Key::S);
    let saves = |effect: &Effect| {
        matches!(effect, Effect::File(FileAction::Send(DocumentMessage::Save(_)) | FileAction::Where { .. }))
    };
    let effects = &user.animator.harness.state().effects;
    assert!(effects.iter().any(saves), "{:?}", effects.last());
    user.has_done("save", chosen);
}

#[test]
fn feet_are_locked_over_a_take_in_three_actions() {
    let source = dragonfly_document::Source::File(dragonfly_kit::folder::data("gltf/Fox.glb"));
    let loaded = dragonfly_document::load_model(&source, &mut |_| {}, &Default::default()).expect("the fox");
    let view = dragonfly_document::View::opened(1, Arc::new(loaded));
    let mut user = User::with(view);
    let before = user.take(0);
    user.menu("Take", "Contacts");
    user.actions += 1;
    user.animator.harness.get_by_label_contains("Lock feet in contacts").click();
    user.animator.steps(3);
    // Blender: at least ten, with a rig first.
    user.has_done("lock the feet over a take", 0);
    assert_eq!(user.animator.edited.steps().1, 1, "{}", user.animator.said());
    assert_ne!(before.tracks, user.take(0).tracks);
}
