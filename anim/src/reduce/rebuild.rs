//! Building an ordinary take from the remaining keys.

use super::channel_keys::{ChannelKeys, CurveKind};
use crate::data::{Channel, Interpolation, Take};
use crate::sample::Value;
use glam::Quat;

/// Returns `take` with the keys that remain in `columns`; everything else is unchanged.
pub(super) fn rebuild(take: &Take, columns: &[ChannelKeys]) -> Take {
    let mut reduced = take.clone();
    for column in columns {
        let track = &mut reduced.tracks[column.bone as usize];
        match column.property {
            CurveKind::Translation => track.translation = shorter(&track.translation, column),
            CurveKind::Scale => track.scale = shorter(&track.scale, column),
            CurveKind::Rotation => {
                let rotation = shorter(&track.rotation, column);
                track.rotation =
                    if rotation.len() < track.rotation.len() { one_hemisphere(rotation) } else { rotation };
            }
        }
    }
    reduced
}

fn shorter<T: Value>(channel: &Channel<T>, column: &ChannelKeys) -> Channel<T> {
    if column.count == channel.len() {
        return channel.clone();
    }
    let per_key = channel.values_per_key();
    let mut times: Vec<f32> = column.keys().map(|key| channel.times[key]).collect();
    let values: Vec<T> =
        column.keys().flat_map(|key| &channel.values[key * per_key..][..per_key]).copied().collect();
    // A single key applies at all times; it is best put at the start of the channel, unless it marks the end of the
    // take.
    let single = column.keys().next().filter(|_| column.count == 1);
    if single.is_some_and(|key| key + 1 < channel.len()) {
        times[0] = channel.times[0];
    }
    Channel::new(times, values, channel.interpolation)
}

/// Moves neighbors that are interpolated linearly to the same hemisphere; `q` and `-q` are one rotation. Of a spline
/// the tangents determine the direction.
fn one_hemisphere(mut channel: Channel<Quat>) -> Channel<Quat> {
    if channel.interpolation != Interpolation::CubicSpline {
        let mut values = channel.values.to_vec();
        for key in 1..values.len() {
            if values[key - 1].dot(values[key]) < 0.0 {
                values[key] = -values[key];
            }
        }
        channel.values = values.into();
    }
    channel
}
