//! The change of one key, and its result.

use super::kind::{ChannelKind, ChannelNumbers};
use dragonfly_anim::data::{Channel, Interpolation};
use serde::{Deserialize, Serialize};

/// The change of one key of one channel. Channels keep only changes that differ from the identity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeyChange {
    /// Change of the value: added, multiplied from the left, or multiplied, as the channel defines.
    pub value: ChannelNumbers,
    /// Added to the in-tangent, per second; only for splines.
    pub arrive: ChannelNumbers,
    /// Added to the out-tangent.
    pub leave: ChannelNumbers,
}

/// In-tangent, value, out-tangent; without a spline the tangents are zero.
pub(crate) type Triple = [ChannelNumbers; 3];

const NONE: ChannelNumbers = [0.0; 4];

impl KeyChange {
    /// Returns a change of the value alone.
    pub(crate) fn of_value(value: ChannelNumbers) -> Self {
        Self { value, arrive: NONE, leave: NONE }
    }

    /// Returns the identity: the change that leaves the original as it is.
    pub(crate) fn identity<K: ChannelKind>() -> Self {
        Self::of_value(K::IDENTITY)
    }

    /// Returns the change; `None` if it is the identity.
    pub(crate) fn some<K: ChannelKind>(self) -> Option<Self> {
        (self != Self::identity::<K>()).then_some(self)
    }

    /// Returns the result of the change for an original key. Unchanged numbers stay exact to the bit.
    pub(crate) fn result<K: ChannelKind>(&self, original: &Triple) -> Triple {
        let moved = self.value != K::IDENTITY;
        let tangent = |original: ChannelNumbers, more: ChannelNumbers| {
            let turned =
                if moved { K::numbers(K::tangent(K::value(original), self.value)) } else { original };
            if more == NONE { turned } else { add(turned, more) }
        };
        let value =
            if moved { K::numbers(K::result(K::value(original[1]), self.value)) } else { original[1] };
        [tangent(original[0], self.arrive), value, tangent(original[2], self.leave)]
    }

    /// Returns the change with which a key gets these tangents; `None` leaves one as it is, to the bit.
    pub(crate) fn given_tangents<K: ChannelKind>(
        self,
        original: &Triple,
        [arrive, leave]: [Option<ChannelNumbers>; 2],
    ) -> Self {
        let now = self.result::<K>(original);
        let plain = Self { arrive: NONE, leave: NONE, ..self }.result::<K>(original);
        let added = |wanted: Option<ChannelNumbers>, side: usize, old: ChannelNumbers| match wanted {
            Some(wanted) if wanted != now[side] => subtract(wanted, plain[side]),
            _ => old,
        };
        Self { arrive: added(arrive, 0, self.arrive), leave: added(leave, 2, self.leave), ..self }
    }

    /// Returns the change from `original` to `result`: `Some(None)` where they are the same, `None` where no change
    /// leads there.
    pub(crate) fn between<K: ChannelKind>(original: &Triple, result: &Triple) -> Option<Option<Self>> {
        let value = if K::value(original[1]) == K::value(result[1]) {
            K::IDENTITY
        } else {
            K::change(K::value(original[1]), K::value(result[1]))?
        };
        let mut change = Self::of_value(value);
        let [arrive, _, leave] = change.result::<K>(original);
        change.arrive = subtract(result[0], arrive);
        change.leave = subtract(result[2], leave);
        Some(change.some::<K>())
    }

    /// Returns the change with tangents scaled by the factors by which time runs faster before and after the key.
    pub(crate) fn with_tangents(self, [before, after]: [f32; 2]) -> Self {
        let scaled = |tangent: ChannelNumbers, factor: f32| tangent.map(|number| number * factor);
        Self { arrive: scaled(self.arrive, before), leave: scaled(self.leave, after), ..self }
    }
}

pub(crate) fn add(a: ChannelNumbers, b: ChannelNumbers) -> ChannelNumbers {
    std::array::from_fn(|at| a[at] + b[at])
}

pub(crate) fn subtract(a: ChannelNumbers, b: ChannelNumbers) -> ChannelNumbers {
    std::array::from_fn(|at| a[at] - b[at])
}

/// Returns key number `key` of a channel, with its tangents.
pub(crate) fn triple<K: ChannelKind>(channel: &Channel<K::Value>, key: usize) -> Triple {
    let at = |index: usize| channel.values.get(index).map_or(NONE, |&value| K::numbers(value));
    match channel.interpolation {
        Interpolation::CubicSpline => [at(key * 3), at(key * 3 + 1), at(key * 3 + 2)],
        _ => [NONE, at(key), NONE],
    }
}

/// Writes a key to a column of values.
pub(crate) fn put<K: ChannelKind>(
    values: &mut [K::Value],
    interpolation: Interpolation,
    key: usize,
    triple: &Triple,
) {
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let from = if per_key == 3 { 0 } else { 1 };
    for (value, numbers) in values.iter_mut().skip(key * per_key).take(per_key).zip(&triple[from..]) {
        *value = K::value(*numbers);
    }
}
