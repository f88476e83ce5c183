//! Takes made, deleted, renamed, put in order (thesis §2.2.2.4).

use super::super::op::Op;
use super::super::slot::{Slot, extent};
use super::{EditError, Work};
use crate::edit::TakeRef;
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::sample::rest_pose;
use std::sync::Arc;

pub(super) fn create(
    work: &mut Work,
    name: &str,
    copy: Option<&TakeRef>,
    at: Option<usize>,
) -> Result<(), EditError> {
    let source = copy.map(|take| work.take(take)).transpose()?;
    let id = work.adapter.new_id();
    let (slot, behind) = match source {
        Some(source) => {
            let mut slot = work.slot(source).copied(id);
            // What is pending is so in one take only.
            slot.forget_pending();
            (slot, work.index(source) + 1)
        }
        None => {
            let take = Arc::new(rest(&work.adapter.skeleton));
            if take.keys() == 0 {
                return Err(EditError::Nothing("a model without bones has no pose to begin with"));
            }
            (Slot::unchanged(id, None, take), work.adapter.slots.len())
        }
    };
    work.perform(Op::Insert(at.unwrap_or(behind), Arc::new(slot)));
    work.perform(Op::Name(id, name.to_owned()));
    Ok(())
}

/// One key a bone, at 0 s.
fn rest(skeleton: &Skeleton) -> Take {
    let zero: Arc<[f32]> = Arc::new([0.0]);
    let track = |(bone, rules): (usize, &dragonfly_anim::data::Bone)| {
        let pose = rest_pose(rules);
        let linear = Interpolation::Linear;
        Track {
            bone: bone as u32,
            translation: Channel::new(Arc::clone(&zero), [pose.translation], linear),
            rotation: Channel::new(Arc::clone(&zero), [pose.rotation], linear),
            scale: Channel::new(Arc::clone(&zero), [pose.scale], linear),
        }
    };
    let mut take = Take { tracks: skeleton.bones.iter().enumerate().map(track).collect(), ..Take::default() };
    (take.start, take.length) = extent(&take);
    take
}

pub(super) fn delete(work: &mut Work, take: &TakeRef) -> Result<(), EditError> {
    let take = work.take(take)?;
    if work.adapter.slots.len() == 1 {
        return Err(EditError::LastTake);
    }
    work.perform(Op::Remove(take));
    Ok(())
}

pub(super) fn rename(work: &mut Work, take: &TakeRef, name: &str) -> Result<(), EditError> {
    let take = work.take(take)?;
    if work.slot(take).original.name == name {
        return Err(EditError::Nothing("the take is called that already"));
    }
    work.perform(Op::Name(take, name.to_owned()));
    Ok(())
}

pub(super) fn reorder(work: &mut Work, take: &TakeRef, to: usize) -> Result<(), EditError> {
    let take = work.take(take)?;
    let to = to.min(work.adapter.slots.len() - 1);
    if work.index(take) == to {
        return Err(EditError::Nothing("the take is there already"));
    }
    work.perform(Op::Move(take, to));
    Ok(())
}
