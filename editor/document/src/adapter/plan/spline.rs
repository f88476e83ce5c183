//! Slopes of channels at their keys.

use super::super::change::{subtract, triple};
use super::super::kind::{ChannelKind, ChannelNumbers};
use dragonfly_anim::data::Channel;

/// Returns the value of a key.
pub(crate) fn value<K: ChannelKind>(channel: &Channel<K::Value>, key: usize) -> ChannelNumbers {
    triple::<K>(channel, key)[1]
}

/// Returns the slope at a key in units per second: from the key before to the key after (Catmull and Rom, for uneven times), at either
/// end from or to the only neighbor.
pub(crate) fn slope<K: ChannelKind>(channel: &Channel<K::Value>, key: usize) -> ChannelNumbers {
    let (before, after) = (key.saturating_sub(1), (key + 1).min(channel.len() - 1));
    let seconds = channel.times[after] - channel.times[before];
    let middle = value::<K>(channel, key);
    let near = |key| near::<K>(value::<K>(channel, key), middle);
    let difference = subtract(near(after), near(before));
    if seconds > 0.0 { difference.map(|number| number / seconds) } else { [0.0; 4] }
}

/// Returns `numbers`; of a rotation with the sign that is nearer to `middle`, because q and -q are the same rotation.
pub(crate) fn near<K: ChannelKind>(numbers: ChannelNumbers, middle: ChannelNumbers) -> ChannelNumbers {
    let dot: f32 = numbers.iter().zip(middle).map(|(a, b)| a * b).sum();
    let is_rotation = K::IDENTITY == [0.0, 0.0, 0.0, 1.0];
    if is_rotation && dot < 0.0 { numbers.map(|number| -number) } else { numbers }
}
