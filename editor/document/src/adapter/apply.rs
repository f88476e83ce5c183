//! Applying an edit, and undoing it.

use super::op::Op;
use super::pending::PendingAt;
use super::plan::Transaction;
use super::{EditError, ModelAdapter};
use crate::edit::{Edit, EditedBones};
use std::collections::BTreeSet;
use std::sync::Arc;

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
        let (adapter, mut undo, touched) = work.done();
        adapter.within_limits(self, &touched)?;
        // Locks ask the edit for its bones, so it cannot change others.
        if let EditedBones::Named(named) = edit.bones(&self.skeleton) {
            only_named(&named, self, &adapter, &undo)?;
        }
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
        let (adapter, mut redo, _) = work.done();
        *self = adapter;
        redo.reverse();
        Inverse(redo)
    }
}

/// Checks that the operations of an edit changed only bones that it names.
fn only_named(
    named: &BTreeSet<u32>,
    before: &ModelAdapter,
    after: &ModelAdapter,
    undo: &[Op],
) -> Result<(), EditError> {
    for op in undo {
        let bone = match op {
            Op::Changes(place, _)
            | Op::AllChanges(place, _)
            | Op::Splice(place, ..)
            | Op::Times(place, _)
            | Op::Replace(place, _) => (!named.contains(&place.bone)).then_some(place.bone),
            Op::Pending(take, time, _) => {
                let [old, new] = [before, after]
                    .map(|adapter| adapter.slot(*take).and_then(|slot| slot.pending_at(*time)));
                let poses = [old, new].into_iter().flatten().flat_map(|at| &at.poses);
                let mut bones = poses.map(|pose| pose.bone);
                let pose = |at: Option<&Arc<PendingAt>>, bone| at.and_then(|at| at.of(bone).copied());
                bones.find(|bone| !named.contains(bone) && pose(old, *bone) != pose(new, *bone))
            }
            Op::Morphs(..)
            | Op::Layers(..)
            | Op::Name(..)
            | Op::Extras(..)
            | Op::Insert(..)
            | Op::Remove(_)
            | Op::Move(..)
            | Op::Skeleton(..)
            | Op::Text(..)
            | Op::Texts(_) => None,
        };
        if let Some(bone) = bone {
            return Err(EditError::Unnamed(bone));
        }
    }
    Ok(())
}
