//! Events of the take that is shown.

use super::edit;
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use dragonfly_document::adapter::stored_events;
use dragonfly_document::edit::{SetEvents, TakeEvent};

/// Adds an event at the time shown.
pub(in crate::panels) fn add_event(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let (take, slot, time) = (panels.shown_take_ref()?, panels.slot()?, panels.time());
    let mut events = stored_events(&slot.result.extras);
    let name = format!("Event {}", events.len() + 1);
    events.push(TakeEvent { time, name, payload: None });
    Some(edit(SetEvents { take, events }.into()))
}
