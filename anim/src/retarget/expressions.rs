//! Facial expressions of an animation file as weights of the shape keys that they set in a model (VRM).

use super::sample_times::SampleTimes;
use crate::data::{
    Avatar, Channel, ExpressionBind, Interpolation, MeshInstance, ModelData, MorphTrack, Take,
};
use crate::sample::sample_channel;
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A shape key that an expression of the source sets, and the x values of the channel are the weight of the expression.
type DrivenShape<'a> = (ExpressionBind, &'a Channel<Vec3>);

/// Returns tracks of shape keys of `target` that follow the expressions of a take of `source`, an animation file whose
/// expressions are bones: an expression of the same name sets the same shape keys.
///
/// Weights of expressions are limited to 0..1; those that set one shape key are added. Where all expressions of a mesh have lines or
/// all have steps, the keys are theirs; splines with the same times stay splines; other mixtures become lines between more keys.
/// Expressions that the target lacks are left out. Empty for a source without such expressions.
pub fn retarget_expressions(take: &Take, source: &Avatar, target: &ModelData) -> Vec<MorphTrack> {
    let mut driven: BTreeMap<u32, Vec<DrivenShape<'_>>> = BTreeMap::new();
    for expression in &source.expressions {
        let track = expression.weight_bone.and_then(|bone| take.tracks.get(bone as usize));
        let Some(channel) = track.map(|track| &track.translation).filter(|channel| !channel.is_empty())
        else {
            continue;
        };
        let found = target.avatar.expressions.iter().find(|other| other.name == expression.name);
        for bind in found.map_or(&[][..], |found| &found.binds) {
            driven.entry(bind.instance).or_default().push((*bind, channel));
        }
    }
    let track = |(instance, shapes): (u32, Vec<DrivenShape<'_>>)| {
        morph_track(instance, target.instances.get(instance as usize)?, &shapes)
    };
    driven.into_iter().filter_map(track).collect()
}

fn morph_track(number: u32, instance: &MeshInstance, shapes: &[DrivenShape<'_>]) -> Option<MorphTrack> {
    let targets = instance.morph_weights.len();
    let (_, first) = shapes.first()?;
    if targets == 0 {
        return None;
    }
    let is_all = |kind| shapes.iter().all(|(_, channel)| channel.interpolation == kind);
    let has_same_times = shapes.iter().all(|(_, channel)| channel.times == first.times);
    let is_driven = |target: usize| shapes.iter().any(|(bind, _)| bind.target as usize == target);
    // A shape key that no expression sets keeps its weight, whose slope is 0.
    let row = |at: &dyn Fn(&Channel<Vec3>) -> f32, rest: &dyn Fn(usize) -> f32| -> Vec<f32> {
        let own = |target: usize| shapes.iter().filter(move |(bind, _)| bind.target as usize == target);
        let sum = |target| own(target).map(|(bind, channel)| bind.weight * at(channel)).sum::<f32>();
        (0..targets).map(|target| if is_driven(target) { sum(target) } else { rest(target) }).collect()
    };
    let rest = |target: usize| instance.morph_weights[target];
    let mut weights = Vec::new();
    let (times, interpolation) = if is_all(Interpolation::CubicSpline) && has_same_times {
        for key in 0..first.len() {
            for part in 0..3 {
                let number = |channel: &Channel<Vec3>| channel.values[3 * key + part].x;
                let nothing = |_| 0.0;
                weights.extend(row(&number, if part == 1 { &rest } else { &nothing }));
            }
        }
        (Arc::clone(&first.times), Interpolation::CubicSpline)
    } else {
        let mut times = SampleTimes::default();
        shapes.iter().for_each(|(_, channel)| times.add(channel));
        let (times, interpolation) = times.all(false);
        for &time in &times {
            let number =
                |channel: &Channel<Vec3>| sample_channel(channel, Vec3::ZERO, time).x.clamp(0.0, 1.0);
            weights.extend(row(&number, &rest));
        }
        (times.into(), interpolation)
    };
    Some(MorphTrack {
        instance: number,
        targets: targets as u32,
        times,
        weights: weights.into(),
        interpolation,
    })
}
