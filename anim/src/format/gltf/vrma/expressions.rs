//! Tracks of facial expressions: the weight of an expression is the x translation of its node.

use super::NOT_IN_VRMA;
use crate::data::{Channel, ExpressionBind, FaceExpression, Interpolation, ModelData, MorphTrack, Take};
use crate::format::{Place, Warning};
use glam::Vec3;
use std::sync::Arc;

/// Expressions whose meaning VRM defines. Those of the gaze have no tracks.
pub(super) const PRESETS: [&str; 18] = [
    "happy",
    "angry",
    "sad",
    "relaxed",
    "surprised",
    "aa",
    "ih",
    "ou",
    "ee",
    "oh",
    "blink",
    "blinkLeft",
    "blinkRight",
    "neutral",
    "lookUp",
    "lookDown",
    "lookLeft",
    "lookRight",
];

/// The expressions of a model that can have tracks.
pub(super) struct ExpressionTracks<'a> {
    found: Vec<(&'a str, WeightSource)>,
}

/// Source of the weight of an expression.
enum WeightSource {
    /// The x translation of a bone.
    Bone(u32),
    /// A morph target that no other expression sets.
    Morph(ExpressionBind),
}

impl<'a> ExpressionTracks<'a> {
    /// Finds the expressions of a model whose weights are known from its takes.
    pub(super) fn of(model: &'a ModelData) -> Self {
        let all = &model.avatar.expressions;
        let is_own = |own: &FaceExpression, bind: &ExpressionBind| {
            let same =
                |other: &ExpressionBind| (other.instance, other.target) == (bind.instance, bind.target);
            all.iter().all(|other| std::ptr::eq(other, own) || !other.binds.iter().any(same))
        };
        let source = |expression: &'a FaceExpression| {
            let bind = || expression.binds.iter().find(|bind| bind.weight > 0.0 && is_own(expression, bind));
            let source = match expression.weight_bone {
                Some(bone) => Some(WeightSource::Bone(bone)),
                None => bind().copied().map(WeightSource::Morph),
            };
            let is_gaze = PRESETS.contains(&&*expression.name) && expression.name.starts_with("look");
            source
                .filter(|_| !is_gaze && !expression.name.is_empty())
                .map(|source| (&*expression.name, source))
        };
        let found = all.iter().filter_map(source);
        let moves = |(_, source): &(&str, WeightSource)| {
            model.animation.takes.iter().any(|take| !weights(source, take).is_empty())
        };
        Self { found: found.filter(moves).collect() }
    }

    /// Returns the names of the expressions that have tracks in any take.
    pub(super) fn names(&self) -> impl Iterator<Item = &'a str> + '_ {
        self.found.iter().map(|(name, _)| *name)
    }

    /// Returns the track of each expression in a take; empty where it does not move.
    pub(super) fn tracks(&self, take: &Take) -> Vec<Channel<Vec3>> {
        self.found.iter().map(|(_, source)| weights(source, take)).collect()
    }

    /// Returns the loss of morph weights in the take `index` that belong to no written expression.
    pub(super) fn lost(&self, take: &Take, index: usize) -> Option<Warning> {
        let is_written = |track: &MorphTrack, target: u32| {
            self.found.iter().any(|(_, source)| match source {
                WeightSource::Bone(_) => false,
                WeightSource::Morph(bind) => (bind.instance, bind.target) == (track.instance, target),
            })
        };
        let count = |track: &MorphTrack| {
            (0..track.targets).filter(|&target| !is_written(track, target) && is_used(track, target)).count()
        };
        let count: usize = take.morphs.iter().map(count).sum();
        (count > 0).then(|| Warning {
            place: Place::Pointer(format!("/animation/takes/{index}/morphs")),
            code: NOT_IN_VRMA,
            text: format!("{count} morph targets that no expression sets alone are not animated"),
        })
    }
}

/// Returns whether any key of a morph target is not zero.
fn is_used(track: &MorphTrack, target: u32) -> bool {
    track
        .weights
        .chunks(track.targets.max(1) as usize)
        .any(|key| key.get(target as usize).is_some_and(|it| *it != 0.0))
}

/// Returns the weight of an expression over time as a translation, 0..1.
fn weights(source: &WeightSource, take: &Take) -> Channel<Vec3> {
    let (times, numbers, interpolation) = match source {
        WeightSource::Bone(bone) => {
            let Some(track) = take.tracks.get(*bone as usize) else { return Channel::default() };
            let channel = &track.translation;
            (&channel.times, channel.values.iter().map(|value| value.x).collect(), channel.interpolation)
        }
        WeightSource::Morph(bind) => {
            let track = take.morphs.iter().find(|track| track.instance == bind.instance);
            let Some(track) = track.filter(|track| bind.target < track.targets) else {
                return Channel::default();
            };
            let keys = track.weights.chunks_exact(track.targets as usize);
            let numbers: Vec<f32> =
                keys.filter_map(|key| key.get(bind.target as usize)).map(|it| it / bind.weight).collect();
            (&track.times, numbers, track.interpolation)
        }
    };
    if numbers.iter().all(|number| *number == 0.0) && matches!(source, WeightSource::Morph(_)) {
        return Channel::default();
    }
    let is_tangent = |index: usize| interpolation == Interpolation::CubicSpline && index % 3 != 1;
    let value = |(index, number): (usize, f32)| {
        Vec3::new(if is_tangent(index) { number } else { number.clamp(0.0, 1.0) }, 0.0, 0.0)
    };
    let values = numbers.into_iter().enumerate().map(value).collect();
    Channel { times: Arc::clone(times), values, interpolation }
}
