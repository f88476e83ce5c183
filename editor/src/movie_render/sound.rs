//! The sounds of a scene, mixed for its movie.

use super::error::MovieRenderError;
use super::frames::MovieFrames;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::time::StageRate;
use dragonfly_document::{Cancel, SoundSource};
use dragonfly_movie::{MovieSound, ReadSamples};
use dragonfly_sound::{MOST_SOUND_BYTES, MixedSounds, SoundMix, SoundSamples};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Samples per second of the mix, in each channel.
pub const SOUND_RATE: u32 = 48_000;
/// Number of channels of the mix.
pub const SOUND_CHANNELS: u8 = 2;
/// Samples that are mixed at once: whole blocks of the mix, so that its result is the same in every movie.
const BLOCK: usize = 4096;

/// Mixes the sounds that a scene plays during `frames` as the sound of a movie, otherwise as [`scene_samples`].
///
/// # Errors
///
/// It was cancelled.
pub fn scene_sound(
    plan: &Arc<StagePlan>,
    folder: &Path,
    frames: (&MovieFrames, StageRate),
    cancel: &Cancel,
    warn: &mut dyn FnMut(&str),
) -> Result<Option<MovieSound>, MovieRenderError> {
    let read = scene_samples(plan, folder, frames, cancel, warn)?;
    Ok(read.map(|read| MovieSound::samples(SOUND_RATE, SOUND_CHANNELS.into(), read)).transpose()?)
}

/// Mixes the sounds that a scene plays during `frames`, from files in `folder` or below it: [`SOUND_CHANNELS`] channels of [`SOUND_RATE`] samples per
/// second. `None` where it plays none. A sound that cannot be read is left out, and `warn` receives a sentence about it.
///
/// # Errors
///
/// It was cancelled.
pub fn scene_samples(
    plan: &Arc<StagePlan>,
    folder: &Path,
    (frames, rate): (&MovieFrames, StageRate),
    cancel: &Cancel,
    warn: &mut dyn FnMut(&str),
) -> Result<Option<ReadSamples>, MovieRenderError> {
    let samples = read_sounds(plan, folder, cancel, warn)?;
    if samples.iter().all(Option::is_none) {
        return Ok(None);
    }
    let start = rate.frame(i64::try_from(frames.first()).unwrap_or(i64::MAX)).seconds();
    let (per, seconds) = rate.fraction();
    let whole = u128::from(frames.count()) * u128::from(seconds) * u128::from(SOUND_RATE);
    let count = u64::try_from(whole.div_ceil(u128::from(per))).unwrap_or(u64::MAX);
    let mut mix = SoundMix::new(MixedSounds::Scene { plan: Arc::clone(plan), samples });
    let (mut mixed, mut block) = (0_u64, vec![[0.0; 2]; BLOCK]);
    Ok(Some(Box::new(move |out| {
        let length = (count - mixed).min(BLOCK as u64);
        let block = &mut block[..length as usize];
        block.fill([0.0; 2]);
        mix.add(start + mixed as f64 / f64::from(SOUND_RATE), 1.0 / f64::from(SOUND_RATE), block);
        out.extend_from_slice(block.as_flattened());
        mixed += length;
        Ok(mixed < count)
    })))
}

/// Reads the sounds of a plan in its order, each file once; `None` for those that cannot be read.
fn read_sounds(
    plan: &StagePlan,
    folder: &Path,
    cancel: &Cancel,
    warn: &mut dyn FnMut(&str),
) -> Result<Vec<Option<Arc<SoundSamples>>>, MovieRenderError> {
    let mut read: BTreeMap<&str, Option<Arc<SoundSamples>>> = BTreeMap::new();
    let mut bytes = 0;
    for cue in plan.sounds() {
        if read.contains_key(&*cue.source) {
            continue;
        }
        let source = SoundSource::Below { folder: folder.to_path_buf(), name: cue.source.to_string() };
        let samples = source.samples(cancel);
        if cancel.is_cancelled() {
            return Err(MovieRenderError::Cancelled);
        }
        let samples = samples.and_then(|samples| {
            let with = bytes + samples.bytes();
            if with > MOST_SOUND_BYTES {
                let most = MOST_SOUND_BYTES >> 20;
                return Err(format!("{}: the sounds are longer than {most} MB", cue.source));
            }
            bytes = with;
            Ok(samples)
        });
        if let Err(reason) = &samples {
            warn(&format!("a sound is left out: {reason}"));
        }
        read.insert(&cue.source, samples.ok().map(Arc::new));
    }
    Ok(plan.sounds().iter().map(|cue| read.get(&*cue.source).cloned().flatten()).collect())
}
