//! All commands of the program in one table: menus, tooltips, keys, palette and shortcut sheet read it.

mod category;
mod command;
pub(in crate::panels) mod counterpart;
pub(super) mod id;
pub(super) mod key_settings;
mod keymap;
mod preset;
mod shortcut;
mod table;
mod when;

pub use category::Category;
pub use command::Command;
pub use id::Id;
pub use key_settings::{KeyScope, KeySettings};
pub use keymap::Keymap;
pub use preset::Preset;
pub use shortcut::{parse, text};
pub use table::TABLE;
pub use when::When;

use super::context::PanelContext;
use super::key_canvases;
use super::selection_trail::WalkDirection;
use egui::{Key, Modifiers, Popup};
use std::borrow::Cow;

/// Returns every command, in the order of the table.
pub fn all() -> impl Iterator<Item = &'static Command> {
    TABLE.iter().flat_map(|(_, commands)| commands.iter())
}

/// Returns the command with this name in settings.
pub fn named(name: &str) -> Option<Id> {
    all().map(|command| command.id).find(|id| id.name() == name)
}

/// Returns the category of a command.
pub fn category_of(id: Id) -> Category {
    let has = |commands: &[Command]| commands.iter().any(|command| command.id == id);
    TABLE.iter().find(|(_, commands)| has(commands)).map_or(Category::Help, |(category, _)| *category)
}

/// Returns the commands of one category.
pub fn of(category: Category) -> &'static [Command] {
    TABLE.iter().find(|(other, _)| *other == category).map_or(&[], |(_, commands)| commands)
}

/// The actions of the mouse in the viewport, the timeline and the curves, for the shortcut sheet and the palette.
pub const MOUSE: &[(&str, &str)] = &[
    ("Middle drag, Alt + left drag", "Orbit"),
    ("Shift + middle drag, Alt + middle drag", "Pan"),
    ("Wheel, Alt + right drag", "Zoom"),
    ("Click", "Select the bone under the pointer; again: the bone behind it"),
    ("Shift + click, Ctrl + click", "Add to the selection, toggle"),
    ("Drag", "Box select"),
    ("Ctrl + Alt + left drag", "Lasso select"),
    ("Drag a handle", "Move, rotate, scale; Shift for precision, Ctrl to snap"),
    ("X, Y, Z while dragging", "Constrain to an axis, with Shift to a plane; again: local or world axes"),
    ("Digits while dragging", "Enter the amount"),
    ("Enter, Esc while dragging", "Confirm, cancel (also: right button)"),
    ("Drag the axes", "Orbit"),
    ("Alt + wheel over the timeline", "Step frame by frame"),
    ("Wheel over the timeline or the curves", "Zoom the time"),
    ("Shift + wheel over the timeline or the curves", "Pan in time"),
    ("Ctrl + wheel over the curves", "Zoom the values"),
    ("Middle drag over the timeline or the curves", "Pan (also: Alt + Shift + drag)"),
    (
        "B over the timeline or the curves, then drag",
        "Box select keys (Q in Maya's, Godot's and Unity's keys)",
    ),
    ("T, V over the timeline or the curves", "Menu of interpolations, menu of tangents"),
    ("2 + drag keys", "Ripple: move all later keys as well"),
    ("2 + drag the end of the bar over selected keys", "Slow or quicken that part; all later keys move"),
    (
        "Drag a contact, an event or a marker",
        "Move it to another frame; the ends of a contact change its length",
    ),
    ("Double-click the weight of a layer", "Add a key; drag a key to change frame and weight"),
    ("Alt + drag keys, Shift + drag selected keys", "Duplicate keys"),
    ("Ctrl while dragging keys", "Invert snapping"),
    (
        "X, Y while keys follow the mouse",
        "Constrain to time, to value; digits enter frames, a value or a factor",
    ),
    ("Alt + click a key", "Select the keys of all listed bones at that time"),
    ("Alt + drag a tangent", "Break the tangent: change one side alone"),
    ("Click or drag on the ruler", "Move the playhead; double-click: fit the keys"),
    ("Alt + drag the end of the bar over selected keys", "Scale keys about the playhead"),
    ("Drag the values beside the curves", "Pan the values; wheel: zoom; double-click: fit"),
    ("Drag a key of the motion path", "Move the bone at that key"),
    (
        "Drag a point of a selected path or line",
        "Move it at its height; Shift: up and down, Ctrl: snap, Alt: one direction alone",
    ),
    ("Ctrl + click a selected path or line", "Add a point there"),
    ("Click a point of a path or line, then Delete", "Remove that point"),
    ("Click a drawn line", "Select it; Shift: add it, Ctrl: toggle it; Delete: remove it"),
    (
        "Drop a model file onto a scene",
        "On a bone, the bone holds an object; a figure stands on the ground there",
    ),
    ("Point at one of two views", "Orbit, zoom, click and look through cameras in that one"),
    ("Click after \"Pick the focus\"", "Focus on a bone; Shift: on its distance"),
    ("Drag while drawing lines", "Draw freehand; Shift: straight, Ctrl: erase"),
    ("Alt + drag while drawing a pose line", "Draw the motion path of the end of the bones"),
    (
        "Click while drawing lines",
        "Add a corner; Enter or a double click ends the line, Backspace takes a corner back",
    ),
    ("Drag a number", "Change it; Shift for precision, Ctrl to snap"),
    ("Double-click a slider", "Reset its number"),
    ("Drag a pose of the library sideways", "Blend it in; double-click: apply it"),
    ("Click a selection set", "Select its bones; Shift: add them, Ctrl: remove them"),
    ("Click a bone in the list", "Select it; Shift: all up to it, Ctrl: toggle; double-click: frame it"),
    ("Shift + click the eye or the arrow of a bone", "Hide or fold all bones below it as well"),
    ("Double-click a take, layer, marker or event", "Edit its name"),
    ("Double-click a thing, a lane or a line of a scene", "Edit its name"),
    ("Right-click", "Menu for what is under the pointer"),
];

/// Returns the row of `id`.
pub fn get(id: Id) -> &'static Command {
    // A row declares its id, so every id has one.
    all().find(|command| command.id == id).unwrap_or(&TABLE[0].1[0])
}

/// Returns the title of a command as menus show it: undo and redo with the step that they are about.
pub fn title(panels: &PanelContext<'_>, id: Id) -> Cow<'static, str> {
    let title = get(id).title;
    let ways = [(Id::Undo, WalkDirection::Back), (Id::Redo, WalkDirection::Forward)];
    let label = ways.iter().position(|(own, _)| *own == id).and_then(|at| {
        let history = &panels.view?.history;
        match next_hiding(panels, history.done, ways[at].1) {
            Some(label) => Some(label),
            None if panels.trail.leads(history.done, ways[at].1) => Some("selection"),
            None => history.labels()[at],
        }
    });
    label.map_or(Cow::Borrowed(title), |label| Cow::Owned(format!("{title} {label}")))
}

/// Returns the label of the change of what is hidden or locked in the scene that is undone or redone next; `None` where there is none.
fn next_hiding(panels: &PanelContext<'_>, done: usize, direction: WalkDirection) -> Option<&'static str> {
    panels.scene().and_then(|_| panels.scene_editing.next_hiding(done, direction))
}

/// Returns the first shortcut as text, `Ctrl+O`, or the first one over the timeline and the curves, or that of the command for models
/// whose keys a command of scenes has; empty when there is none.
pub fn shortcut_text(context: &egui::Context, id: Id) -> String {
    let own = Keymap::of(context).first_shortcut(id).map(text);
    own.unwrap_or_else(|| shortcut_of_counterpart(context, id))
}

/// Returns the first shortcut of the command for models whose keys a command of scenes has; empty when there is none.
pub(super) fn shortcut_of_counterpart(context: &egui::Context, id: Id) -> String {
    let keymap = Keymap::of(context);
    let found = counterpart::for_models(id).find_map(|other| keymap.first_shortcut(other));
    found.map(text).unwrap_or_default()
}

/// Returns the commands for models whose keys a command of scenes has.
pub(super) fn counterparts_of(id: Id) -> impl Iterator<Item = Id> {
    counterpart::for_models(id)
}

/// Returns the tooltip: title and shortcut, then the help.
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

/// Returns the commands whose keys were pressed in this frame, in order; keys that a text field needs stay for it.
///
/// Held keys run only commands that repeat.
pub fn pressed(context: &egui::Context) -> Vec<Id> {
    // A key that is being chosen for a command runs none.
    if Keymap::is_asking(context) {
        return Vec::new();
    }
    // While a question or a sheet is shown, only the commands that open and close such a sheet have keys.
    let modal = context.memory(|memory| memory.top_modal_layer().is_some());
    // Escape first closes what is open, and cancels what is dragged. Menus are looked up in egui's memory: their state in the
    // pass is gone when the next pass starts, which is when this is called.
    let open = modal || Popup::is_any_open(context) || context.input(|input| input.pointer.any_down());
    let typing = context.text_edit_focused();
    let focused = context.memory(|memory| memory.focused().is_some());
    // Escape has already taken the focus from a text field when this runs; the Escape was meant for that field.
    let place = egui::Id::unique("focused before");
    let open = open || context.data(|data| data.get_temp::<bool>(place)).unwrap_or_default();
    context.data_mut(|data| data.insert_temp(place, focused));
    let keymap = Keymap::of(context);
    let pointer = context.input(|input| input.pointer.latest_pos());
    let over_keys = pointer.and_then(|at| key_canvases::at(context, at)).is_some();
    let mut found = Vec::new();
    context.input_mut(|input| {
        input.events.retain(|event| {
            let Some((key, repeat, modifiers)) = key_of(event) else { return true };
            // Keys that move or type inside a field, or press the focused button, are not for commands.
            let plain = !modifiers.command && !modifiers.alt;
            if (typing && belongs_to_text(key, modifiers))
                || (focused && plain && matches!(key, Key::Space | Key::Enter | Key::Tab | Key::Escape))
                || (open && key == Key::Escape)
            {
                return true;
            }
            let special = keymap.command_of(KeyScope::Keys, key, modifiers).filter(|_| over_keys);
            match special.or_else(|| keymap.command_of(KeyScope::Window, key, modifiers)) {
                Some(id) if modal && !matches!(id, Id::Palette | Id::Shortcuts) => true,
                Some(id) if !repeat || get(id).repeats => {
                    found.push(id);
                    false
                }
                Some(_) => false,
                None => true,
            }
        });
    });
    found
}

/// Returns whether a key is for the text field that has the focus: every key is, except function keys and combinations
/// with Ctrl that have no meaning in a text field.
fn belongs_to_text(key: Key, modifiers: Modifiers) -> bool {
    use Key::{
        A, ArrowDown, ArrowLeft, ArrowRight, ArrowUp, Backspace, C, Delete, End, Home, U, V, W, X, Y, Z,
    };
    let function = key >= Key::F1 && key <= Key::F35;
    let edits = matches!(
        key,
        A | C
            | V
            | X
            | Y
            | Z
            | U
            | W
            | Backspace
            | Delete
            | Home
            | End
            | ArrowLeft
            | ArrowRight
            | ArrowUp
            | ArrowDown
    );
    !function && (!modifiers.command || edits)
}

/// Returns the key of an event. The window system reports Ctrl+C, Ctrl+X and Ctrl+V as copy, cut and paste, not as
/// keys; the command that pastes reads the text.
fn key_of(event: &egui::Event) -> Option<(Key, bool, Modifiers)> {
    match event {
        egui::Event::Key { key, pressed: true, repeat, modifiers, .. } => Some((*key, *repeat, *modifiers)),
        egui::Event::Copy => Some((Key::C, false, Modifiers::COMMAND)),
        egui::Event::Cut => Some((Key::X, false, Modifiers::COMMAND)),
        egui::Event::Paste(_) => Some((Key::V, false, Modifiers::COMMAND)),
        _ => None,
    }
}
