//! Input as the window tells it, to inputs of the scene.
//!
//! The window's events come here before the panels are drawn, so a drag does not wait for them. What is for the scene alone,
//! as a letter typed while dragging, is taken out of the list; all else is left for the panels.

use super::place;
use crate::control::{Button, InputEvent, Key, Modifiers};
use crate::panels::state::{Effect, State};
use egui::{Context, Event, Order, PointerButton, Popup, Pos2, RawInput};
use std::time::{Duration, Instant};

/// Gives the scene the events of `input` from `from` on, and takes out what only it is to hear. Tells whether the picture
/// may look different now.
pub fn feed(
    context: &Context,
    state: &mut State,
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
        let heard = hear(context, state, &input.events[index], written, effects);
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
    state: &mut State,
    event: &Event,
    written: Option<char>,
    effects: &mut Vec<Effect>,
) -> Heard {
    match event {
        Event::PointerMoved(at) => {
            move_to(context, state, *at, effects);
            if state.hands.is_busy() { Heard::Both } else { Heard::Nothing }
        }
        Event::PointerGone => {
            state.input(InputEvent::MouseGone, effects);
            Heard::Both
        }
        Event::ModifiersChanged(modifiers) => {
            hold(state, *modifiers, effects);
            if state.hands.is_busy() { Heard::Both } else { Heard::Nothing }
        }
        Event::PointerButton { pos, button, pressed, modifiers } => {
            let Some(button) = button_of(*button) else { return Heard::Nothing };
            hold(state, *modifiers, effects);
            move_to(context, state, *pos, effects);
            let modal = state.hands.is_modal();
            let taken = match pressed {
                true if !state.hands.is_busy() && is_covered(context, *pos) => false,
                true => state.input(InputEvent::MouseDown(button), effects),
                false => state.input(InputEvent::MouseUp(button), effects),
            };
            match (taken, modal && *pressed) {
                (true, true) => Heard::Alone,
                (true, false) => Heard::Both,
                (false, _) => Heard::Nothing,
            }
        }
        Event::Key { key, pressed: true, repeat, modifiers, .. } => {
            hold(state, *modifiers, effects);
            let drags = state.hands.is_busy() || state.hands.is_modal();
            let types = context.egui_wants_keyboard_input() || Popup::is_any_open(context);
            if types && !drags {
                return Heard::Nothing;
            }
            if let Some(heard) = typed_for_nothing(state, key_of(*key, written), written) {
                return heard;
            }
            let Some(key) = key_of(*key, written) else {
                return if drags { Heard::Alone } else { Heard::Nothing };
            };
            // A letter held down would bind and free an axis in turn.
            let counts = !*repeat || key == Key::Backspace;
            let taken = counts && press(state, key, effects);
            match (drags || taken, written) {
                (true, Some(_)) => Heard::AloneWithText,
                (true, None) => Heard::Alone,
                (false, _) => Heard::Nothing,
            }
        }
        // Ctrl and X, which mean an axis and a snap here.
        Event::Cut if state.hands.is_busy() => {
            press(state, Key::letter('x'), effects);
            Heard::Alone
        }
        Event::Copy | Event::Paste(_) if state.hands.is_busy() => Heard::Alone,
        // Of a letter that no key has a name for.
        Event::Text(text) if state.hands.is_busy() => {
            for letter in text.chars() {
                press(state, Key::letter(letter), effects);
            }
            Heard::Alone
        }
        Event::WindowFocused(false) => {
            state.input(InputEvent::Lost, effects);
            state.lose_input(context, effects);
            Heard::Both
        }
        _ => Heard::Nothing,
    }
}

/// A drag that a key asked for was refused just now: its axis, its number and the key that ends it are for nothing else. `R`,
/// `X`, `30`, Enter would else delete keys and change the view.
fn typed_for_nothing(state: &mut State, key: Option<Key>, written: Option<char>) -> Option<Heard> {
    let at = state.refused_drag.take()?;
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
    state.refused_drag = Some(Instant::now());
    Some(if written.is_some() { Heard::AloneWithText } else { Heard::Alone })
}

/// As long as this after the last key more is expected.
const PATIENCE: Duration = Duration::from_millis(1500);

/// These keys are held besides.
fn hold(state: &mut State, modifiers: egui::Modifiers, effects: &mut Vec<Effect>) {
    let modifiers = Modifiers { shift: modifiers.shift, ctrl: modifiers.command, alt: modifiers.alt };
    if state.hands.modifiers() != modifiers {
        state.input(InputEvent::Modifiers(modifiers), effects);
    }
}

fn press(state: &mut State, key: Key, effects: &mut Vec<Effect>) -> bool {
    let taken = state.input(InputEvent::KeyDown(key), effects);
    // Nothing here depends on how long a key is held, and its release may be told to somebody else.
    state.input(InputEvent::KeyUp(key), effects);
    taken
}

/// The mouse is there; over a menu or a card it is not over the scene.
fn move_to(context: &Context, state: &mut State, at: Pos2, effects: &mut Vec<Effect>) {
    let to = place(at);
    if !state.hands.is_busy() && is_covered(context, at) {
        if state.hands.pointer().is_some() {
            state.input(InputEvent::MouseGone, effects);
        }
    } else if state.hands.pointer() != Some(to) {
        state.input(InputEvent::MouseMove(to), effects);
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
