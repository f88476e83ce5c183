//! Tasks that every session has, done with mouse and keyboard alone, in no more actions than in Blender.

use crate::task_counts::User;
use crate::timeline_curves::place_of_z_key;
use dragonfly::panels::commands::{Id, KeySettings, Preset};
use dragonfly::panels::dialogs::PlaceQuestion;
use dragonfly::panels::prompts::Question;
use dragonfly::panels::{Effect, FileAction, Request};
use dragonfly_anim::data::Interpolation;
use dragonfly_document::{DocumentMessage, SaveOrder, SaveTo, Source, Then};
use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use std::path::Path;

#[test]
fn a_file_is_opened_by_its_path_in_two_actions() {
    let mut user = User::new();
    user.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
    // The cursor is in the field.
    user.actions += 1;
    user.animator.harness.event(Event::Text("walk.glb".to_owned()));
    user.animator.steps(2);
    user.animator.harness.key_press(Key::Enter);
    user.animator.steps(3);
    let opens = |effect: &Effect| {
        let is_wanted = |path: &Path| path == Path::new("walk.glb");
        matches!(effect, Effect::File(FileAction::Leave(Then::Open(Source::File(path)))) if is_wanted(path))
    };
    let effects = &user.animator.harness.state().effects;
    assert!(effects.iter().any(opens), "{effects:?}");
    user.has_done("open a file by its path", 0);
}

#[test]
fn the_sides_of_the_model_are_one_key_each() {
    let mut user = User::new();
    let back = |user: &User| user.animator.harness.state().state.read().camera.back();
    let mut seen = vec![back(&user)];
    for key in [Key::Num1, Key::Num3, Key::Num7] {
        user.chord(Modifiers::NONE, key);
        let now = back(&user);
        assert!(seen.iter().all(|other| other.distance(now) > 0.1), "{key:?}: {now} {seen:?}");
        seen.push(now);
    }
    user.has_done("look from the front, the right and the top", 0);
}

#[test]
fn steps_are_undone_redone_and_chosen_in_the_history() {
    let mut user = User::new();
    user.select_bone();
    for degrees in ["10", "20", "30"] {
        user.typed("Rotation change X", degrees);
    }
    let done = |user: &User| user.animator.edited.steps().1;
    let before = user.actions;
    user.chord(Modifiers::COMMAND, Key::Z);
    assert_eq!(done(&user), 2);
    user.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(done(&user), 3);
    user.has_done("undo, and redo", before);
    let before = user.actions;
    user.click("History");
    user.actions += 1;
    user.animator.harness.get_by_label_contains("Opened").click();
    user.animator.steps(3);
    assert_eq!(done(&user), 0);
    user.has_done("go back to an earlier step", before);
}

#[test]
fn a_take_is_created_and_a_bone_keyed_in_one_action_each() {
    let mut user = User::new();
    user.select_bone();
    let between = user.animator.key(3) + 0.03;
    user.animator.request(Request::Seek(between));
    let before = user.actions;
    let keys = user.take(0).keys();
    user.chord(Modifiers::NONE, Key::K);
    assert!(user.take(0).keys() > keys);
    user.has_done("key the selected bone", before);
    let (before, takes) = (user.actions, user.animator.edited.adapter().slots().len());
    user.click("New take");
    assert_eq!(user.animator.edited.adapter().slots().len(), takes + 1);
    user.has_done("create a take", before);
}

#[test]
fn the_play_range_is_set_to_the_selected_keys_in_one_action() {
    let mut user = User::new();
    user.select_bone();
    let animator = &mut user.animator;
    let (from, to) = (animator.at(animator.key(3) - 0.04, 4), animator.at(animator.key(9) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    let chosen = user.actions;
    user.chord(Modifiers::NONE, Key::P);
    user.has_done("set the play range to the selected keys", chosen);
    let [start, end] = user.animator.harness.state().state.read().keys.range().expect("a range");
    let wanted = [user.animator.key(3), user.animator.key(9)];
    assert!((start - wanted[0]).abs() < 0.02 && (end - wanted[1]).abs() < 0.02, "{start} {end} {wanted:?}");
}

#[test]
fn keys_get_step_interpolation_from_a_menu_at_the_pointer_in_two_actions() {
    let mut user = User::new();
    let keys = KeySettings { preset: Preset::Blender, ..KeySettings::default() };
    user.animator.request(Request::Keys(keys));
    user.select_bone();
    user.animator.request(Request::Command(Id::SelectAllKeys));
    let chosen = user.actions;
    let at = user.animator.keys().center();
    user.animator.move_to(at);
    user.chord(Modifiers::NONE, Key::T);
    user.actions += 1;
    // The curves have a button of this name, too; the menu is above it.
    user.animator.harness.query_all_by_label_contains("Step interpolation").last().expect("an entry").click();
    user.animator.steps(3);
    user.has_done("step interpolation of the selected keys", chosen);
    assert_eq!(user.take(0).tracks[3].rotation.interpolation, Interpolation::Step);
}

#[test]
fn a_tangent_is_dragged_after_its_key_was_clicked() {
    let mut user = User::new();
    user.select_bone();
    user.animator.request(Request::Command(Id::SelectAllKeys));
    user.animator.request(Request::Command(Id::InterpolateSpline));
    user.animator.steps(4);
    let chosen = user.actions;
    // At a maximum the tangent is horizontal, so that its end is 44 points to the right.
    let rotation = user.take(0).tracks[3].rotation.clone();
    let animator = &mut user.animator;
    let crest =
        (9..30).max_by(|&a, &b| place_of_z_key(animator, b).y.total_cmp(&place_of_z_key(animator, a).y));
    let crest = crest.expect("a key");
    let at = place_of_z_key(animator, crest);
    animator.click(at);
    let end = at + vec2(44.0, 0.0);
    animator.drag(end, end - vec2(0.0, 25.0));
    animator.release(end - vec2(0.0, 25.0));
    user.actions += 2;
    user.has_done("choose a key, and drag its tangent", chosen);
    let now = user.take(0).tracks[3].rotation.clone();
    assert_eq!((now.value(crest), now.interpolation), (rotation.value(crest), Interpolation::CubicSpline));
    assert_ne!(now.values[crest * 3 + 2], rotation.values[crest * 3 + 2], "the slope is another one");
}

#[test]
fn a_file_is_saved_under_another_name_in_two_actions() {
    let mut user = User::new();
    user.select_bone();
    user.typed("Rotation change X", "30");
    let before = user.actions;
    user.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    let asks =
        |effect: &Effect| matches!(effect, Effect::File(FileAction::Where { copy: false, then: None }));
    assert!(user.animator.harness.state().effects.iter().any(asks));
    // The dialog of the desktop, or this one where there is none; the name is selected in it.
    let question = Question::Place(PlaceQuestion { copy: false, then: None });
    user.animator.harness.state_mut().state.ask(question);
    user.animator.steps(4);
    user.actions += 1;
    user.animator.harness.event(Event::Text("Walk 2".to_owned()));
    user.animator.steps(2);
    user.animator.harness.key_press(Key::Enter);
    user.animator.steps(3);
    user.has_done("save as", before);
    let saves = |effect: &Effect| {
        // The folder of the file, which was opened by a relative path, and its ending stay.
        let wanted = std::path::absolute("Walk 2.glb").expect("a path");
        let is_wanted = |to: &SaveTo| matches!(to, SaveTo::As(path) if *path == wanted);
        matches!(effect, Effect::File(FileAction::Send(DocumentMessage::Save(SaveOrder { to, .. }))) if is_wanted(to))
    };
    let effects = &user.animator.harness.state().effects;
    assert!(effects.iter().any(saves), "{:?}", effects.last());
}
