//! Where Tab goes on when nothing has the keyboard any more.
//!
//! egui begins at the first thing in the window then, which after Enter in a number is a long way from the next number.

use egui::{Context, Event, Id, Key, Plugin, RawInput};

/// Remembers what had the keyboard last, and lets Tab go on from there. A press of the mouse is a new begin.
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
            // What is not there any more would swallow the key, and so would what lies below a question.
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

/// With other keys than Shift it moves no focus.
fn is_tab(event: &Event) -> bool {
    let Event::Key { key: Key::Tab, pressed: true, modifiers, .. } = event else { return false };
    !modifiers.any() || modifiers.shift_only()
}
