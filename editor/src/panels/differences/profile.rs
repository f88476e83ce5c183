//! The differences of two takes, computed when one of them changes.

use crate::panels::context::PanelContext;
use dragonfly_anim::compare::{BoneDifference, DifferenceProfile, compare_at, even_times};
use dragonfly_anim::data::Take;
use std::sync::Arc;

/// Largest number of bones times times that are compared in a frame.
const MOST: usize = 200_000;
/// Smallest and largest number of times.
const TIMES: (usize, usize) = (16, 480);
/// Smaller distances (scene units) and angles (radians) count as equal: rounding.
const EQUAL: (f32, f32) = (1e-6, 1e-5);

/// The differences that are shown.
#[derive(Debug, Default)]
pub(super) struct ShownProfile {
    of: Option<(Arc<Take>, Arc<Take>, u32)>,
    profile: DifferenceProfile,
    /// Indices of the pairs of bones that differ, the one with the largest distance first.
    order: Vec<usize>,
}

impl ShownProfile {
    /// Compares `now` with `other` at each frame of the longer one, or at fewer times where there are many frames or bones.
    pub(super) fn update(&mut self, now: &Arc<Take>, other: &Arc<Take>, context: &PanelContext<'_>) {
        let rate = context.frame_rate;
        let is_same = |(a, b, with): &(Arc<Take>, Arc<Take>, u32)| {
            Arc::ptr_eq(a, now) && Arc::ptr_eq(b, other) && *with == rate
        };
        let Some(view) = context.view.filter(|_| !self.of.as_ref().is_some_and(is_same)) else { return };
        let skeleton = &view.loaded.model.animation.skeleton;
        let bones = skeleton.len().max(context.compared_skeleton().map_or(0, |other| other.len())).max(1);
        let most = (MOST / bones).clamp(TIMES.0, TIMES.1);
        let times = even_times(now, other, frames(now, other, rate, most));
        let others = context.compared_skeleton().unwrap_or(skeleton);
        self.profile = compare_at((skeleton, now), (others, other), times);
        let bones = &self.profile.bones;
        let differs = |&at: &usize| bones[at].distance.value > EQUAL.0 || bones[at].angle.value > EQUAL.1;
        self.order = (0..bones.len()).filter(differs).collect();
        self.order.sort_by(|&a, &b| bones[b].distance.value.total_cmp(&bones[a].distance.value));
        self.of = Some((Arc::clone(now), Arc::clone(other), rate));
    }

    /// Returns whether no bone differs.
    pub(super) fn is_equal(&self) -> bool {
        self.order.is_empty()
    }

    /// Returns the number of bones that differ.
    pub(super) fn rows(&self) -> usize {
        self.order.len()
    }

    /// Returns the bone of a row.
    pub(super) fn bone(&self, row: usize) -> Option<&BoneDifference> {
        self.profile.bones.get(*self.order.get(row)?)
    }

    /// Returns the times, seconds, ascending.
    pub(super) fn times(&self) -> &[f32] {
        &self.profile.times
    }

    /// Returns how much the takes differ at each time, 0 to 1.
    pub(super) fn parts(&self) -> impl ExactSizeIterator<Item = f32> + '_ {
        self.profile.parts()
    }

    /// Returns the difference at the time nearest to `time`, as text.
    pub(super) fn text_at(&self, time: f32, context: &PanelContext<'_>) -> Option<String> {
        let near =
            |(_, a): &(usize, &f32), (_, b): &(usize, &f32)| (*a - time).abs().total_cmp(&(*b - time).abs());
        let (at, nearest) = self.profile.times.iter().enumerate().min_by(near)?;
        let frame = (f64::from(*nearest) * f64::from(context.frame_rate)).round();
        let (distance, angle) = (self.profile.distances.get(at)?, self.profile.angles.get(at)?);
        Some(format!(
            "Frame {frame}: {:.2} mm, {:.2}°",
            distance * context.unit.millimeters(),
            angle.to_degrees()
        ))
    }

    /// Returns the largest distance and angle as text.
    pub(super) fn summary(&self, context: &PanelContext<'_>) -> Option<String> {
        let far = self.bone(0)?.distance;
        let angles = self.profile.bones.iter().map(|bone| bone.angle);
        let angle = angles.max_by(|a, b| a.value.total_cmp(&b.value))?;
        let frame = |time: f32| (f64::from(time) * f64::from(context.frame_rate)).round();
        let angle = format!("{:.2}° at frame {}", angle.value.to_degrees(), frame(angle.time));
        // Bones without children turn without moving anything.
        if far.value <= EQUAL.0 {
            return Some(format!("up to {angle}"));
        }
        let millimeters = far.value * context.unit.millimeters();
        Some(format!("up to {millimeters:.2} mm at frame {}, {angle}", frame(far.time)))
    }
}

/// Returns the number of frames from the start of the earlier take to the end of the later one, at most `most`.
fn frames(first: &Take, second: &Take, rate: u32, most: usize) -> usize {
    let seconds = f64::from(first.end().max(second.end())) - f64::from(first.start.min(second.start));
    ((seconds * f64::from(rate.max(1))).round().max(0.0) as usize).saturating_add(1).min(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_frame_is_compared_and_of_a_long_take_some_times_at_even_distances() {
        let take = |start: f32, length: f32| Take { start, length, ..Take::default() };
        let times = |first: &Take, second: &Take, rate: u32, most: usize| {
            even_times(first, second, frames(first, second, rate, most))
        };
        let short = take(0.0, 0.5);
        assert_eq!(times(&short, &take(0.25, 0.0), 8, 100), [0.0, 0.125, 0.25, 0.375, 0.5]);
        assert_eq!(times(&take(1.0, 0.0), &take(1.0, 0.0), 30, 100), [1.0]);
        let long = times(&take(-1.0, 1.0), &take(0.0, 600.0), 30, 480);
        assert_eq!((long.len(), long[0], long[479]), (480, -1.0, 600.0));
        assert_eq!(times(&short, &take(0.0, f32::MAX), 480, 16).len(), 16);
    }
}
