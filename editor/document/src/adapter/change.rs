//! What was changed of one key, and what comes of it.

use super::kind::{ChannelKind, ChannelNumbers};
use dragonfly_anim::data::{Channel, Interpolation};
use serde::{Deserialize, Serialize};

/// The change of one key of one channel. A channel holds only those that change something.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeyChange {
    /// Added, multiplied from the left, or multiplied: the rule of the channel.
    pub value: ChannelNumbers,
    /// Added to the in-tangent, a second; only splines have any.
    pub arrive: ChannelNumbers,
    /// Added to the out-tangent.
    pub leave: ChannelNumbers,
}

/// In-tangent, value, out-tangent; without a spline only the value counts, and the others are zero.
pub(crate) type Triple = [ChannelNumbers; 3];

const NONE: ChannelNumbers = [0.0; 4];

impl KeyChange {
    /// A change of the value alone.
    pub(crate) fn of_value(value: ChannelNumbers) -> Self {
        Self { value, arrive: NONE, leave: NONE }
    }

    /// Changes nothing.
    pub(crate) fn identity<K: ChannelKind>() -> Self {
        Self::of_value(K::IDENTITY)
    }

    /// Itself where it changes something.
    pub(crate) fn some<K: ChannelKind>(self) -> Option<Self> {
        (self != Self::identity::<K>()).then_some(self)
    }

    /// What an original key becomes; what is not changed stays bit for bit.
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

    /// The change that makes `result` of `original`, `None` inside where they are the same; nothing at all where no
    /// change does.
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

    /// Tangents become steeper by `factor`: time runs faster by it.
    pub(crate) fn with_tangents(self, factor: f32) -> Self {
        let scaled = |tangent: ChannelNumbers| tangent.map(|number| number * factor);
        Self { arrive: scaled(self.arrive), leave: scaled(self.leave), ..self }
    }
}

pub(crate) fn add(a: ChannelNumbers, b: ChannelNumbers) -> ChannelNumbers {
    std::array::from_fn(|at| a[at] + b[at])
}

pub(crate) fn subtract(a: ChannelNumbers, b: ChannelNumbers) -> ChannelNumbers {
    std::array::from_fn(|at| a[at] - b[at])
}

/// Key number `key` of a channel, tangents included.
pub(crate) fn triple<K: ChannelKind>(channel: &Channel<K::Value>, key: usize) -> Triple {
    let at = |index: usize| channel.values.get(index).map_or(NONE, |&value| K::numbers(value));
    match channel.interpolation {
        Interpolation::CubicSpline => [at(key * 3), at(key * 3 + 1), at(key * 3 + 2)],
        _ => [NONE, at(key), NONE],
    }
}

/// Puts a key into a column of values that has room for it.
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
