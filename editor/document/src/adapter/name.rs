//! What a take may be called from now on.
//!
//! Asked where people and programs ask for edits. What is in a file may be called anything, and a journal is done again
//! as it was done: earlier versions let takes have any name.

use super::super::edit::Edit;
use super::{EditError, ModelAdapter, Slot, TakeId};
use std::sync::Arc;

/// Can a take be called `name`, where `own` is the one that is to be?
///
/// # Errors
///
/// [`EditError::NoName`], or [`EditError::NameTaken`] where another of `takes` is called so: an edit that names it could
/// mean either.
pub fn take_name(takes: &[Arc<Slot>], name: &str, own: Option<TakeId>) -> Result<(), EditError> {
    if name.trim().is_empty() {
        return Err(EditError::NoName);
    }
    let other = takes.iter().any(|slot| slot.result.name == name && Some(slot.id) != own);
    if other { Err(EditError::NameTaken(name.to_owned())) } else { Ok(()) }
}

impl ModelAdapter {
    /// Can this be asked for? Not all that [`Self::apply`] can do is.
    ///
    /// # Errors
    ///
    /// Why not.
    pub fn allows(&self, edit: &Edit) -> Result<(), EditError> {
        edit.allowed(self)
    }
}
