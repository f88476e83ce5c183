//! Input as the window tells it, to inputs of the scene.
//!
//! The window's events come here before the panels are drawn, so a drag does not wait for them. What is for the scene alone,
//! as a letter typed while dragging, is taken out of the list; all else is left for the panels.

use super::drags::lose_input;
use super::input::{input as send, place};
use crate::control::{Button, InputEvent, Key, Modifiers};
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use egui::{Context, Event, Order, PointerButton, Popup, Pos2, RawInput};
use std::time::{Duration, Instant};

/// Gives the scene the events of `input` from `from` on, and takes out what only it is to hear. Tells whether the picture
/// may look different now.
pub(in crate::panels) fn feed(
    context: &Context,
    workspace: &mut Workspace,
    input: &mut RawInput,
    from: usize,
    effects: &mut Vec<Effect>,
) -> bool {
    let mut hears = false;
    let mut index = from;
    while index < input.events.len() {
        let written = match input.events.get(index + 1) {
            Some(Event::Text(text)) => text.chars().next(),
            _ => None,
        };
        let heard = hear(context, workspace, &input.events[index], written, effects);
        hears |= heard != Heard::Nothing;
        match heard {
            Heard::Alone => {
                input.events.remove(index);
            }
            Heard::AloneWithText => {
                input.events.drain(index..(index + 2).min(input.events.len()));
            }
            _ => index += 1,
        }
    }
    hears
}

/// Whom an event was for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Heard {
    /// Not for the scene.
    Nothing,
    /// For the scene and for the panels.
    Both,
    /// For the scene alone.
    Alone,
    /// The same, with the letter that follows.
    AloneWithText,
}

fn hear(
    context: &Context,
    workspace: &mut Workspace,
    event: &Event,
    written: Option<char>,
    effects: &mut Vec<Effect>,
) -> Heard {
    match event {
        Event::PointerMoved(at) => {
            move_to(context, workspace, *at, effects);
            if workspace.tools.controls().is_busy() { Heard::Both } else { Heard::Nothing }
        }
        Event::PointerGone => {
            send(workspace, InputEvent::MouseGone, effects);
            Heard::Both
        }
        Event::ModifiersChanged(modifiers) => {
            hold(workspace, *modifiers, effects);
            if workspace.tools.controls().is_busy() { Heard::Both } else { Heard::Nothing }
        }
        Event::PointerButton { pos, button, pressed, modifiers } => {
            let Some(button) = button_of(*button) else { return Heard::Nothing };
            hold(workspace, *modifiers, effects);
            move_to(context, workspace, *pos, effects);
            let modal = workspace.tools.controls().is_modal();
            let taken = match pressed {
                true if !workspace.tools.controls().is_busy() && is_covered(context, *pos) => false,
                true => send(workspace, InputEvent::MouseDown(button), effects),
                false => send(workspace, InputEvent::MouseUp(button), effects),
            };
            match (taken, modal && *pressed) {
                (true, true) => Heard::Alone,
                (true, false) => Heard::Both,
                (false, _) => Heard::Nothing,
            }
        }
        Event::Key { key, pressed: true, repeat, modifiers, .. } => {
            hold(workspace, *modifiers, effects);
            let drags = workspace.tools.controls().is_busy() || workspace.tools.controls().is_modal();
            let types = context.egui_wants_keyboard_input() || Popup::is_any_open(context);
            if types && !drags {
                return Heard::Nothing;
            }
            if let Some(heard) = typed_for_nothing(workspace, key_of(*key, written), written) {
                return heard;
            }
            let Some(key) = key_of(*key, written) else {
                return if drags { Heard::Alone } else { Heard::Nothing };
            };
            // A letter held down would bind and free an axis in turn.
            let counts = !*repeat || key == Key::Backspace;
            let taken = counts && press(workspace, key, effects);
            match (drags || taken, written) {
                (true, Some(_)) => Heard::AloneWithText,
                (true, None) => Heard::Alone,
                (false, _) => Heard::Nothing,
            }
        }
        // Ctrl and X, which mean an axis and a snap here.
        Event::Cut if workspace.tools.controls().is_busy() => {
            press(workspace, Key::letter('x'), effects);
            Heard::Alone
        }
        Event::Copy | Event::Paste(_) if workspace.tools.controls().is_busy() => Heard::Alone,
        // Of a letter that no key has a name for.
        Event::Text(text) if workspace.tools.controls().is_busy() => {
            for letter in text.chars() {
                press(workspace, Key::letter(letter), effects);
            }
            Heard::Alone
        }
        Event::WindowFocused(false) => {
            send(workspace, InputEvent::Lost, effects);
            lose_input(workspace, context, effects);
            Heard::Both
        }
        _ => Heard::Nothing,
    }
}

/// A drag that a key asked for was refused just now: its axis, its number and the key that ends it are for nothing else. `R`,
/// `X`, `30`, Enter would else delete keys and change the view.
fn typed_for_nothing(workspace: &mut Workspace, key: Option<Key>, written: Option<char>) -> Option<Heard> {
    let at = workspace.tools.take_refused_drag()?;
    let goes_on = match key? {
        Key::Letter(letter) => "xyz0123456789.,-+*/()".contains(letter),
        Key::Backspace => true,
        Key::Enter | Key::Escape => {
            return (at.elapsed() < PATIENCE).then_some(Heard::Alone);
        }
        _ => false,
    };
    if !goes_on || at.elapsed() >= PATIENCE {
        return None;
    }
    workspace.tools.refuse_drag(Instant::now());
    Some(if written.is_some() { Heard::AloneWithText } else { Heard::Alone })
}

/// As long as this after the last key more is expected.
const PATIENCE: Duration = Duration::from_millis(1500);

/// These keys are held besides.
fn hold(workspace: &mut Workspace, modifiers: egui::Modifiers, effects: &mut Vec<Effect>) {
    let modifiers = Modifiers { shift: modifiers.shift, ctrl: modifiers.command, alt: modifiers.alt };
    if workspace.tools.controls().modifiers() != modifiers {
        send(workspace, InputEvent::Modifiers(modifiers), effects);
    }
}

fn press(workspace: &mut Workspace, key: Key, effects: &mut Vec<Effect>) -> bool {
    let taken = send(workspace, InputEvent::KeyDown(key), effects);
    // Nothing here depends on how long a key is held, and its release may be told to somebody else.
    send(workspace, InputEvent::KeyUp(key), effects);
    taken
}

/// The mouse is there; over a menu or a card it is not over the scene.
fn move_to(context: &Context, workspace: &mut Workspace, at: Pos2, effects: &mut Vec<Effect>) {
    let to = place(at);
    if !workspace.tools.controls().is_busy() && is_covered(context, at) {
        if workspace.tools.controls().pointer().is_some() {
            send(workspace, InputEvent::MouseGone, effects);
        }
    } else if workspace.tools.controls().pointer() != Some(to) {
        send(workspace, InputEvent::MouseMove(to), effects);
    }
}

/// Lies something over the panels there: a menu, a sheet, a card?
fn is_covered(context: &Context, at: Pos2) -> bool {
    context.layer_id_at(at).is_some_and(|layer| layer.order != Order::Background)
}

fn button_of(button: PointerButton) -> Option<Button> {
    match button {
        PointerButton::Primary => Some(Button::Left),
        PointerButton::Middle => Some(Button::Middle),
        PointerButton::Secondary => Some(Button::Right),
        _ => None,
    }
}

/// `written` is what the key writes, where the window told.
fn key_of(key: egui::Key, written: Option<char>) -> Option<Key> {
    let named = match key {
        egui::Key::Enter => Some(Key::Enter),
        egui::Key::Escape => Some(Key::Escape),
        egui::Key::Tab => Some(Key::Tab),
        egui::Key::Backspace => Some(Key::Backspace),
        egui::Key::Delete => Some(Key::Delete),
        egui::Key::ArrowLeft => Some(Key::Left),
        egui::Key::ArrowRight => Some(Key::Right),
        egui::Key::ArrowUp => Some(Key::Up),
        egui::Key::ArrowDown => Some(Key::Down),
        _ => None,
    };
    let symbol = |key: egui::Key| {
        let mut letters = key.symbol_or_name().chars();
        letters.next().filter(|_| letters.next().is_none())
    };
    named.or_else(|| written.or_else(|| symbol(key)).map(Key::letter))
}
