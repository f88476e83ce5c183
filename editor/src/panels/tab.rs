//! Keyboard navigation with Tab after the focus was lost.
//!
//! Without this, egui starts at the first widget of the window. After Enter in a number field, that is far from the
//! next field.

use egui::{Context, Event, Id, Key, Plugin, RawInput};

/// Remembers the widget that had the focus last, and lets Tab continue from there. A mouse press resets it.
#[derive(Debug, Default)]
pub(super) struct TabGoesOn {
    last: Option<Id>,
}

impl Plugin for TabGoesOn {
    fn debug_name(&self) -> &'static str {
        "where Tab goes on"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        if let Some(focused) = context.memory(|memory| memory.focused()) {
            self.last = Some(focused);
        } else if input.events.iter().any(is_press) {
            self.last = None;
        } else if let Some(last) = self.last
            && input.events.iter().any(is_tab)
            // A widget that no longer exists would swallow the key, and so would one below a modal dialog.
            && let Some(there) = context.read_response(last)
            && context.memory(|memory| memory.allows_interaction(there.layer_id))
        {
            context.memory_mut(|memory| memory.request_focus(last));
        }
    }
}

fn is_press(event: &Event) -> bool {
    matches!(event, Event::PointerButton { pressed: true, .. })
}

/// Returns whether the event is a press of Tab, alone or with Shift. With other modifier keys, Tab does not move
/// the focus.
fn is_tab(event: &Event) -> bool {
    let Event::Key { key: Key::Tab, pressed: true, modifiers, .. } = event else { return false };
    !modifiers.any() || modifiers.shift_only()
}
