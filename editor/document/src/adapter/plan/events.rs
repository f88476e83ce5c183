//! The events that are stored with a take, changed together with its keys.

use super::super::event_record::{EVENTS, MOST_EVENTS, events_text, stored_events};
use super::super::op::Op;
use super::super::slot::TakeId;
use super::{EditError, Transaction, finite};
use crate::edit::TakeEvent;

/// Longest name of an event, characters, and longest text of its payload, bytes.
const LONGEST: (usize, usize) = (200, 16 << 10);

/// Stores events with a take, ascending by time. Returns whether they are others than before.
pub(crate) fn store(work: &mut Transaction, take: TakeId, events: Vec<TakeEvent>) -> Result<bool, EditError> {
    if events.len() > MOST_EVENTS {
        return Err(EditError::Nothing("a take has at most 1,000 events"));
    }
    for event in &events {
        finite("the time", event.time)?;
        let letters = event.name.chars().count();
        if letters == 0 || letters > LONGEST.0 {
            return Err(EditError::Nothing("the name of an event has 1 to 200 characters"));
        }
        if event.payload.as_ref().is_some_and(|payload| payload.to_string().len() > LONGEST.1) {
            return Err(EditError::Nothing("the payload of an event has at most 16 KiB"));
        }
    }
    Ok(replace(work, take, events))
}

/// Puts events in place of those of a take, ascending by time. Returns whether they are others than before.
fn replace(work: &mut Transaction, take: TakeId, mut events: Vec<TakeEvent>) -> bool {
    // Events at one time keep their order.
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    let text = events_text(events);
    if work.slot(take).original.extras.get(EVENTS) == text.as_ref() {
        return false;
    }
    work.perform(Op::Extras(take, EVENTS.to_owned(), text));
    true
}

/// Moves the events of a take to the times that `to` returns, and removes those for which it returns `None`. Names and payloads
/// stay, also those of another program that [`store`] would refuse.
pub(crate) fn remap(
    work: &mut Transaction,
    take: TakeId,
    to: impl Fn(f32) -> Option<f32>,
) -> Result<(), EditError> {
    let before = stored_events(&work.slot(take).original.extras);
    if before.is_empty() {
        return Ok(());
    }
    let moved = |event: &TakeEvent| Some(TakeEvent { time: to(event.time)?, ..event.clone() });
    let after: Vec<TakeEvent> = before.iter().filter_map(moved).collect();
    for event in &after {
        finite("the time", event.time)?;
    }
    if after != before {
        replace(work, take, after);
    }
    Ok(())
}
