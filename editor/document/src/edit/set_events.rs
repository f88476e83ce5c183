//! Stores events with a take.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeEvent, TakeRef};
use crate::adapter::plan::{Transaction, events};
use crate::adapter::{EditError, stored_events};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Stores events with a take in place of those that it has. They are kept in the file, and follow when keys move in time: when the
/// take is retimed, reversed, trimmed, split or rippled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetEvents {
    /// The take.
    pub take: TakeRef,
    /// All events of the take, in any order; none where empty.
    #[serde(default)]
    pub events: Vec<TakeEvent>,
}

map_references!(SetEvents { take }, |edit, map| {
    events: match map.slots() {
        Some((old, new)) => {
            let [old, new] = [old, new].map(|slot| stored_events(&slot.original.extras));
            merged(&old, &edit.events, new)
        }
        None => edit.events.clone(),
    },
});

/// Returns the events `new` with the difference between `before` and `after`.
fn merged(before: &[TakeEvent], after: &[TakeEvent], mut new: Vec<TakeEvent>) -> Vec<TakeEvent> {
    let mut added = after.to_vec();
    for event in before {
        match added.iter().position(|other| other == event) {
            Some(kept) => drop(added.remove(kept)),
            None => {
                if let Some(removed) = new.iter().position(|other| other == event) {
                    new.remove(removed);
                }
            }
        }
    }
    new.extend(added);
    new
}

impl EditKind for SetEvents {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_events","take":"Walk","events":[{"time":0.25,"name":"step","payload":{"foot":"left"}}]}"#,
        description: "Makes a step of the left foot the only event of the take.",
    };

    fn label(&self) -> &'static str {
        if self.events.is_empty() { "Delete events" } else { "Set events" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn detail(&self, _adapter: &crate::adapter::ModelAdapter) -> Option<String> {
        match &self.events[..] {
            [] => None,
            [event] => Some(event.name.clone()),
            several => Some(format!("{} events", several.len())),
        }
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        if events::store(work, take, self.events.clone())? {
            Ok(())
        } else {
            Err(EditError::Nothing("the take has these events already"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let events = (0..from.below(4)).map(|_| TakeEvent::arbitrary(from)).collect();
        Self { take: from.take(), events }
    }
}
