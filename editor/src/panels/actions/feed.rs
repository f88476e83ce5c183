//! Events of the window as input events of the viewport.
//!
//! The window's events arrive here before the panels are drawn, so a drag does not wait for them. Events for the viewport
//! alone, such as a letter typed while dragging, are removed from the list; all others stay for the panels.

use super::drags::lose_input;
use super::input::{input as send, place};
use crate::control::{Button, InputEvent, Key, Modifiers};
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use egui::{Context, Event, Order, PointerButton, Popup, Pos2, RawInput};
use std::time::{Duration, Instant};

/// Passes the events of `input` from index `from` on to the tools of the viewport, and removes those that are for the
/// tools alone. Returns whether the viewport may look different now.
pub(in crate::panels) fn feed(
    context: &Context,
    workspace: &mut Workspace,
    input: &mut RawInput,
    from: usize,
    effects: &mut Vec<Effect>,
) -> bool {
    let mut changed = false;
    let mut index = from;
    while index < input.events.len() {
        let written = match input.events.get(index + 1) {
            Some(Event::Text(text)) => text.chars().next(),
            _ => None,
        };
        let used = use_event(context, workspace, &input.events[index], written, effects);
        changed |= used != EventUse::Nothing;
        match used {
            EventUse::Alone => {
                input.events.remove(index);
            }
            EventUse::AloneWithText => {
                input.events.drain(index..(index + 2).min(input.events.len()));
            }
            _ => index += 1,
        }
    }
    changed
}

/// The receiver of an event.
#[derive(Clone, Copy, PartialEq, Eq)]
enum EventUse {
    /// The panels.
    Nothing,
    /// The viewport and the panels.
    Both,
    /// The viewport alone.
    Alone,
    /// The viewport alone, together with the letter that follows.
    AloneWithText,
}

fn use_event(
    context: &Context,
    workspace: &mut Workspace,
    event: &Event,
    written: Option<char>,
    effects: &mut Vec<Effect>,
) -> EventUse {
    match event {
        Event::PointerMoved(at) => {
            move_to(context, workspace, *at, effects);
            if workspace.tools.controls().is_busy() { EventUse::Both } else { EventUse::Nothing }
        }
        Event::PointerGone => {
            send(workspace, InputEvent::MouseGone, effects);
            EventUse::Both
        }
        Event::ModifiersChanged(modifiers) => {
            hold(workspace, *modifiers, effects);
            if workspace.tools.controls().is_busy() { EventUse::Both } else { EventUse::Nothing }
        }
        Event::PointerButton { pos, button, pressed, modifiers } => {
            let Some(button) = button_of(*button) else { return EventUse::Nothing };
            hold(workspace, *modifiers, effects);
            move_to(context, workspace, *pos, effects);
            let modal = workspace.tools.controls().is_modal();
            let taken = match pressed {
                true if !workspace.tools.controls().is_busy() && is_covered(context, *pos) => false,
                true => send(workspace, InputEvent::MouseDown(button), effects),
                false => send(workspace, InputEvent::MouseUp(button), effects),
            };
            match (taken, modal && *pressed) {
                (true, true) => EventUse::Alone,
                (true, false) => EventUse::Both,
                (false, _) => EventUse::Nothing,
            }
        }
        Event::Key { key, pressed: true, repeat, modifiers, .. } => {
            hold(workspace, *modifiers, effects);
            let drags = workspace.tools.controls().is_busy() || workspace.tools.controls().is_modal();
            let types = context.egui_wants_keyboard_input() || Popup::is_any_open(context);
            if types && !drags {
                return EventUse::Nothing;
            }
            if let Some(used) = typed_for_nothing(workspace, key_of(*key, written), written) {
                return used;
            }
            let Some(key) = key_of(*key, written) else {
                return if drags { EventUse::Alone } else { EventUse::Nothing };
            };
            // Repeats of a held letter would lock and unlock an axis in turn.
            let counts = !*repeat || key == Key::Backspace;
            let taken = counts && press(workspace, key, effects);
            match (drags || taken, written) {
                (true, Some(_)) => EventUse::AloneWithText,
                (true, None) => EventUse::Alone,
                (false, _) => EventUse::Nothing,
            }
        }
        // The window system reports Ctrl+X as Cut; during a drag it means the X axis with snapping.
        Event::Cut if workspace.tools.controls().is_busy() => {
            press(workspace, Key::letter('x'), effects);
            EventUse::Alone
        }
        Event::Copy | Event::Paste(_) if workspace.tools.controls().is_busy() => EventUse::Alone,
        // A character that was typed without an event of its key.
        Event::Text(text) if workspace.tools.controls().is_busy() => {
            for letter in text.chars() {
                press(workspace, Key::letter(letter), effects);
            }
            EventUse::Alone
        }
        Event::WindowFocused(false) => {
            send(workspace, InputEvent::Lost, effects);
            lose_input(workspace, context, effects);
            EventUse::Both
        }
        _ => EventUse::Nothing,
    }
}

/// Handles a key that is typed after a key tried to begin a drag that was refused: keys for the axis, the number and
/// the end of that drag have no other effect. Otherwise typing `R`, `X`, `30`, Enter would delete keys and change the
/// view.
fn typed_for_nothing(workspace: &mut Workspace, key: Option<Key>, written: Option<char>) -> Option<EventUse> {
    let at = workspace.tools.take_refused_drag()?;
    let goes_on = match key? {
        Key::Letter(letter) => "xyz0123456789.,-+*/()".contains(letter),
        Key::Backspace => true,
        Key::Enter | Key::Escape => {
            return (at.elapsed() < PATIENCE).then_some(EventUse::Alone);
        }
        _ => false,
    };
    if !goes_on || at.elapsed() >= PATIENCE {
        return None;
    }
    workspace.tools.refuse_drag(Instant::now());
    Some(if written.is_some() { EventUse::AloneWithText } else { EventUse::Alone })
}

/// Time after the last key within which more keys are expected.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Passes on the modifiers that are held.
fn hold(workspace: &mut Workspace, modifiers: egui::Modifiers, effects: &mut Vec<Effect>) {
    let modifiers = Modifiers { shift: modifiers.shift, ctrl: modifiers.command, alt: modifiers.alt };
    if workspace.tools.controls().modifiers() != modifiers {
        send(workspace, InputEvent::Modifiers(modifiers), effects);
    }
}

fn press(workspace: &mut Workspace, key: Key, effects: &mut Vec<Effect>) -> bool {
    let taken = send(workspace, InputEvent::KeyDown(key), effects);
    // Nothing here depends on how long a key is held, and its release may go to another window.
    send(workspace, InputEvent::KeyUp(key), effects);
    taken
}

/// Moves the mouse; over a menu or a card it is not over the viewport.
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

/// Returns whether a menu, a sheet or a card covers the panels there.
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

/// Returns the key; `written` is the letter that it writes, where the window reported it.
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
