//! The table of commands: titles, help texts and shortcuts.

use dragonfly::panels::commands;
use std::collections::HashMap;

#[test]
fn no_two_commands_share_a_shortcut() {
    let mut seen = HashMap::new();
    for command in commands::all() {
        for shortcut in command.shortcuts {
            let text = commands::text(shortcut);
            if let Some(other) = seen.insert(text.clone(), command.title) {
                panic!("{text} belongs to {other:?} and {:?}", command.title);
            }
        }
    }
}

#[test]
fn every_command_is_listed_once_with_a_title_and_help() {
    let mut seen = HashMap::new();
    for command in commands::all() {
        assert!(seen.insert(command.id, ()).is_none(), "{:?} is listed twice", command.id);
        assert_eq!(commands::get(command.id).id, command.id);
        assert_eq!(commands::named(command.id.name()), Some(command.id));
        assert_eq!(format!("{:?}", command.id), command.id.name(), "settings and logs have the bare name");
        assert!(!command.title.is_empty() && !command.help.is_empty(), "{:?}", command.id);
    }
}

#[test]
fn tooltips_name_the_shortcut() {
    assert_eq!(
        commands::tooltip(&egui::Context::default(), commands::Id::PlayPause),
        "Play / pause (Space)\nStarts or pauses playback"
    );
    assert_eq!(commands::shortcut_text(&egui::Context::default(), commands::Id::OpenPath), "Ctrl+Shift+O");
}
