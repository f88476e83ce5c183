//! Converts between the thesis's key-frames and this library's channels: one list with a pose per key-frame, and three
//! columns.
//!
//! A track has a key-frame at every time at which any of its channels has a key. Three bits mark which values are keys;
//! a value that is not a key is the channel's value at that time, for readers that know only key-frames. So each
//! channel is restored bit for bit: its keys are the key-frames with its bit, in their order.
//!
//! The list is the merge of three queues: the earliest first key goes first, and keys with the same time, bit for bit,
//! become one key-frame. Merging keeps the order of each queue, so that even times that do not increase are kept.

use super::code::DFM_INDEX;
use super::part::DfmPart;
use super::reader::DfmReader;
use super::take::{KeyframeRecord, TrackRecord, times_increase};
use super::writer::DfmWriter;
use crate::data::{Bone, Channel, Interpolation, Track, Transform};
use crate::format::ImportError;
use crate::limits::KEYS_PER_CHANNEL;
use crate::sample::{rest_pose, sample_channel};
use glam::{Quat, Vec3};

const TRANSLATION: u32 = 1;
const ROTATION: u32 = 2;
const SCALE: u32 = 4;

/// A channel value as floats.
trait Floats: Copy {
    /// Appends the value to the part of tangents.
    fn put(self, writer: &mut DfmWriter);
    /// Reads a value from the part of tangents.
    fn get(reader: &mut DfmReader<'_, '_>) -> Result<Self, ImportError>;
}

impl Floats for Vec3 {
    fn put(self, writer: &mut DfmWriter) {
        writer.put_all(DfmPart::Slopes, &self.to_array());
    }

    fn get(reader: &mut DfmReader<'_, '_>) -> Result<Self, ImportError> {
        Ok(Self::new(
            reader.get(DfmPart::Slopes)?,
            reader.get(DfmPart::Slopes)?,
            reader.get(DfmPart::Slopes)?,
        ))
    }
}

impl Floats for Quat {
    fn put(self, writer: &mut DfmWriter) {
        writer.put_all(DfmPart::Slopes, &self.to_array());
    }

    fn get(reader: &mut DfmReader<'_, '_>) -> Result<Self, ImportError> {
        let xyz = Vec3::get(reader)?;
        Ok(Self::from_xyzw(xyz.x, xyz.y, xyz.z, reader.get(DfmPart::Slopes)?))
    }
}

/// Writes `track`, which animates `bone`.
pub(super) fn write_track(track: &Track, bone: &Bone, writer: &mut DfmWriter) -> Result<(), String> {
    let columns = [
        ("translation", track.translation.times.len(), columns_fit(&track.translation)),
        ("rotation", track.rotation.times.len(), columns_fit(&track.rotation)),
        ("scale", track.scale.times.len(), columns_fit(&track.scale)),
    ];
    for (what, keys, fits) in columns {
        if !fits {
            return Err(format!("{what}: the number of values does not match the {keys} keys"));
        }
    }
    let keyframes = merge(track).count();
    let interpolations =
        [track.translation.interpolation, track.rotation.interpolation, track.scale.interpolation];
    let keyframes = u32::try_from(keyframes).map_err(|_| format!("{keyframes} key-frames"))?;
    writer.put(DfmPart::Takes, &TrackRecord { bone: track.bone, keyframes, interpolations });
    let rest = rest_pose(bone);
    for Merged { time, keys, at } in merge(track) {
        let pose = Transform {
            translation: value(&track.translation, keys & TRANSLATION, at[0], rest.translation, time),
            rotation: value(&track.rotation, keys & ROTATION, at[1], rest.rotation, time),
            scale: value(&track.scale, keys & SCALE, at[2], rest.scale, time),
        };
        writer.put(DfmPart::Takes, &KeyframeRecord { time, pose, keys });
    }
    write_slopes(&track.translation, writer);
    write_slopes(&track.rotation, writer);
    write_slopes(&track.scale, writer);
    Ok(())
}

fn columns_fit<T: Copy>(channel: &Channel<T>) -> bool {
    channel.times.len().checked_mul(channel.values_per_key()) == Some(channel.values.len())
}

/// Returns the key, or the channel's value at that time.
fn value<T: crate::sample::Value>(channel: &Channel<T>, is_key: u32, at: usize, rest: T, time: f32) -> T {
    let key = if is_key != 0 { channel.value(at) } else { None };
    key.unwrap_or_else(|| sample_channel(channel, rest, time))
}

/// Writes the in- and out-tangents of every key of a cubic spline.
fn write_slopes<T: Floats>(channel: &Channel<T>, writer: &mut DfmWriter) {
    if channel.interpolation == Interpolation::CubicSpline {
        for key in channel.values.chunks_exact(3) {
            key[0].put(writer);
            key[2].put(writer);
        }
    }
}

/// A merged key-frame: its time, the channels that have a key there, and the number of the key in each.
struct Merged {
    time: f32,
    keys: u32,
    at: [usize; 3],
}

/// Merges the three queues of keys.
fn merge(track: &Track) -> impl Iterator<Item = Merged> + '_ {
    let queues = [&track.translation.times, &track.rotation.times, &track.scale.times];
    let mut at = [0; 3];
    std::iter::from_fn(move || {
        let heads = [0, 1, 2].map(|queue| queues[queue].get(at[queue]).copied());
        let time = heads.into_iter().flatten().min_by(f32::total_cmp)?;
        let mut merged = Merged { time, keys: 0, at };
        for (queue, bit) in [TRANSLATION, ROTATION, SCALE].into_iter().enumerate() {
            if heads[queue].is_some_and(|head| head.to_bits() == time.to_bits()) {
                merged.keys |= bit;
                at[queue] += 1;
            }
        }
        Some(merged)
    })
}

/// Reads the track of bone `index`.
pub(super) fn read_track(reader: &mut DfmReader<'_, '_>, index: u32) -> Result<Track, ImportError> {
    let TrackRecord { bone, keyframes, interpolations } = reader.get_sized(DfmPart::Takes, 1)?;
    if bone != index {
        return Err(reader.wrong(DFM_INDEX, format!("track {index} is for bone {bone}")));
    }
    reader.limit("keys of one channel", keyframes, KEYS_PER_CHANNEL)?;
    let mut list: Vec<KeyframeRecord> = reader.vec(DfmPart::Takes, 2, keyframes as usize)?;
    for _ in 0..keyframes {
        list.push(reader.get_sized(DfmPart::Takes, 2)?);
    }
    let [translation, rotation, scale] = interpolations;
    Ok(Track {
        bone,
        translation: read_channel(reader, &list, TRANSLATION, translation, |pose| pose.translation)?,
        rotation: read_channel(reader, &list, ROTATION, rotation, |pose| pose.rotation)?,
        scale: read_channel(reader, &list, SCALE, scale, |pose| pose.scale)?,
    })
}

/// Reads the channel whose keys are the key-frames of `list` with its bit.
fn read_channel<T: Floats>(
    reader: &mut DfmReader<'_, '_>,
    list: &[KeyframeRecord],
    bit: u32,
    interpolation: Interpolation,
    part: impl Fn(&Transform) -> T,
) -> Result<Channel<T>, ImportError> {
    let keys = || list.iter().filter(|keyframe| keyframe.keys & bit != 0);
    let count = keys().count();
    if count == 0 {
        return Ok(Channel { interpolation, ..Channel::default() });
    }
    let is_spline = interpolation == Interpolation::CubicSpline;
    let per_key = if is_spline { 3 } else { 1 };
    let place = reader.place();
    // Charged twice, since each list is copied once more to be shared.
    reader.context.charge(&place, (count * (4 + per_key * size_of::<T>())) as u64)?;
    let mut times = reader.context.vec(&place, count)?;
    let mut values = reader.context.vec(&place, count * per_key)?;
    for keyframe in keys() {
        times.push(keyframe.time);
        if is_spline {
            let before = T::get(reader)?;
            values.extend([before, part(&keyframe.pose), T::get(reader)?]);
        } else {
            values.push(part(&keyframe.pose));
        }
    }
    times_increase(reader, &times)?;
    Ok(Channel { times: times.into(), values: values.into(), interpolation })
}
