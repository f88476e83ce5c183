//! Iterators over a model that several rules share.

use super::TakeContext;
use super::path::{ModelPath, PathKind};
use crate::data::{Channel, Interpolation, ModelData, Primitive};
use glam::{Quat, Vec3};

/// Iterates over every primitive with its path.
pub(super) fn primitives(
    model: &ModelData,
) -> impl Iterator<Item = (usize, &Primitive, impl Fn() -> ModelPath)> {
    model.meshes.iter().enumerate().flat_map(|(number, mesh)| {
        mesh.primitives.iter().enumerate().map(move |(index, primitive)| {
            let path = move || {
                ModelPath::of(PathKind::Mesh, number, &mesh.name).then(PathKind::Primitive, index, "")
            };
            (number, primitive, path)
        })
    })
}

/// The values of a channel.
#[derive(Clone, Copy)]
pub(super) enum ValueList<'a> {
    Vectors(&'a [Vec3]),
    Rotations(&'a [Quat]),
}

/// A channel with values of any type.
pub(super) struct ChannelView<'a> {
    /// Position of the track in the take.
    pub(super) track: usize,
    pub(super) number: usize,
    pub(super) times: &'a [f32],
    pub(super) values: ValueList<'a>,
    pub(super) interpolation: Interpolation,
}

impl ChannelView<'_> {
    /// Returns the number of values.
    pub(super) fn len(&self) -> usize {
        match self.values {
            ValueList::Vectors(values) => values.len(),
            ValueList::Rotations(values) => values.len(),
        }
    }

    /// Returns whether value `index` is finite.
    pub(super) fn is_finite(&self, index: usize) -> bool {
        match self.values {
            ValueList::Vectors(values) => values.get(index).is_none_or(|value| value.is_finite()),
            ValueList::Rotations(values) => values.get(index).is_none_or(|value| value.is_finite()),
        }
    }

    /// Returns 3 for a cubic spline, 1 otherwise.
    pub(super) fn values_per_key(&self) -> usize {
        if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }

    /// Returns the path of the channel in `of`.
    pub(super) fn path(&self, of: &TakeContext<'_>) -> ModelPath {
        channel_path(of, self.track, self.number)
    }
}

/// Returns the path of channel `number` of the track at position `track`.
pub(super) fn channel_path(of: &TakeContext<'_>, track: usize, number: usize) -> ModelPath {
    let bone = of.take.tracks.get(track).map_or(track, |track| track.bone as usize);
    let name = ["translation", "rotation", "scale"].get(number).copied().unwrap_or("");
    of.bone(bone).then(PathKind::Channel, number, name)
}

/// Iterates over every channel of a take that has keys or values.
pub(super) fn channels<'a>(of: &TakeContext<'a>) -> impl Iterator<Item = ChannelView<'a>> {
    let take = of.take;
    let view = |track, number, times, values, interpolation| ChannelView {
        track,
        number,
        times,
        values,
        interpolation,
    };
    take.tracks.iter().enumerate().flat_map(move |(index, track)| {
        let vectors = |number, channel: &'a Channel<Vec3>| {
            view(index, number, &channel.times, ValueList::Vectors(&channel.values), channel.interpolation)
        };
        let rotation = &track.rotation;
        let rotations = ValueList::Rotations(&rotation.values);
        [
            vectors(0, &track.translation),
            view(index, 1, &rotation.times, rotations, rotation.interpolation),
            vectors(2, &track.scale),
        ]
    })
}

/// Iterates over every key of a channel with its number, time and value; incomplete keys are left out.
pub(super) fn keys<T: Copy>(channel: &Channel<T>) -> impl Iterator<Item = (usize, f32, T)> {
    channel.times.iter().enumerate().filter_map(|(key, &time)| Some((key, time, channel.value(key)?)))
}
