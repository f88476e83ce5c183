//! Shortcuts as text, as users read them and settings store them.

use super::id::Id;
use egui::{Key, KeyboardShortcut, Modifiers};

/// Commands with keys that differ from the table.
pub(super) type PresetKeys = &'static [(Id, &'static [KeyboardShortcut])];

pub(super) const NONE: Modifiers = Modifiers::NONE;
pub(super) const CTRL: Modifiers = Modifiers::COMMAND;
pub(super) const SHIFT: Modifiers = Modifiers::SHIFT;
pub(super) const ALT: Modifiers = Modifiers::ALT;

/// Returns a shortcut.
pub(super) const fn key(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(modifiers, key)
}

/// Keys with a shorter name on their cap than in the library.
const CAPS: &[(Key, &str)] = &[
    (Key::ArrowLeft, "Left"),
    (Key::ArrowRight, "Right"),
    (Key::ArrowUp, "Up"),
    (Key::ArrowDown, "Down"),
    (Key::Escape, "Esc"),
    (Key::PageUp, "Page up"),
    (Key::PageDown, "Page down"),
    (Key::OpenBracket, "["),
    (Key::CloseBracket, "]"),
    (Key::Comma, ","),
    (Key::Period, "."),
    (Key::Plus, "+"),
    (Key::Minus, "-"),
    (Key::Equals, "="),
    (Key::Slash, "/"),
    (Key::Questionmark, "?"),
    (Key::OpenCurlyBracket, "{"),
    (Key::CloseCurlyBracket, "}"),
    (Key::Exclamationmark, "!"),
    (Key::Colon, ":"),
    (Key::Semicolon, ";"),
    (Key::Quote, "'"),
    (Key::Backtick, "`"),
    (Key::Backslash, "\\"),
    (Key::Pipe, "|"),
];

/// The modifiers, in the order in which they are written.
const HELD: &[(&str, Modifiers)] =
    &[("Ctrl+", Modifiers::COMMAND), ("Alt+", Modifiers::ALT), ("Shift+", Modifiers::SHIFT)];

/// Returns a shortcut as text: `Ctrl+Shift+O`, with the signs on the keys for arrows and brackets.
pub fn text(shortcut: &KeyboardShortcut) -> String {
    let held = |modifiers: Modifiers| {
        let wanted = shortcut.modifiers;
        (modifiers.command && (wanted.command || wanted.ctrl))
            || (modifiers.alt && wanted.alt)
            || (modifiers.shift && wanted.shift)
    };
    let key = CAPS.iter().find(|(key, _)| *key == shortcut.logical_key);
    let key = key.map_or_else(|| shortcut.logical_key.name(), |(_, cap)| cap);
    HELD.iter().filter(|(_, modifiers)| held(*modifiers)).map(|(name, _)| *name).chain([key]).collect()
}

/// Returns the shortcut that [`text`] writes like this; `None` for anything else.
pub fn parse(mut text: &str) -> Option<KeyboardShortcut> {
    let mut modifiers = Modifiers::NONE;
    for (name, held) in HELD {
        if let Some(rest) = text.strip_prefix(name).filter(|rest| !rest.is_empty()) {
            modifiers = modifiers.plus(*held);
            text = rest;
        }
    }
    let cap = CAPS.iter().find(|(_, cap)| *cap == text).map(|(key, _)| *key);
    Some(KeyboardShortcut::new(modifiers, cap.or_else(|| Key::from_name(text))?))
}
