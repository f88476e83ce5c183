//! Names that takes may have.
//!
//! The check applies to edits of users and programs. Takes of a file may have any name, and journals are replayed
//! without the check: earlier versions of the program allowed any name.

use super::super::edit::Edit;
use super::{EditError, ModelAdapter, TakeId, TakeVersions, TextEditError};
use std::sync::Arc;

/// Checks that a take can have the name `name`; `own` is the take to rename.
///
/// # Errors
///
/// [`EditError::NoName`], or [`EditError::NameTaken`] where another of `takes` has the name: a reference by that name
/// would be ambiguous.
pub fn take_name(takes: &[Arc<TakeVersions>], name: &str, own: Option<TakeId>) -> Result<(), EditError> {
    if name.trim().is_empty() {
        return Err(EditError::NoName);
    }
    let other = takes.iter().any(|slot| slot.result.name == name && Some(slot.id) != own);
    if other { Err(EditError::NameTaken(name.to_owned())) } else { Ok(()) }
}

impl ModelAdapter {
    /// Checks that an edit of the user or of a program is allowed. Not every edit that [`Self::apply`] can apply is.
    ///
    /// # Errors
    ///
    /// The reason why it is not allowed.
    pub fn allows(&self, edit: &Edit) -> Result<(), EditError> {
        // A scene has models of its own; the document itself has none.
        if !self.texts().is_empty() && !matches!(edit, Edit::EditScript(_)) {
            return Err(TextEditError::NoModel.into());
        }
        edit.allowed(self)
    }
}
