//! The curves of shape keys: which are shown, and their weights as a column of their own.

use super::id::CurveId;
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Take};
use glam::Vec3;
use std::sync::Arc;

/// The shape keys whose curves are shown, found again only when weights changed.
#[derive(Debug, Default)]
pub(super) struct ShapeCurveList {
    of: Vec<Arc<[f32]>>,
    ids: Vec<CurveId>,
}

impl ShapeCurveList {
    /// Returns the shape keys that move in a take, at most `most`; all of them if none does. While keys are dragged they stay the same,
    /// so that no curve disappears under the pointer.
    pub(super) fn update(&mut self, take: &Take, most: usize, dragged: bool) -> &[CurveId] {
        let same_number = self.of.len() == take.morphs.len();
        let same = same_number
            && self.of.iter().zip(&take.morphs).all(|(of, track)| Arc::ptr_eq(of, &track.weights));
        let stays = same || (dragged && same_number);
        if !stays {
            self.of = take.morphs.iter().map(|track| Arc::clone(&track.weights)).collect();
            let list = |only_moving: bool| -> Vec<CurveId> {
                let shapes = take.morphs.iter().flat_map(|track| {
                    let shapes =
                        (0..track.targets as usize).filter(move |&shape| !only_moving || moves(track, shape));
                    shapes.map(|shape| CurveId::Shape { instance: track.instance, shape: shape as u32 })
                });
                shapes.take(most).collect()
            };
            self.ids = list(true);
            if self.ids.is_empty() {
                self.ids = list(false);
            }
        }
        &self.ids
    }
}

/// Returns the number of values of a target per key, and the number of values per key.
fn layout(track: &MorphTrack) -> (usize, usize) {
    let rows = if track.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    (rows, rows * track.targets as usize)
}

/// Returns whether a target has different weights at its keys.
fn moves(track: &MorphTrack, shape: usize) -> bool {
    let (rows, width) = layout(track);
    let row = if rows == 3 { track.targets as usize } else { 0 };
    let mut weights = track.weights.chunks(width.max(1)).filter_map(|key| key.get(row + shape));
    weights.next().is_some_and(|first| weights.any(|weight| weight != first))
}

/// Returns the track of a mesh.
pub(super) fn track(take: &Take, instance: u32) -> Option<&MorphTrack> {
    take.morphs.iter().find(|track| track.instance == instance)
}

/// Returns the weights of a target as a column: as the first number of vectors, so that they are sampled and drawn as those of bones.
pub(super) fn column(track: &MorphTrack, shape: usize) -> Channel<Vec3> {
    let (rows, width) = layout(track);
    let targets = track.targets as usize;
    let number = |key: usize, row: usize| {
        let number = track.weights.get(key * width + row * targets + shape).copied().unwrap_or(0.0);
        Vec3::new(if number.is_finite() { number } else { 0.0 }, 0.0, 0.0)
    };
    let keys = 0..track.times.len();
    let values: Vec<Vec3> = keys
        .flat_map(|key| (0..rows).map(move |row| (key, row)))
        .map(|(key, row)| number(key, row))
        .collect();
    Channel { times: Arc::clone(&track.times), values: values.into(), interpolation: track.interpolation }
}
