//! original + changes = result: a model's takes as a person edits them (thesis §2.2.2, §3.2.10.1).
//!
//! A [`ModelAdapter`] has each take three times ([`Slot`]). The *original* is what was read and is never altered; the
//! *changes* say what was changed of which key; the *result* is what is shown and saved. Per channel:
//!
//! ```text
//! translation   result = original + change
//! rotation      result = normalize(change * original)       space of the parent
//! scale         result = original * change                  per component
//! ```
//!
//! A key without a change is the original bit for bit, and a channel without one shares its columns with the original.
//! What alters the structure (keys and takes made, moved, deleted) is done in all three alike.
//!
//! [`ModelAdapter::apply`] turns an [`Edit`] into a few operations (`op`), each of which knows its inverse; `plan` has
//! a file a family of edits. What an edit costs, in time and in what its inverse keeps, is in proportion to what it
//! touches: a change of a key touches the column of its channel.

mod change;
mod check;
mod drag;
mod error;
mod kind;
mod name;
mod op;
mod pending;
mod plan;
mod slot;
mod times;

pub use change::KeyChange;
pub use check::Broken;
pub(crate) use drag::Drag;
pub use error::EditError;
pub use kind::Numbers;
pub use name::take_name;
pub use pending::{Pending, PendingAt, PendingPose};
pub use slot::{Changes, Slot, TakeId};

use super::edit::{BoneRef, Edit, TakeRef};
use dragonfly_anim::data::{AnimationData, Skeleton, Take};
use op::Op;
use plan::Work;
use std::sync::Arc;

/// The takes of a model in their three forms. A copy is cheap: everything large is shared.
#[derive(Clone, Debug)]
pub struct ModelAdapter {
    skeleton: Arc<Skeleton>,
    slots: Vec<Arc<Slot>>,
    /// The number of the next take that is made.
    next: u32,
}

/// What leads back from an edit, or forth again.
#[derive(Clone)]
pub struct Inverse(Vec<Op>);

impl std::fmt::Debug for Inverse {
    /// How many; what they hold would fill pages.
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "Inverse({} operations)", self.0.len())
    }
}

impl Inverse {
    /// Bytes that it keeps, about.
    pub fn bytes(&self) -> usize {
        self.0.iter().map(Op::bytes).sum()
    }
}

impl ModelAdapter {
    /// The takes of a model as it was read.
    pub fn new(animation: &AnimationData) -> Self {
        let slots: Vec<_> = animation
            .takes
            .iter()
            .enumerate()
            .map(|(index, take)| {
                Arc::new(Slot::unchanged(TakeId(index as u32), Some(index), Arc::clone(take)))
            })
            .collect();
        Self { skeleton: Arc::clone(&animation.skeleton), next: slots.len() as u32, slots }
    }

    /// The takes of a model as they were in another adapter.
    pub(crate) fn of_slots(skeleton: &Arc<Skeleton>, slots: &[Arc<Slot>]) -> Self {
        let next = slots.iter().map(|slot| slot.id.0 + 1).max().unwrap_or_default();
        Self { skeleton: Arc::clone(skeleton), slots: slots.to_vec(), next }
    }

    /// The skeleton, which no edit alters.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.skeleton
    }

    /// The takes in their order.
    pub fn slots(&self) -> &[Arc<Slot>] {
        &self.slots
    }

    /// The results in their order: what is shown and saved.
    pub fn results(&self) -> impl Iterator<Item = &Arc<Take>> {
        self.slots.iter().map(|slot| &slot.result)
    }

    /// How many poses are pending in all takes: in no key, and in no file that is saved.
    pub fn pending_poses(&self) -> usize {
        self.slots.iter().map(|slot| slot.pending_poses()).sum()
    }

    /// The take that is meant; a name wins over a number.
    ///
    /// # Errors
    ///
    /// [`EditError::NoTake`].
    pub fn take(&self, take: &TakeRef) -> Result<&Arc<Slot>, EditError> {
        let found = match take {
            TakeRef::Index(index) => self.slots.get(*index),
            TakeRef::Name(name) => self.slots.iter().find(|slot| slot.original.name == *name),
        };
        found.ok_or_else(|| EditError::NoTake(take.clone()))
    }

    /// The bone that is meant.
    ///
    /// # Errors
    ///
    /// [`EditError::NoBone`].
    pub fn bone(&self, bone: &BoneRef) -> Result<u32, EditError> {
        let found = match bone {
            BoneRef::Index(index) => Some(*index).filter(|&index| (index as usize) < self.skeleton.len()),
            BoneRef::Name(name) => self.skeleton.find(name),
        };
        found.ok_or_else(|| EditError::NoBone(bone.clone()))
    }

    /// Does an edit; what undoes it.
    ///
    /// # Errors
    ///
    /// Why it cannot be done; nothing has changed then.
    pub fn apply(&mut self, edit: &Edit) -> Result<Inverse, EditError> {
        let mut work = Work::on(self.clone());
        plan::run(&mut work, edit)?;
        let (adapter, mut undo) = work.done();
        *self = adapter;
        undo.reverse();
        Ok(Inverse(undo))
    }

    /// Undoes what `inverse` stands for; what does it again. Inverses are used in the opposite order of their edits.
    pub fn revert(&mut self, inverse: Inverse) -> Inverse {
        let mut work = Work::on(self.clone());
        for op in inverse.0 {
            work.perform(op);
        }
        let (adapter, mut redo) = work.done();
        *self = adapter;
        redo.reverse();
        Inverse(redo)
    }

    /// A number that no take had.
    pub(super) fn new_id(&mut self) -> TakeId {
        self.next += 1;
        TakeId(self.next - 1)
    }
}
