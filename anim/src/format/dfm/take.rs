//! Takes: time information, tracks, key-frames; morph tracks in parts of their own.

use super::bone::{get_pose, put_pose};
use super::code::{DFM_INDEX, DFM_VALUE};
use super::error::{WriteError, refuse};
use super::keys;
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::{DfmRecord, Put, RecordFields, choice, number_of};
use super::writer::DfmWriter;
use crate::data::{Interpolation, MeshInstance, ModelData, MorphTrack, Skeleton, Take, Transform};
use crate::format::ImportError;
use crate::limits::{CLIP_SECONDS, KEYS, KEYS_PER_CHANNEL};
use std::sync::Arc;

const INTERPOLATIONS: [Interpolation; 4] =
    [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];

/// The fixed part of a take.
pub(super) struct TakeRecord {
    start: f32,
    length: f32,
    tracks: u32,
    morphs: u32,
}

impl DfmRecord for TakeRecord {
    const SIZE: usize = 16;

    fn put(&self, out: &mut Vec<u8>) {
        out.floats(&[self.start, self.length]);
        out.u32(self.tracks);
        out.u32(self.morphs);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        Ok(Self { start: fields.f32(), length: fields.f32(), tracks: fields.u32(), morphs: fields.u32() })
    }
}

/// The fixed part of a track.
pub(super) struct TrackRecord {
    pub(super) bone: u32,
    pub(super) keyframes: u32,
    /// Interpolation of translation, rotation and scale.
    pub(super) interpolations: [Interpolation; 3],
}

impl DfmRecord for TrackRecord {
    const SIZE: usize = 12;

    fn put(&self, out: &mut Vec<u8>) {
        out.u32(self.bone);
        out.u32(self.keyframes);
        out.extend_from_slice(&self.interpolations.map(|kind| number_of(&INTERPOLATIONS, &kind)));
        out.push(0);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (bone, keyframes) = (fields.u32(), fields.u32());
        let [translation, rotation, scale, _]: [u8; 4] = fields.take();
        let mut interpolations = [Interpolation::Linear; 3];
        for (kind, number) in interpolations.iter_mut().zip([translation, rotation, scale]) {
            *kind = choice(&INTERPOLATIONS, number, "interpolation")?;
        }
        Ok(Self { bone, keyframes, interpolations })
    }
}

/// A pose at a time, and which of its three values are keys.
#[derive(Clone, Copy)]
pub(super) struct KeyframeRecord {
    pub(super) time: f32,
    pub(super) pose: Transform,
    /// Bits of the values that are keys: 1 translation, 2 rotation, 4 scale; the other values are those of their
    /// channels at this time.
    pub(super) keys: u32,
}

impl DfmRecord for KeyframeRecord {
    const SIZE: usize = 48;

    fn put(&self, out: &mut Vec<u8>) {
        out.floats(&[self.time]);
        put_pose(&self.pose, out);
        out.u32(self.keys);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (time, pose, keys) = (fields.f32(), get_pose(fields), fields.u32());
        if keys == 0 || keys > 7 {
            return Err(format!("the key bits {keys:#x} of a key-frame are invalid"));
        }
        Ok(Self { time, pose, keys })
    }
}

/// The fixed part of a morph track.
pub(super) struct MorphTrackRecord {
    instance: u32,
    targets: u32,
    interpolation: Interpolation,
    keys: u32,
}

impl DfmRecord for MorphTrackRecord {
    const SIZE: usize = 16;

    fn put(&self, out: &mut Vec<u8>) {
        out.u32(self.instance);
        out.u32(self.targets);
        out.u32(number_of(&INTERPOLATIONS, &self.interpolation).into());
        out.u32(self.keys);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (instance, targets, number, keys) = (fields.u32(), fields.u32(), fields.u32(), fields.u32());
        let number = u8::try_from(number).unwrap_or(u8::MAX);
        let interpolation = choice(&INTERPOLATIONS, number, "interpolation")?;
        Ok(Self { instance, targets, interpolation, keys })
    }
}

/// Writes every take of `model`.
pub(super) fn write(model: &ModelData, writer: &mut DfmWriter) -> Result<(), WriteError> {
    let skeleton = &model.animation.skeleton;
    writer.takes = model.animation.takes.len();
    for (number, take) in model.animation.takes.iter().enumerate() {
        let place = || format!("/takes/{number}");
        if take.tracks.len() != skeleton.len() {
            let reason = format!("{} tracks for {} bones", take.tracks.len(), skeleton.len());
            return Err(refuse(place(), reason));
        }
        writer.text(&take.name);
        let (tracks, morphs) = (take.tracks.len() as u32, take.morphs.len() as u32);
        writer.put(DfmPart::Takes, &TakeRecord { start: take.start, length: take.length, tracks, morphs });
        for (index, (track, bone)) in take.tracks.iter().zip(&skeleton.bones).enumerate() {
            let place = || format!("/takes/{number}/tracks/{index}");
            if track.bone as usize != index {
                return Err(refuse(place(), format!("the track is for bone {}", track.bone)));
            }
            keys::write_track(track, bone, writer).map_err(|reason| refuse(place(), reason))?;
        }
        for (index, morph) in take.morphs.iter().enumerate() {
            let place = || format!("/takes/{number}/morphs/{index}");
            write_morph(morph, writer).map_err(|reason| refuse(place(), reason))?;
        }
    }
    Ok(())
}

/// Returns the number of weights of a morph track with this number of keys.
fn weights(keys: usize, targets: u32, interpolation: Interpolation) -> Option<usize> {
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    keys.checked_mul(targets as usize)?.checked_mul(per_key)
}

fn write_morph(morph: &MorphTrack, writer: &mut DfmWriter) -> Result<(), String> {
    let keys = morph.times.len();
    if weights(keys, morph.targets, morph.interpolation) != Some(morph.weights.len()) {
        return Err(format!("{} weights for {keys} keys of {} targets", morph.weights.len(), morph.targets));
    }
    let MorphTrack { instance, targets, interpolation, .. } = *morph;
    writer
        .put(DfmPart::MorphTracks, &MorphTrackRecord { instance, targets, interpolation, keys: keys as u32 });
    writer.put_all(DfmPart::MorphKeys, &morph.times);
    writer.put_all(DfmPart::MorphKeys, &morph.weights);
    Ok(())
}

/// Reads every take.
pub(super) fn read(
    reader: &mut DfmReader<'_, '_>,
    skeleton: &Skeleton,
    instances: &[MeshInstance],
) -> Result<Vec<Arc<Take>>, ImportError> {
    let count = reader.count(DfmPart::Takes);
    let mut takes = reader.vec(DfmPart::Takes, 0, count)?;
    let mut keys = 0;
    for _ in 0..count {
        let name = reader.text()?;
        let record: TakeRecord = reader.get(DfmPart::Takes)?;
        if reader.strict && record.length < 0.0 {
            return Err(reader.wrong(DFM_VALUE, format!("the length of a take is {} seconds", record.length)));
        }
        if record.tracks as usize != skeleton.len() {
            let reason = format!("{} tracks for {} bones", record.tracks, skeleton.len());
            return Err(reader.wrong(DFM_VALUE, reason));
        }
        let mut tracks = reader.vec(DfmPart::Takes, 1, record.tracks as usize)?;
        for index in 0..record.tracks {
            let track = keys::read_track(reader, index)?;
            keys += track.keys();
            tracks.push(track);
        }
        let mut morphs = reader.vec(DfmPart::MorphTracks, 0, record.morphs as usize)?;
        for _ in 0..record.morphs {
            let morph = read_morph(reader, instances)?;
            keys += morph.times.len();
            morphs.push(morph);
        }
        reader.limit("keys", keys, KEYS)?;
        let (start, length) = (record.start, record.length);
        takes.push(Arc::new(Take { name, start, length, tracks, morphs, ..Take::default() }));
    }
    Ok(takes)
}

fn read_morph(reader: &mut DfmReader<'_, '_>, instances: &[MeshInstance]) -> Result<MorphTrack, ImportError> {
    let MorphTrackRecord { instance, targets, interpolation, keys } = reader.get(DfmPart::MorphTracks)?;
    let expected = instances.get(instance as usize).map(|instance| instance.morph_weights.len());
    if expected != Some(targets as usize) {
        let reason = format!("there are {targets} targets for instance {instance}, which has {expected:?}");
        return Err(reader.wrong(DFM_INDEX, reason));
    }
    let weights = weights(keys as usize, targets, interpolation)
        .ok_or_else(|| reader.wrong(DFM_VALUE, format!("{keys} keys of {targets} targets")))?;
    reader.limit("keys of one channel", keys, KEYS_PER_CHANNEL)?;
    let times: Vec<f32> = reader.list(DfmPart::MorphKeys, keys as usize)?;
    times_increase(reader, &times)?;
    let weights: Vec<f32> = reader.list(DfmPart::MorphKeys, weights)?;
    // Charged once more, since each list is copied to be shared.
    reader.context.charge(&reader.place(), 4 * (times.len() + weights.len()) as u64)?;
    Ok(MorphTrack { instance, targets, times: times.into(), weights: weights.into(), interpolation })
}

/// Checks what an importer guarantees of key times: they increase, and are within a day of zero.
pub(super) fn times_increase(reader: &DfmReader<'_, '_>, times: &[f32]) -> Result<(), ImportError> {
    if !reader.strict {
        return Ok(());
    }
    if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
        return Err(reader.wrong(DFM_VALUE, format!("a key at {} s follows one at {} s", pair[1], pair[0])));
    }
    match times.iter().find(|time| time.abs() > CLIP_SECONDS) {
        Some(time) => {
            Err(reader.wrong(DFM_VALUE, format!("a key at {time} s, more than {CLIP_SECONDS} s from zero")))
        }
        None => Ok(()),
    }
}
