//! Shortcuts come from presets named after other programs and can be changed; no shortcut runs two commands.

use crate::panels::{Bench, harness_of};
use dragonfly::panels::Settings;
use dragonfly::panels::commands::{self, Id, KeyScope, KeySettings, Keymap, Preset, parse, text};
use dragonfly::panels::prompts::Overlay;
use dragonfly_kit::document::fixture;
use egui::{Key, KeyboardShortcut, Modifiers};
use egui_kittest::kittest::Queryable;
use std::collections::HashMap;

fn of(preset: Preset) -> Keymap {
    Keymap::new(KeySettings { preset, ..KeySettings::default() })
}

#[test]
fn no_shortcut_runs_two_commands_in_any_preset() {
    for (preset, scope) in Preset::ALL.iter().flat_map(|preset| KeyScope::ALL.map(|scope| (preset, scope))) {
        let (keymap, scope) = (of(*preset), &scope);
        let mut seen = HashMap::new();
        for command in commands::all() {
            for shortcut in keymap.shortcuts(*scope, command.id) {
                let text = text(shortcut);
                if let Some(other) = seen.insert(text.clone(), command.title) {
                    panic!("{}: {text} belongs to {other:?} and {:?}", preset.title(), command.title);
                }
                assert_eq!(
                    keymap.command_of(*scope, shortcut.logical_key, shortcut.modifiers),
                    Some(command.id),
                    "{text}"
                );
            }
        }
    }
}

#[test]
fn essential_commands_have_a_shortcut_in_every_preset() {
    for preset in Preset::ALL {
        let keymap = of(*preset);
        for id in [Id::Open, Id::Undo, Id::Redo, Id::PlayPause, Id::PreviousFrame, Id::NextFrame, Id::Palette]
        {
            assert!(!keymap.shortcuts(KeyScope::Window, id).is_empty(), "{}: {id:?}", preset.title());
        }
    }
}

#[test]
fn every_shortcut_reads_back_from_its_text() {
    for preset in Preset::ALL {
        for command in commands::all() {
            let keymap = of(*preset);
            for shortcut in KeyScope::ALL.iter().flat_map(|scope| keymap.shortcuts(*scope, command.id)) {
                let written = text(shortcut);
                let read = parse(&written).unwrap_or_else(|| panic!("{written}"));
                assert_eq!((read.logical_key, text(&read)), (shortcut.logical_key, written));
            }
        }
    }
    for wrong in ["", "Ctrl+", "Hyper+K", "Ctrl+Ctrl+", "nothing", "🦊"] {
        assert_eq!(parse(wrong), None, "{wrong}");
    }
}

#[test]
fn a_new_shortcut_is_removed_from_its_old_command_and_saved_in_the_settings() {
    let mut settings = Settings::default();
    settings.keys.set(KeyScope::Window, Id::FrameAll, &[KeyboardShortcut::new(Modifiers::COMMAND, Key::Z)]);
    let settings = Settings::parse(&settings.to_text());
    let keymap = Keymap::new(settings.keys.clone());
    assert_eq!(keymap.command_of(KeyScope::Window, Key::Z, Modifiers::COMMAND), Some(Id::FrameAll));
    assert!(keymap.shortcuts(KeyScope::Window, Id::Undo).is_empty());
    let mut keys = settings.keys;
    keys.reset(KeyScope::Window, Id::FrameAll);
    assert_eq!(Keymap::new(keys).command_of(KeyScope::Window, Key::Z, Modifiers::COMMAND), Some(Id::Undo));
}

#[test]
fn unknown_names_and_keys_in_the_settings_are_ignored() {
    let text =
        r#"{"keys": {"preset": "Maya", "own": {"Nonsense": ["Ctrl+Z"], "Undo": ["Ctrl+U", "no key"]}}}"#;
    let keymap = Keymap::new(Settings::parse(text).keys);
    assert_eq!(keymap.shortcuts(KeyScope::Window, Id::Undo).len(), 1);
    assert_eq!(keymap.command_of(KeyScope::Window, Key::U, Modifiers::COMMAND), Some(Id::Undo));
}

#[test]
fn a_shortcut_is_changed_in_the_shortcut_sheet_by_pressing_its_new_key() {
    let mut bench = Bench::new(Some(fixture::full()));
    bench.state.show_overlay(Some(Overlay::Shortcuts));
    let mut harness = harness_of(bench, egui::vec2(1280.0, 1000.0), 1.0, egui::Theme::Dark);
    harness.run_steps(4);
    harness.get_by_label("Undo: Ctrl+Z").click();
    harness.run_steps(3);
    harness.key_press(Key::Space);
    harness.run_steps(3);
    let state = &harness.state().state;
    assert!(!state.read().playback.playing, "the key that is pressed for a shortcut runs no command");
    let keymap = Keymap::new(state.read().settings.keys.clone());
    assert_eq!(keymap.command_of(KeyScope::Window, Key::Space, Modifiers::NONE), Some(Id::Undo));
    assert!(
        !keymap
            .shortcuts(KeyScope::Window, Id::PlayPause)
            .contains(&KeyboardShortcut::new(Modifiers::NONE, Key::Space))
    );

    // Escape keeps the old key and the sheet.
    harness.get_by_label("Redo: Ctrl+Shift+Z").click();
    harness.run_steps(3);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert_eq!(harness.state().state.read().overlay, Some(Overlay::Shortcuts));
    harness.get_by_label("Redo: Ctrl+Shift+Z");

    harness.get_by_label("Blender").click();
    harness.run_steps(3);
    assert_eq!(harness.state().state.read().settings.keys.preset, Preset::Blender);
    harness.get_by_label("Reset my shortcuts").click();
    harness.run_steps(3);
    harness.get_by_label("Undo: Ctrl+Z");
}

#[test]
fn the_palette_gives_the_reason_why_a_command_is_disabled() {
    let mut bench = Bench::new(Some(fixture::full()));
    bench.state.execute(dragonfly::panels::Request::Command(Id::Undo));
    let line = bench.state.read().status.lines().last().map(|line| line.text.clone());
    assert_eq!(line.as_deref(), Some("There is nothing to undo"));
}
