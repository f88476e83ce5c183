//! Applying an edit, and undoing it.

use super::op::Op;
use super::plan::Transaction;
use super::{EditError, ModelAdapter};
use crate::edit::Edit;

/// The operations that undo or redo an edit.
#[derive(Clone)]
pub struct Inverse(pub(super) Vec<Op>);

impl std::fmt::Debug for Inverse {
    /// Writes only the number of operations: their data would fill pages.
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "Inverse({} operations)", self.0.len())
    }
}

impl Inverse {
    /// Returns its approximate size in bytes.
    pub fn bytes(&self) -> usize {
        self.0.iter().map(Op::bytes).sum()
    }
}

impl ModelAdapter {
    /// Applies an edit and returns the inverse that undoes it.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be applied; nothing has changed then.
    pub fn apply(&mut self, edit: &Edit) -> Result<Inverse, EditError> {
        let mut work = Transaction::on(self.clone());
        edit.plan(&mut work)?;
        let (adapter, mut undo) = work.done();
        *self = adapter;
        undo.reverse();
        Ok(Inverse(undo))
    }

    /// Undoes the edit of `inverse`, and returns the inverse that redoes it. Inverses are used in the opposite order
    /// of their edits.
    pub fn revert(&mut self, inverse: Inverse) -> Inverse {
        let mut work = Transaction::on(self.clone());
        for op in inverse.0 {
            work.perform(op);
        }
        let (adapter, mut redo) = work.done();
        *self = adapter;
        redo.reverse();
        Inverse(redo)
    }
}
