//! Everything the program can be told to do, once: menus, tooltips, keys, palette and shortcut sheet all read this table.

mod category;
mod id;
mod keymap;
mod table;
mod when;

pub use category::Category;
pub use id::Id;
pub use keymap::Keymap;
pub use table::TABLE;
pub use when::When;

use egui::{Key, KeyboardShortcut};

/// One thing the program can be told to do.
#[derive(Clone, Copy, Debug)]
pub struct Command {
    /// Its name in the code.
    pub id: Id,
    /// Its name on the screen.
    pub title: &'static str,
    /// The first is the one that tooltips name.
    pub shortcuts: &'static [KeyboardShortcut],
    /// One sentence.
    pub help: &'static str,
    /// When it can be given.
    pub when: When,
}

/// Every command, in the order of the table.
pub fn all() -> impl Iterator<Item = &'static Command> {
    TABLE.iter().flat_map(|(_, commands)| commands.iter())
}

/// Where a command stands.
pub fn category_of(id: Id) -> Category {
    let has = |commands: &[Command]| commands.iter().any(|command| command.id == id);
    TABLE.iter().find(|(_, commands)| has(commands)).map_or(Category::Help, |(category, _)| *category)
}

/// The commands of one category.
pub fn of(category: Category) -> &'static [Command] {
    TABLE.iter().find(|(other, _)| *other == category).map_or(&[], |(_, commands)| commands)
}

/// What the mouse does in the viewport, for the shortcut sheet.
pub const MOUSE: &[(&str, &str)] = &[
    ("Middle drag, Alt + left drag", "Orbit"),
    ("Shift + middle drag, Alt + middle drag", "Pan"),
    ("Wheel, Alt + right drag", "Zoom"),
    ("Click", "Select the bone under the pointer; again: what lies behind it"),
    ("Shift + click, Ctrl + click", "Add to the selection, take in or out"),
    ("Drag", "Select in a box"),
    ("Ctrl + Alt + left drag", "Select in a lasso"),
    ("Drag a handle", "Move, rotate, scale; Shift precise, Ctrl in steps"),
    ("X, Y, Z while dragging", "Bind to an axis, with Shift to a plane; again: other axes"),
    ("Digits while dragging", "Type the amount"),
    ("Enter, Esc while dragging", "Keep it, take it back (also: right button)"),
    ("Drag the axes", "Orbit"),
    ("Alt + wheel over the timeline", "Frame by frame"),
];

/// The entry of `id`.
pub fn get(id: Id) -> &'static Command {
    // A test proves that every name has a line.
    all().find(|command| command.id == id).unwrap_or(&TABLE[0].1[0])
}

/// The first shortcut as text, `Ctrl+O`; empty when there is none.
pub fn shortcut_text(context: &egui::Context, id: Id) -> String {
    Keymap::of(context).shortcuts(id).first().map(text).unwrap_or_default()
}

/// What a tooltip says: title and shortcut, then the help.
pub fn tooltip(context: &egui::Context, id: Id) -> String {
    let command = get(id);
    let shortcut = shortcut_text(context, id);
    let title = if shortcut.is_empty() {
        command.title.to_owned()
    } else {
        format!("{} ({shortcut})", command.title)
    };
    if command.help == command.title { title } else { format!("{title}\n{}", command.help) }
}

/// `Ctrl+Shift+O`, with arrows and brackets as signs on keys.
pub fn text(shortcut: &KeyboardShortcut) -> String {
    let mut out = String::new();
    let modifiers = shortcut.modifiers;
    for (held, name) in [(modifiers.command, "Ctrl+"), (modifiers.alt, "Alt+"), (modifiers.shift, "Shift+")] {
        if held {
            out.push_str(name);
        }
    }
    out.push_str(match shortcut.logical_key {
        Key::ArrowLeft => "Left",
        Key::ArrowRight => "Right",
        Key::ArrowUp => "Up",
        Key::ArrowDown => "Down",
        Key::Escape => "Esc",
        Key::PageUp => "Page up",
        Key::PageDown => "Page down",
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Comma => ",",
        Key::Period => ".",
        Key::Plus => "+",
        Key::Minus => "-",
        Key::Equals => "=",
        Key::Slash => "/",
        Key::Questionmark => "?",
        other => other.name(),
    });
    out
}

/// Commands whose keys were pressed in this frame, in order; what text fields need is left to them.
///
/// Held keys repeat only where that is wanted: stepping through time.
pub fn pressed(context: &egui::Context) -> Vec<Id> {
    // Escape closes what is open first.
    let open = context.any_popup_open();
    let typing = context.text_edit_focused();
    let focused = context.memory(|memory| memory.focused().is_some());
    let keymap = Keymap::of(context);
    let mut found = Vec::new();
    context.input_mut(|input| {
        input.events.retain(|event| {
            let egui::Event::Key { key, pressed: true, repeat, modifiers, .. } = event else { return true };
            // Keys that move or type inside a field, or press the button that has the focus, are not ours.
            let plain = !modifiers.command && !modifiers.alt;
            let function = matches!(key, Key::F1 | Key::F3 | Key::F11);
            if (typing
                && !(function
                    || modifiers.command && matches!(key, Key::O | Key::P | Key::Q | Key::F | Key::S)))
                || (focused && plain && matches!(key, Key::Space | Key::Enter | Key::Tab | Key::Escape))
            {
                return true;
            }
            if open && *key == Key::Escape {
                return true;
            }
            let hit = all().find(|command| {
                keymap.shortcuts(command.id).iter().any(|shortcut| {
                    shortcut.logical_key == *key && modifiers.matches_exact(shortcut.modifiers)
                })
            });
            match hit {
                Some(command) if !*repeat || repeats(command.id) => {
                    found.push(command.id);
                    false
                }
                Some(_) => false,
                None => true,
            }
        });
    });
    found
}

fn repeats(id: Id) -> bool {
    matches!(
        id,
        Id::PreviousFrame
            | Id::NextFrame
            | Id::PreviousKey
            | Id::NextKey
            | Id::BackOneSecond
            | Id::ForwardOneSecond
            | Id::SelectParent
            | Id::SelectChild
            | Id::ScaleUp
            | Id::ScaleDown
    )
}
