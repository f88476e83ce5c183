//! Iterators over a model that several rules share.

use super::TakeOf;
use super::place::{Kind, Place};
use crate::data::{Channel, Interpolation, ModelData, Primitive};
use glam::{Quat, Vec3};

/// Iterates over every primitive with its path.
pub(super) fn primitives(model: &ModelData) -> impl Iterator<Item = (usize, &Primitive, impl Fn() -> Place)> {
    model.meshes.iter().enumerate().flat_map(|(number, mesh)| {
        mesh.primitives.iter().enumerate().map(move |(index, primitive)| {
            let place = move || Place::of(Kind::Mesh, number, &mesh.name).then(Kind::Primitive, index, "");
            (number, primitive, place)
        })
    })
}

/// The values of a channel.
#[derive(Clone, Copy)]
pub(super) enum Values<'a> {
    Vectors(&'a [Vec3]),
    Rotations(&'a [Quat]),
}

/// A channel with values of any type.
pub(super) struct Column<'a> {
    /// Position of the track in the take.
    pub(super) track: usize,
    pub(super) number: usize,
    pub(super) times: &'a [f32],
    pub(super) values: Values<'a>,
    pub(super) interpolation: Interpolation,
}

impl Column<'_> {
    /// Returns the number of values.
    pub(super) fn len(&self) -> usize {
        match self.values {
            Values::Vectors(values) => values.len(),
            Values::Rotations(values) => values.len(),
        }
    }

    /// Returns whether value `index` is finite.
    pub(super) fn is_finite(&self, index: usize) -> bool {
        match self.values {
            Values::Vectors(values) => values.get(index).is_none_or(|value| value.is_finite()),
            Values::Rotations(values) => values.get(index).is_none_or(|value| value.is_finite()),
        }
    }

    /// Returns 3 for a cubic spline, 1 otherwise.
    pub(super) fn values_per_key(&self) -> usize {
        if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }

    /// Returns the path of the channel in `of`.
    pub(super) fn place(&self, of: &TakeOf<'_>) -> Place {
        channel_place(of, self.track, self.number)
    }
}

/// Returns the path of channel `number` of the track at position `track`.
pub(super) fn channel_place(of: &TakeOf<'_>, track: usize, number: usize) -> Place {
    let bone = of.take.tracks.get(track).map_or(track, |track| track.bone as usize);
    let name = ["translation", "rotation", "scale"].get(number).copied().unwrap_or("");
    of.bone(bone).then(Kind::Channel, number, name)
}

/// Iterates over every channel of a take that has keys or values.
pub(super) fn columns<'a>(of: &TakeOf<'a>) -> impl Iterator<Item = Column<'a>> {
    let take = of.take;
    let column =
        |track, number, times, values, interpolation| Column { track, number, times, values, interpolation };
    take.tracks.iter().enumerate().flat_map(move |(index, track)| {
        let vectors = |number, channel: &'a Channel<Vec3>| {
            column(index, number, &channel.times, Values::Vectors(&channel.values), channel.interpolation)
        };
        let rotation = &track.rotation;
        let rotations = Values::Rotations(&rotation.values);
        [
            vectors(0, &track.translation),
            column(index, 1, &rotation.times, rotations, rotation.interpolation),
            vectors(2, &track.scale),
        ]
    })
}

/// Iterates over every key of a channel with its number, time and value; incomplete keys are left out.
pub(super) fn keys<T: Copy>(channel: &Channel<T>) -> impl Iterator<Item = (usize, f32, T)> {
    channel.times.iter().enumerate().filter_map(|(key, &time)| Some((key, time, channel.value(key)?)))
}
