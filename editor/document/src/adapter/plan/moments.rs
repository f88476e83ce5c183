//! Pending poses and events: each is at a single moment of a take, and an edit that moves keys in time moves both.

use super::super::slot::TakeId;
use super::{EditError, Transaction, events, pending};

/// Moves pending poses and events to the times that `to` returns, and removes those for which it returns `None`.
pub(crate) fn remap(
    work: &mut Transaction,
    take: TakeId,
    to: impl Fn(f32) -> Option<f32>,
) -> Result<(), EditError> {
    pending::remap(work, take, &to);
    events::remap(work, take, to)
}
