//! Travel that was removed from a take, kept in its extras as JSON, so that it can be put back also after the file was saved and
//! opened again.

use super::KeyInterpolation;
use dragonfly_anim::data::{BoneIndex, Channel, Interpolation, TakeExtras};
use dragonfly_anim::motion::{Axis, RootMotion};
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Name of the removed travel in the extras of a take.
pub const TRAVEL: &str = "travel";

/// One removed motion.
#[derive(Serialize, Deserialize)]
struct KeptMotion {
    bone: BoneIndex,
    /// Point of the axis of rotation, which is vertical.
    pivot: [f32; 3],
    start: f32,
    length: f32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    translation: Option<KeptChannel>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rotation: Option<KeptChannel>,
}

#[derive(Serialize, Deserialize)]
struct KeptChannel {
    interpolation: KeyInterpolation,
    times: Vec<f32>,
    values: Vec<f32>,
}

impl KeptChannel {
    fn of(times: &[f32], interpolation: Interpolation, values: Vec<f32>) -> Option<Self> {
        let interpolation = KeyInterpolation::of(interpolation);
        (!times.is_empty()).then(|| Self { interpolation, times: times.to_vec(), values })
    }

    /// Returns the channel; `None` where it is not one: another program may have written it.
    fn channel<T: Copy>(&self, numbers: usize, value: impl Fn(&[f32]) -> T) -> Option<Channel<T>> {
        let interpolation = Interpolation::from(self.interpolation);
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let complete = self.values.len() == self.times.len() * numbers * per_key;
        let ascending = self.times.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = self.times.iter().chain(&self.values).all(|number| number.is_finite());
        let values: Vec<T> = self.values.chunks_exact(numbers).map(value).collect();
        (complete && ascending && finite).then(|| Channel::new(self.times.clone(), values, interpolation))
    }
}

impl KeptMotion {
    fn of(motion: &RootMotion) -> Self {
        let (moved, turned) = (&motion.translation, &motion.rotation);
        let vectors = moved.values.iter().flat_map(|value| value.to_array()).collect();
        let rotations = turned.values.iter().flat_map(|value| value.to_array()).collect();
        Self {
            bone: motion.bone,
            pivot: motion.pivot.to_array(),
            start: motion.start,
            length: motion.length,
            translation: KeptChannel::of(&moved.times, moved.interpolation, vectors),
            rotation: KeptChannel::of(&turned.times, turned.interpolation, rotations),
        }
    }

    fn motion(&self) -> Option<RootMotion> {
        let (moved, turned) = (self.translation.as_ref(), self.rotation.as_ref());
        Some(RootMotion {
            bone: self.bone,
            up: Axis::Y,
            pivot: Vec3::from_array(self.pivot),
            translation: moved
                .map_or(Some(Channel::default()), |channel| channel.channel(3, Vec3::from_slice))?,
            rotation: turned
                .map_or(Some(Channel::default()), |channel| channel.channel(4, Quat::from_slice))?,
            start: self.start,
            length: self.length,
        })
    }
}

/// Returns the travel that was removed, the last removed last; none where the extras have none, or something else of that name.
pub(super) fn kept_travel(extras: &TakeExtras) -> Vec<RootMotion> {
    let kept = extras.get(TRAVEL).and_then(|text| serde_json::from_str::<Vec<KeptMotion>>(text).ok());
    kept.unwrap_or_default().iter().map(KeptMotion::motion).collect::<Option<_>>().unwrap_or_default()
}

/// Returns the text for the extras; `None` where nothing is kept.
pub(super) fn travel_text(motions: &[RootMotion]) -> Option<Arc<str>> {
    let kept: Vec<KeptMotion> = motions.iter().map(KeptMotion::of).collect();
    let text = serde_json::to_string(&kept).ok().filter(|_| !kept.is_empty());
    text.map(Arc::from)
}
