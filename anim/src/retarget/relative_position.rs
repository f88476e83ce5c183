//! The position of a bone relative to its nearest bound ancestor, when unbound bones between them move.
//!
//! With `B(t)` the product of `to_parent` of the bones between, top first, and `x(t)` the bone's own translation:
//!
//! ```text
//! p(t) = B(t) x(t)
//! ```

use super::rotation::path;
use super::sample_times::SampleTimes;
use crate::animation::to_parent;
use crate::data::{Channel, Interpolation, Skeleton, Take, Track};
use crate::sample::{Value, rest_pose, sample_track};
use glam::{DMat3, DMat4, DVec3, Vec3};

/// A bone of the source and its ancestors, up to the nearest that is bound.
pub(super) struct RelativePosition<'a> {
    take: &'a Take,
    source: &'a Skeleton,
    /// Top first; the bone itself is the last.
    path: Vec<usize>,
}

impl<'a> RelativePosition<'a> {
    /// Returns `None` where no bone between moves, so that the bone's own translation suffices. Also where `above` is
    /// not an ancestor of `bone`.
    pub(super) fn of(
        take: &'a Take,
        source: &'a Skeleton,
        bone: usize,
        above: Option<usize>,
    ) -> Option<Self> {
        let path = path(source, bone, above)?;
        let position = Self { take, source, path };
        let moves = position.between().any(|track| !track.is_empty());
        moves.then_some(position)
    }

    /// Returns `p(t) - p(0)` transformed by `map`, added to `rest`, key by key.
    pub(super) fn carried(&self, rest: Vec3, map: DMat3) -> Channel<Vec3> {
        if !map.is_finite() {
            return Channel::default();
        }
        let at_rest = self.at(None);
        let value = |time: f32| {
            let value = (rest.as_dvec3() + map * (self.at(Some(time)) - at_rest)).as_vec3();
            value.healed(rest)
        };
        let (times, interpolation) = self.times();
        let values: Vec<Vec3> = times.iter().map(|&time| value(time)).collect();
        Channel::new(times, values, interpolation)
    }

    /// Iterates over the tracks of the bones between.
    fn between(&self) -> impl Iterator<Item = &'a Track> + '_ {
        let between = &self.path[..self.path.len().saturating_sub(1)];
        between.iter().filter_map(|&bone| self.take.tracks.get(bone))
    }

    /// Returns `p` at a time; `None`: at rest.
    fn at(&self, time: Option<f32>) -> DVec3 {
        let none = Track::default();
        let pose = |bone: usize| match time {
            Some(time) => {
                let track = self.take.tracks.get(bone).unwrap_or(&none);
                sample_track(track, &self.source.bones[bone], time)
            }
            None => rest_pose(&self.source.bones[bone]),
        };
        let Some((&last, between)) = self.path.split_last() else { return DVec3::ZERO };
        let above = between.iter().fold(DMat4::IDENTITY, |above, &bone| {
            above * to_parent(&self.source.bones[bone], pose(bone)).as_dmat4()
        });
        above.transform_point3(pose(last).translation.as_dvec3())
    }

    /// Returns the sample times, and the interpolation of the samples.
    fn times(&self) -> (Vec<f32>, Interpolation) {
        let mut sample_times = SampleTimes::default();
        if let Some(own) = self.path.last().and_then(|&bone| self.take.tracks.get(bone)) {
            sample_times.add(&own.translation);
        }
        let mut turns = false;
        for track in self.between() {
            sample_times.add(&track.translation);
            sample_times.add(&track.rotation);
            sample_times.add(&track.scale);
            turns |= track.rotation.len() > 1 || track.scale.len() > 1;
        }
        sample_times.all(turns)
    }
}
