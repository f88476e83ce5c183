//! Keys moved to other times.

use super::super::kind::with_kind;
use super::super::op::ChannelAddress;
use super::arrange::{KeyMove, arrange};
use super::morph_keys::move_weights;
use super::{EditError, Transaction, key_time};
use crate::edit::target::{KeySet, TakeRef};

/// Moves keys of bones, and keys of shape keys in stretches of time, to the times that `to` returns.
pub(crate) fn move_keys(
    work: &mut Transaction,
    take: &TakeRef,
    (sets, shapes): (&[KeySet], &[[f32; 2]]),
    how: KeyMove,
    to: impl Fn(f32) -> f32,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    let found = move_weights(work, take, shapes, how, &to)?;
    if sets.is_empty() && !shapes.is_empty() {
        return if found { Ok(()) } else { Err(EditError::Nothing("no key is selected")) };
    }
    for (address, keys) in work.keys(take, sets)? {
        let slot = work.slot(take);
        let times = slot.times(address.bone, address.property);
        let chosen = keys
            .into_iter()
            .map(|key| Ok((key, key_time(to(times[key as usize]), slot)?)))
            .collect::<Result<Vec<_>, EditError>>()?;
        move_positions(work, address, &chosen, how)?;
    }
    Ok(())
}

pub(crate) fn move_positions(
    work: &mut Transaction,
    address: ChannelAddress,
    chosen: &[(u32, f32)],
    how: KeyMove,
) -> Result<(), EditError> {
    with_kind!(address.property, arrange::<K>(work, address, chosen, how))
}
