//! The events of a take in its extras.
//!
//! ```json
//! {"version": 1, "events": [{"time": 0.25, "name": "step", "payload": {"foot": "left"}}]}
//! ```
//!
//! Times are seconds, on the clock of the take, ascending; the payload is any JSON value, or absent. A text that is none of this, or
//! has too many events, counts as no events: another program may have written it, and it stays as it is.

use crate::edit::TakeEvent;
use dragonfly_anim::data::TakeExtras;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Name of the events in the extras of a take.
pub const EVENTS: &str = "events";

/// Version of the record. It grows when an older program could misunderstand a newer record.
const VERSION: u32 = 1;

/// Largest number of events of a take.
pub const MOST_EVENTS: usize = 1000;

#[derive(Serialize, Deserialize)]
struct EventsRecord {
    version: u32,
    events: Vec<TakeEvent>,
}

/// Returns the events that are stored with a take, ascending by time; none where there are more than [`MOST_EVENTS`].
pub fn stored_events(extras: &TakeExtras) -> Vec<TakeEvent> {
    let record = extras.get(EVENTS).and_then(|text| serde_json::from_str::<EventsRecord>(text).ok());
    let is_ours = |record: &EventsRecord| record.version == VERSION && record.events.len() <= MOST_EVENTS;
    let Some(record) = record.filter(is_ours) else { return Vec::new() };
    let mut events = record.events;
    events.retain(|event| event.time.is_finite());
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    events
}

/// Returns the text for the extras; `None` for no events.
pub(crate) fn events_text(events: Vec<TakeEvent>) -> Option<Arc<str>> {
    if events.is_empty() {
        return None;
    }
    serde_json::to_string(&EventsRecord { version: VERSION, events }).ok().map(Arc::from)
}
