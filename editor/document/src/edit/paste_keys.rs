//! Pastes copied keys.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::paste_shapes::paste_shapes;
use super::{
    Arbitrary, CopiedChannel, CopiedKey, CopiedShapeKey, CopiedShapes, EditedBones, Example,
    KeyInterpolation, MeshRef, Property, SAME_TIME, ShapeRef, TakeRef,
};
use crate::adapter::EditError;
use crate::adapter::kind::{ChannelKind, ChannelNumbers, ChannelValue, with_kind};
use crate::adapter::op::{ChannelAddress, Op};
use crate::adapter::plan::{
    Transaction,
    arrange::insert_keys_overwriting,
    finite, key_at, key_time, pending,
    pose::{numbers, rotation},
    spline::slope,
};
use crate::adapter::slot::{ChannelContent, KeyContent};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::data::{Channel, Interpolation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Pastes copied keys with exactly their values and tangents. A key that is already at a pasted time is overwritten. Bones and shape
/// keys that the model does not have are left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PasteKeys {
    /// The take.
    pub take: TakeRef,
    /// Seconds: the time from which the times of the copied keys count.
    pub time: f32,
    /// The keys by channel.
    pub channels: Vec<CopiedChannel>,
    /// The keys of shape keys by mesh. Shape keys that the model does not have are left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<CopiedShapes>,
}

map_references!(PasteKeys { take, time }, |edit, map| {
    channels: map.any(&edit.channels, !edit.shapes.is_empty())?,
    shapes: map.any(&edit.shapes, !edit.channels.is_empty())?,
});

impl EditKind for PasteKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"paste_keys","take":"Walk","time":1,"channels":[{"bone":"Head","property":"rotation","interpolation":"linear","keys":[{"after":0,"value":[0,0,0,1]},{"after":0.25,"value":[0,0.2588190,0,0.9659258]}]}]}"#,
        description: "Pastes two keys of the head, at 1 s and at 1.25 s.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Paste keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named(self.channels.iter().map(|channel| &channel.bone), skeleton)
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        key_time(self.time, work.slot(take))?;
        let (mut found, mut pasted) = (false, 0);
        for channel in &self.channels {
            // The keys may come from a model that has other bones.
            if work.bone(&channel.bone).is_err() {
                continue;
            }
            found = true;
            let (bone, property) = (work.track(take, &channel.bone)?, channel.property);
            let address = ChannelAddress { take, bone, property };
            pasted += with_kind!(property, paste::<K>(work, address, self.time, channel))?;
        }
        let (any_shape, keys) = paste_shapes(work, take, self)?;
        (found, pasted) = (found || any_shape, pasted + keys);
        match (found, pasted) {
            _ if self.channels.is_empty() && self.shapes.is_empty() => {
                Err(EditError::Nothing("no key is given"))
            }
            (true, 0) => Err(EditError::Nothing("no key is given")),
            (true, _) => Ok(()),
            (false, _) => Err(EditError::Nothing("none of the bones and shape keys is in this model")),
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let property = from.property();
        let count = if property == Property::Rotation { 4 } else { 3 };
        // The numbers are positive, because a rotation must not have length zero.
        let value =
            |from: &mut Arbitrary<'_>| (0..count).map(|_| from.between(0.1, 1.0)).collect::<Vec<f32>>();
        let key = |from: &mut Arbitrary<'_>| CopiedKey {
            after: from.choice([0.0, 0.125, 0.3, 0.77]),
            value: value(from),
            arrive: from.optional(value),
            leave: from.optional(value),
        };
        let keys = (0..from.below(4)).map(|_| key(from)).collect();
        let interpolation =
            from.choice([KeyInterpolation::Step, KeyInterpolation::Linear, KeyInterpolation::CubicSpline]);
        let channels = vec![CopiedChannel { bone: from.bone(), property, interpolation, keys }];
        let key = |from: &mut Arbitrary<'_>| CopiedShapeKey {
            after: from.choice([0.0, 0.125, 0.3, 0.77]),
            weights: from.numbers(2),
            arrive: from.optional(|from| from.numbers(2)),
            leave: from.optional(|from| from.numbers(2)),
        };
        let shapes = CopiedShapes {
            mesh: MeshRef::Index(from.choice([0, 2])),
            shapes: vec![ShapeRef::Name("smile".to_owned()), ShapeRef::Index(from.choice([0, 1, 3]))],
            interpolation,
            keys: (0..from.below(3)).map(|_| key(from)).collect(),
        };
        let shapes = if from.flag() { Vec::new() } else { vec![shapes] };
        Self { take: from.take(), time: from.time(), channels, shapes }
    }
}

/// A key to paste, and which of its tangents were given.
struct PastedKey {
    key: KeyContent,
    tangents: [bool; 2],
}

/// Pastes keys into a channel. Returns their number.
fn paste<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    time: f32,
    channel: &CopiedChannel,
) -> Result<usize, EditError> {
    let mut given = channel
        .keys
        .iter()
        .map(|key| read(work, address, time, key))
        .collect::<Result<Vec<_>, EditError>>()?;
    given.sort_by(|a, b| a.key.time.total_cmp(&b.key.time));
    // Of several keys at the same time, the last one wins.
    given.reverse();
    given.dedup_by(|next, kept| (kept.key.time - next.key.time).abs() <= SAME_TIME);
    given.reverse();
    if given.is_empty() {
        return Ok(0);
    }
    if work.slot(address.take).times(address.bone, address.property).is_empty() {
        set_interpolation::<K>(work, address, channel.interpolation);
    }
    let spline = is_spline::<K>(work, address);
    if spline {
        on_one_side::<K>(work, address, &mut given);
    }
    work.room_for(address, given.len())?;
    insert_keys_overwriting(work, address, given.iter().map(|given| given.key).collect(), Vec::new())?;
    if spline {
        smooth::<K>(work, address, &given);
    }
    forget_pending(work, address, &given);
    Ok(given.len())
}

fn read(
    work: &Transaction,
    address: ChannelAddress,
    time: f32,
    key: &CopiedKey,
) -> Result<PastedKey, EditError> {
    let after = finite("a time", key.after as f32).and(Ok(key.after))?;
    let time = key_time((f64::from(time) + after) as f32, work.slot(address.take))?;
    let mut value = numbers("a value", &key.value, address.property)?;
    if address.property == Property::Rotation {
        value = rotation(value)?.to_array();
    }
    let tangent = |given: &Option<Vec<f32>>| {
        given.as_ref().map(|given| numbers("a tangent", given, address.property)).transpose()
    };
    let (arrive, leave) = (tangent(&key.arrive)?, tangent(&key.leave)?);
    let original = [arrive.unwrap_or_default(), value, leave.unwrap_or_default()];
    Ok(PastedKey {
        key: KeyContent { time, original, change: None },
        tangents: [arrive.is_some(), leave.is_some()],
    })
}

/// Gives a channel without keys the interpolation of the pasted keys.
fn set_interpolation<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    between: KeyInterpolation,
) {
    let interpolation = Interpolation::from(between);
    let Some(old) = work.slot(address.take).original_of::<K>(address.bone).cloned() else { return };
    if old.interpolation != interpolation {
        let times = Arc::clone(&old.times);
        let original = K::Value::wrap(Channel { interpolation, ..old });
        work.replace::<K>(address, ChannelContent { original, changes: Vec::new() }, &times);
    }
}

fn is_spline<K: ChannelKind>(work: &Transaction, address: ChannelAddress) -> bool {
    let channel = work.slot(address.take).original_of::<K>(address.bone);
    channel.is_some_and(|channel| channel.interpolation == Interpolation::CubicSpline)
}

/// Gives all rotations the sign of the key before them, or after them where there is none. q and -q are the same
/// rotation, but a spline from one to the other takes the long way.
fn on_one_side<K: ChannelKind>(work: &Transaction, address: ChannelAddress, given: &mut [PastedKey]) {
    let slot = work.slot(address.take);
    let (Some(first), Some(last)) = (given.first(), given.last()) else { return };
    if address.property != Property::Rotation {
        return;
    }
    let times = slot.times(address.bone, address.property);
    let before = times.partition_point(|&time| time < first.key.time - SAME_TIME).checked_sub(1);
    let after = times.partition_point(|&time| time <= last.key.time + SAME_TIME);
    let (beside, own) = match before {
        Some(before) => (before, first.key.original[1]),
        None => (after, last.key.original[1]),
    };
    let Some(beside) = slot.key::<K>(address.property, address.bone, beside) else { return };
    let beside = beside.change.map_or(beside.original, |change| change.result::<K>(&beside.original))[1];
    if beside.iter().zip(own).map(|(a, b)| a * b).sum::<f32>() < 0.0 {
        for number in given.iter_mut().flat_map(|given| given.key.original.iter_mut().flatten()) {
            *number = -*number;
        }
    }
}

/// Gives keys of a spline that have no tangents smooth ones.
fn smooth<K: ChannelKind>(work: &mut Transaction, address: ChannelAddress, given: &[PastedKey]) {
    let slot = work.slot(address.take);
    let Some(channel) = slot.result.tracks.get(address.bone as usize).map(K::channel) else { return };
    let wanting = given.iter().filter(|given| given.tangents != [true; 2]);
    let keys: Vec<(u32, KeyContent)> = wanting
        .filter_map(|given| {
            let at = key_at(&channel.times, given.key.time).ok()?;
            let slope = slope::<K>(channel, at);
            let [arrive, value, leave] = given.key.original;
            let side = |was: ChannelNumbers, given: bool| if given { was } else { slope };
            let original = [side(arrive, given.tangents[0]), value, side(leave, given.tangents[1])];
            Some((at as u32, KeyContent { original, ..given.key }))
        })
        .collect();
    if !keys.is_empty() {
        let remove = keys.iter().map(|(at, _)| *at).collect();
        work.perform(Op::Splice(address, remove, keys));
    }
}

/// Removes pending values of the channel at the times of pasted keys.
fn forget_pending(work: &mut Transaction, address: ChannelAddress, given: &[PastedKey]) {
    let waiting: Vec<f32> = work.slot(address.take).pending().iter().map(|at| at.time).collect();
    let times: Vec<f32> = given.iter().map(|given| given.key.time).collect();
    for time in waiting.into_iter().filter(|&time| key_at(&times, time).is_ok()) {
        pending::overwritten(work, address.take, time, &[(address.bone, address.property)]);
    }
}
