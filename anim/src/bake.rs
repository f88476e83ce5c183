//! Baking: a key at every frame, with lines between them, instead of the keys and curves of a take.

use crate::data::{Channel, Interpolation, MorphTrack, Take, Track};
use crate::frames::{FramesError, MOST_POSES, frames_over};
use crate::sample::{Value, sample_channel, sample_morph_weights};
use std::sync::Arc;

/// Returns a take with a key at every frame of `rate` frames per second, from its first key to the first frame at or after its last one.
///
/// A channel with one key, or without any, stays as it is. Between frames the values are on lines; a step takes one frame. Contacts,
/// events and layers stay.
///
/// # Errors
///
/// The rate is not a positive number, or frames × tracks exceed [`MOST_POSES`].
#[doc(alias("resample", "sample"))]
pub fn baked(take: &Take, rate: f32) -> Result<Take, FramesError> {
    if !(rate.is_finite() && rate > 0.0) {
        return Err(FramesError::Rate { rate });
    }
    let (start, end) = take.range_of_keys().unwrap_or_default();
    let (start, rate) = (f64::from(start), f64::from(rate));
    let frames = frames_over(f64::from(end) - start, rate);
    let bones = take.tracks.len().max(1);
    if frames.saturating_mul(bones) > MOST_POSES {
        return Err(FramesError::TooMany { frames, bones });
    }
    let times: Arc<[f32]> = (0..frames).map(|frame| (start + frame as f64 / rate) as f32).collect();
    let tracks = take.tracks.iter().map(|track| Track {
        bone: track.bone,
        translation: baked_channel(&track.translation, &times),
        rotation: baked_channel(&track.rotation, &times),
        scale: baked_channel(&track.scale, &times),
    });
    let mut baked = Take { tracks: tracks.collect(), ..take.clone() };
    baked.morphs = take.morphs.iter().map(|morph| baked_weights(take, morph, &times)).collect();
    let (start, end) = baked.range_of_keys().unwrap_or_default();
    (baked.start, baked.length) = (start, end - start);
    Ok(baked)
}

fn baked_channel<T: Value>(channel: &Channel<T>, times: &Arc<[f32]>) -> Channel<T> {
    if channel.len() < 2 {
        return channel.clone();
    }
    let values: Vec<T> = times.iter().map(|&time| sample_channel(channel, T::ZERO, time)).collect();
    Channel::new(Arc::clone(times), values, Interpolation::Linear)
}

fn baked_weights(take: &Take, morph: &MorphTrack, times: &Arc<[f32]>) -> MorphTrack {
    if morph.times.len() < 2 {
        return morph.clone();
    }
    let targets = morph.targets as usize;
    let mut weights = vec![0.0; targets * times.len()];
    for (row, &time) in weights.chunks_exact_mut(targets.max(1)).zip(times.iter()) {
        sample_morph_weights(Some(take), morph.instance, &[], time, row);
    }
    MorphTrack {
        times: Arc::clone(times),
        weights: weights.into(),
        interpolation: Interpolation::Linear,
        ..morph.clone()
    }
}
