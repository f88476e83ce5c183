//! A pose that is being dragged: the same channels at the same time get new values again and again.
//!
//! Each edit of a gesture applies to the document as it was when the gesture started. Undoing the previous
//! edit and applying the next one would copy the columns of their channels with every move of the mouse. So where only
//! values differ, the next edit overwrites the previous one, in memory that is no longer shown. The result is the same
//! to the bit.

use super::change::KeyChange;
use super::kind::{ChannelKind, RotationChannel, ScaleChannel, TranslationChannel};
use super::op::{ChannelAddress, Op};
use super::plan::PoseMode;
use super::plan::pose::{changed, rotation, vector};
use super::slot::TakeVersions;
use super::{EditError, Inverse, ModelAdapter};
use crate::edit::Edit;
use crate::edit::pose::BonePose;
use crate::edit::target::{Property, TakeRef};
use std::sync::Arc;

/// Number of states of a take that are kept to be overwritten: those that panels and graphics show, and a free one.
const KEPT: usize = 4;

/// The keys whose values a drag overwrites; see the module.
#[derive(Clone, Debug)]
pub(crate) struct ValueDrag {
    time: u32,
    channels: Vec<HeldKey>,
    kept: Vec<Arc<TakeVersions>>,
}

/// A key whose value is dragged.
#[derive(Clone, Copy, Debug)]
struct HeldKey {
    address: ChannelAddress,
    key: u32,
    /// Change of the key when the gesture started.
    before: Option<KeyChange>,
}

impl ValueDrag {
    /// Starts after `edit`, which `inverse` undoes; `None` where later edits may do more than set values.
    pub(crate) fn of(adapter: &ModelAdapter, edit: &Edit, inverse: &Inverse) -> Option<Self> {
        let (time, poses, _) = edit.values()?;
        // The take that layers give is computed after each edit.
        if !adapter.base(edit.take()?).ok()?.layers().is_empty() {
            return None;
        }
        let mut held: Vec<HeldKey> = Vec::new();
        for op in &inverse.0 {
            match op {
                Op::Changes(address, before) => match before[..] {
                    [(key, before)] => held.push(HeldKey { address: *address, key, before }),
                    _ => return None,
                },
                // The edit added a key, whose value the next edits overwrite.
                Op::Splice(_, gone, back) if gone.len() == 1 && back.is_empty() => {}
                // The edit made a step channel linear; the next edits need not do that again.
                Op::Replace(..) => {}
                _ => return None,
            }
        }
        held.reverse();
        let drag = Self { time: time.to_bits(), channels: held, kept: Vec::new() };
        drag.fits(adapter, edit.take()?, poses).then_some(drag)
    }

    /// Returns whether these are the dragged channels, each once and in order.
    fn fits(&self, adapter: &ModelAdapter, take: &TakeRef, poses: &[BonePose]) -> bool {
        let Ok(take) = adapter.take(take).map(|slot| slot.id) else { return false };
        let mut held = self.channels.iter().map(|held| held.address);
        for pose in poses {
            let Ok(bone) = adapter.bone(&pose.bone) else { return false };
            for property in Property::ALL {
                let given = match property {
                    Property::Translation => pose.translation.is_some(),
                    Property::Rotation => pose.rotation.is_some(),
                    Property::Scale => pose.scale.is_some(),
                };
                if given && held.next() != Some(ChannelAddress { take, bone, property }) {
                    return false;
                }
            }
        }
        let twice = |(at, held): (usize, &HeldKey)| {
            self.channels[..at].iter().any(|other| other.address == held.address)
        };
        // Comparing more than a few hundred channels is no faster than applying the edit again.
        held.next().is_none()
            && (1..=512).contains(&self.channels.len())
            && !self.channels.iter().enumerate().any(twice)
    }

    /// Applies the next edit of the gesture in place of the previous one. Returns `None`, and changes nothing, if it
    /// gives other channels a value or belongs to another time.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be applied; nothing has changed then.
    pub(crate) fn amend(&mut self, adapter: &mut ModelAdapter, edit: &Edit) -> Option<Result<(), EditError>> {
        let (time, poses, mode) = edit.values()?;
        if time.to_bits() != self.time || !self.fits(adapter, edit.take()?, poses) {
            return None;
        }
        let take = self.channels.first()?.address.take;
        let index = adapter.slots.iter().position(|slot| slot.id == take)?;
        let now = &adapter.slots[index];
        let changes = match self.changes(now, poses, mode) {
            Ok(changes) => changes,
            Err(error) => return Some(Err(error)),
        };
        let mut next = self.free().unwrap_or_else(|| Arc::new(TakeVersions::clone(now)));
        let slot = Arc::make_mut(&mut next);
        for (held, change) in self.channels.iter().zip(changes) {
            slot.set_changes(held.address.bone, held.address.property, &[(held.key, change)]);
        }
        let before = std::mem::replace(&mut adapter.slots[index], next);
        if self.kept.len() == KEPT {
            self.kept.remove(0);
        }
        self.kept.push(before);
        Some(Ok(()))
    }

    /// Returns a state that is no longer shown. It differs from the newest one only in the dragged values.
    fn free(&mut self) -> Option<Arc<TakeVersions>> {
        let is_free =
            |slot: &Arc<TakeVersions>| Arc::strong_count(slot) == 1 && Arc::strong_count(&slot.result) == 1;
        let at = self.kept.iter().position(is_free)?;
        Some(self.kept.remove(at))
    }

    /// Returns the change of each channel, relative to the key at the start of the gesture.
    fn changes(
        &self,
        slot: &TakeVersions,
        poses: &[BonePose],
        mode: PoseMode,
    ) -> Result<Vec<Option<KeyChange>>, EditError> {
        let mut held = self.channels.iter();
        let mut found = Vec::with_capacity(self.channels.len());
        for pose in poses {
            if let (Some(given), Some(held)) = (pose.translation, pose.translation.and_then(|_| held.next()))
            {
                found.push(one::<TranslationChannel>(slot, held, vector("a translation", given)?, mode)?);
            }
            if let (Some(given), Some(held)) = (pose.rotation, pose.rotation.and_then(|_| held.next())) {
                found.push(one::<RotationChannel>(slot, held, rotation(given)?, mode)?);
            }
            if let (Some(given), Some(held)) = (pose.scale, pose.scale.and_then(|_| held.next())) {
                found.push(one::<ScaleChannel>(slot, held, vector("a scale", given)?, mode)?);
            }
        }
        Ok(found)
    }
}

fn one<K: ChannelKind>(
    slot: &TakeVersions,
    held: &HeldKey,
    wanted: K::Value,
    mode: PoseMode,
) -> Result<Option<KeyChange>, EditError> {
    let Some(mut key) = slot.key::<K>(held.address.property, held.address.bone, held.key as usize) else {
        return Ok(None);
    };
    key.change = held.before;
    changed::<K>(held.address.bone, &key, |now| match mode {
        PoseMode::Set => wanted,
        PoseMode::Offset => K::offset(now, wanted),
    })
}
