//! Settings restored at the next start: timeline and IK options, and the bone flags of each file.

use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly::panels::marks;
use dragonfly::panels::reference::ReferenceSettings;
use dragonfly::panels::sound::SoundSettings;
use dragonfly::panels::{Request, Settings, State};
use dragonfly_document::View;
use dragonfly_kit::document::fixture;
use std::time::Instant;

fn file(title: &str) -> View {
    fixture::view(title, fixture::skeleton(3), &[("Walk", 1.0, 5)])
}

fn flag(state: &mut State, flag: BoneFlag, bone: u32) {
    state.execute(Request::Timeline(KeysRequest::Flag(flag, bone, true)));
}

#[test]
fn snapping_listing_and_ik_settings_are_restored() {
    let mut state = State::new(Settings::default(), Instant::now());
    state.show(file("Fox.glb"));
    assert!(state.read().keys.snap() && state.read().keys.only_selected() && !state.read().ik.on);
    for id in [Id::ToggleSnap, Id::ToggleIk, Id::LongerIk, Id::LongerIk] {
        state.execute(Request::Command(id));
    }
    state.execute(Request::Timeline(KeysRequest::OnlySelected(false)));
    let again = State::new(Settings::parse(&state.read().settings.to_text()), Instant::now());
    assert!(!again.read().keys.snap() && !again.read().keys.only_selected());
    assert_eq!((again.read().ik.on, again.read().ik.length, again.read().ik.pole), (true, 4, None));
    // Another model does not change them, and an invalid number is sanitized.
    state.show(file("Crow.glb"));
    assert!(!state.read().keys.snap() && state.read().ik.on);
    let mended = Settings::parse("{\"hand\":{\"ik\":{\"on\":true,\"length\":0}}}");
    assert_eq!(mended.tools.ik.length, 1);
}

#[test]
fn bone_flags_and_pins_of_a_file_are_restored_with_it() {
    let mut state = State::new(Settings::default(), Instant::now());
    state.show(file("Fox.glb"));
    assert_eq!(state.side_files().unsaved_marks(), None, "nothing is marked");
    flag(&mut state, BoneFlag::Mute, 2);
    flag(&mut state, BoneFlag::Solo, 3);
    flag(&mut state, BoneFlag::Lock, 4);
    state.execute(Request::Select(Some(5)));
    state.execute(Request::Command(Id::Pin));
    state.execute(Request::Command(Id::IkPole));
    // Another file is opened before anything was written.
    state.show(file("Crow.glb"));
    assert!(
        !state.read().keys.flags().any_locked()
            && state.read().pins.is_empty()
            && state.read().ik.pole.is_none()
    );
    let text = state.side_files().unsaved_marks().expect("changed");
    assert_eq!(state.side_files().unsaved_marks(), None, "reported once");
    let mut again = State::new(Settings::default(), Instant::now());
    again.side_files().read_marks(&text);
    again.show(file("Crow.glb"));
    assert!(!again.read().keys.flags().any_locked());
    again.show(file("Fox.glb"));
    let has = |state: &State| {
        let flags = &state.read().keys.flags();
        [flags.has(BoneFlag::Mute, 2), flags.has(BoneFlag::Solo, 3), flags.has(BoneFlag::Lock, 4)]
    };
    assert_eq!(has(&again), [true; 3]);
    assert_eq!((again.read().pins.to_vec(), again.read().ik.pole), (vec![5], Some(5)));
    assert_eq!(again.side_files().unsaved_marks(), None, "as it was read");
    // Flags that were removed stay removed.
    for (flag, bone) in [(BoneFlag::Mute, 2), (BoneFlag::Solo, 3), (BoneFlag::Lock, 4)] {
        again.execute(Request::Timeline(KeysRequest::Flag(flag, bone, false)));
    }
    again.execute(Request::Command(Id::FreePins));
    again.execute(Request::Select(Some(5)));
    again.execute(Request::Command(Id::IkPole));
    let text = again.side_files().unsaved_marks().expect("changed");
    assert!(!text.contains("Fox"), "{text}");
}

#[test]
fn saving_a_model_elsewhere_copies_its_bone_flags() {
    let mut state = State::new(Settings::default(), Instant::now());
    let mut view = file("Fox.glb");
    state.show(view.clone());
    flag(&mut state, BoneFlag::Lock, 4);
    assert!(state.side_files().unsaved_marks().is_some());
    let mut moved = (*view.file).clone();
    moved.path = Some("Wolf.glb".into());
    view.file = std::sync::Arc::new(moved);
    state.show(view);
    let text = state.side_files().unsaved_marks().expect("of the new file too");
    for name in ["Fox.glb", "Wolf.glb"] {
        let mut again = State::new(Settings::default(), Instant::now());
        again.side_files().read_marks(&text);
        again.show(file(name));
        assert!(again.read().keys.flags().has(BoneFlag::Lock, 4), "{name}");
    }
}

#[test]
fn the_number_of_remembered_files_is_limited_and_a_damaged_text_gives_none() {
    let mut state = State::new(Settings::default(), Instant::now());
    for number in 0..marks::FILES + 10 {
        state.show(file(&format!("model {number}.glb")));
        flag(&mut state, BoneFlag::Lock, 1);
    }
    let text = state.side_files().unsaved_marks().expect("changed");
    assert_eq!(text.matches("\"path\"").count(), marks::FILES);
    assert!(!text.contains("model 9.glb") && text.contains("model 10.glb"), "the oldest go");
    for damaged in ["", "[]", "{\"files\":3}", "{\"files\":[{\"lock\":[true]}]}", &text[..text.len() / 2]] {
        let mut state = State::new(Settings::default(), Instant::now());
        state.side_files().read_marks(damaged);
        state.show(file("model 20.glb"));
        assert!(!state.read().keys.flags().any_locked());
    }
    // Bones that the file no longer has are skipped.
    let mut state = State::new(Settings::default(), Instant::now());
    state.side_files().read_marks(&text.replace("\"spine_00\"", "\"gone\""));
    state.show(file("model 20.glb"));
    assert!(!state.read().keys.flags().any_locked());
}

#[test]
fn restored_flags_have_another_version_than_those_of_the_previous_model() {
    // Drawing code compares versions: two models with the same number of flags must not have equal versions.
    let mut state = State::new(Settings::default(), Instant::now());
    let mut versions = Vec::new();
    for (number, bone) in [(1, 2), (2, 3), (1, 2), (2, 3)] {
        state.show(file(&format!("model {number}.glb")));
        flag(&mut state, BoneFlag::Mute, bone);
        assert_eq!(state.read().keys.flags().still(8), [bone]);
        assert!(!versions.contains(&state.read().keys.flags().version()), "{versions:?}");
        versions.push(state.read().keys.flags().version());
    }
}

#[test]
fn the_reference_and_the_sound_of_a_file_are_restored_with_paths_relative_to_it() {
    let there = |title: &str| {
        let mut view = file(title);
        std::sync::Arc::make_mut(&mut view.file).path = Some(std::path::Path::new("/films/walk").join(title));
        view
    };
    let mut state = State::new(Settings::default(), Instant::now());
    state.show(there("Fox.glb"));
    let reference = ReferenceSettings {
        file: "/films/walk/frames/walk_0001.png".into(),
        opacity: 0.25,
        first: -3,
        repeats: true,
        ..ReferenceSettings::default()
    };
    let sound = SoundSettings { file: "/films/sound/steps.wav".into(), start: 12 };
    state.execute(Request::Reference(reference.clone()));
    state.execute(Request::Sound(sound.clone()));
    state.show(there("Crow.glb"));
    assert!(!state.read().reference.settings().is_chosen() && !state.read().sound.settings().is_chosen());
    let text = state.side_files().unsaved_marks().expect("changed");
    assert!(text.contains(r#""frames/walk_0001.png""#) && text.contains(r#""../sound/steps.wav""#), "{text}");
    let mut again = State::new(Settings::default(), Instant::now());
    again.side_files().read_marks(&text);
    again.show(there("Fox.glb"));
    assert_eq!(*again.read().reference.settings(), reference);
    assert_eq!(*again.read().sound.settings(), sound);
    assert_eq!(again.side_files().unsaved_marks(), None, "as it was read");
    again.execute(Request::Command(Id::RemoveSound));
    let text = again.side_files().unsaved_marks().expect("changed");
    assert!(!text.contains("steps.wav"), "{text}");
}
