//! From what is left to an ordinary take.

use super::column::{Column, Property};
use crate::data::{Channel, Interpolation, Take};
use crate::sample::Value;
use glam::Quat;

/// `take` with the keys that `columns` have left; all else as it was.
pub(super) fn rebuild(take: &Take, columns: &[Column]) -> Take {
    let mut reduced = take.clone();
    for column in columns {
        let track = &mut reduced.tracks[column.bone as usize];
        match column.property {
            Property::Translation => track.translation = shorter(&track.translation, column),
            Property::Scale => track.scale = shorter(&track.scale, column),
            Property::Rotation => {
                let rotation = shorter(&track.rotation, column);
                track.rotation =
                    if rotation.len() < track.rotation.len() { one_hemisphere(rotation) } else { rotation };
            }
        }
    }
    reduced
}

fn shorter<T: Value>(channel: &Channel<T>, column: &Column) -> Channel<T> {
    if column.count == channel.len() {
        return channel.clone();
    }
    let per_key = channel.values_per_key();
    let mut times: Vec<f32> = column.keys().map(|key| channel.times[key]).collect();
    let values: Vec<T> =
        column.keys().flat_map(|key| &channel.values[key * per_key..][..per_key]).copied().collect();
    // A single key holds at all times; it stands best where the channel began, unless it marks the end of the take.
    let single = column.keys().next().filter(|_| column.count == 1);
    if single.is_some_and(|key| key + 1 < channel.len()) {
        times[0] = channel.times[0];
    }
    Channel::new(times, values, channel.interpolation)
}

/// Neighbours that are mixed by distance are brought to the same side; `q` and `-q` are one rotation. A spline says
/// itself which way it goes.
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
