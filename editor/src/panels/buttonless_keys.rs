//! The overlay during a drag of keys without a button: it covers the window, so that the pointer reaches nothing else, and
//! reads the keys that constrain, measure, confirm and cancel the drag.

use super::context::PanelContext;
use super::key_canvases;
use super::keys::{ButtonlessDrag, ButtonlessKind, ButtonlessStart, ButtonlessStep, KeyAxis, KeysRequest};
use super::request::Request;
use egui::{Area, Context, Event, Key, Order, PointerButton, Sense, Ui};

/// Draws the overlay if keys are dragged without a button.
pub(super) fn show(ui: &Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let Some(drag) = context.keys.buttonless() else { return };
    let screen = ui.ctx().content_rect();
    Area::new(egui::Id::unique("drag of keys")).order(Order::Foreground).fixed_pos(screen.min).show(
        ui.ctx(),
        |ui| {
            ui.allocate_rect(screen, Sense::click_and_drag());
        },
    );
    let mut request = |request| requests.push(Request::Timeline(request));
    if drag.start().is_none() {
        match start(ui.ctx()) {
            Some(start) => request(KeysRequest::Buttonless(ButtonlessStep::Start(start))),
            // Neither the timeline nor the curves are shown.
            None => request(KeysRequest::Cancel),
        }
        return;
    }
    for read in ui.input_mut(read) {
        request(read);
    }
    ui.ctx().request_repaint();
}

/// Returns the panel under the pointer; elsewhere the first one that is shown.
fn start(context: &Context) -> Option<ButtonlessStart> {
    let shown = key_canvases::shown(context);
    let pointer = context.input(|input| input.pointer.latest_pos());
    let under = pointer.and_then(|at| shown.iter().find(|(_, rect)| rect.contains(at)));
    let (panel, rect) = *under.or_else(|| shown.first())?;
    Some(ButtonlessStart { panel, at: pointer.unwrap_or_else(|| rect.center()) })
}

/// Reads what concerns the drag, and takes it away from everything else.
fn read(input: &mut egui::InputState) -> Vec<KeysRequest> {
    let mut found = Vec::new();
    input.events.retain(|event| {
        let read = match event {
            Event::Key { key, pressed: true, modifiers, .. } if !modifiers.command && !modifiers.alt => {
                of_key(*key)
            }
            Event::Text(text) => {
                let typed = text.chars().filter(|typed| typed.is_ascii_digit() || ".,-".contains(*typed));
                found.extend(typed.map(|typed| KeysRequest::Buttonless(ButtonlessStep::Typed(typed))));
                None
            }
            _ => None,
        };
        found.extend(read);
        !matches!(event, Event::Key { .. } | Event::Text(_) | Event::Copy | Event::Cut | Event::Paste(_))
    });
    if input.pointer.button_pressed(PointerButton::Secondary) {
        found.push(KeysRequest::Cancel);
    } else if input.pointer.button_pressed(PointerButton::Primary) {
        found.push(KeysRequest::Release);
    }
    found
}

/// Returns what a key does during the drag.
fn of_key(key: Key) -> Option<KeysRequest> {
    let step = match key {
        Key::Enter => return Some(KeysRequest::Release),
        Key::Escape => return Some(KeysRequest::Cancel),
        Key::X => ButtonlessStep::Axis(KeyAxis::Time),
        Key::Y => ButtonlessStep::Axis(KeyAxis::Value),
        Key::Backspace => ButtonlessStep::Backspace,
        _ => return None,
    };
    Some(KeysRequest::Buttonless(step))
}

/// Returns what is possible during the drag, for the status line.
pub(super) fn hint(drag: &ButtonlessDrag) -> &'static str {
    match drag.kind() {
        ButtonlessKind::Move => {
            "Move keys: X time, Y value · digits enter frames or a value · Enter or click confirms · Esc cancels"
        }
        ButtonlessKind::Scale => "Scale keys: digits enter a factor · Enter or click confirms · Esc cancels",
        ButtonlessKind::Duplicate => {
            "Duplicate keys: digits enter frames · Enter or click confirms · Esc cancels"
        }
    }
}
