//! Animation sets become takes.

use super::animation::{XAnimation, XKeyKind, XKeys, XSet};
use super::check as code;
use super::header::XFile;
use super::lexer::XLexer;
use super::names::decoded;
use super::scene::{XScene, affine};
use super::skeleton::BoneList;
use crate::data::{BoneIndex, Channel, Interpolation, Take, TakeExtras, Track, Transform};
use crate::format::key_times::ascending;
use crate::format::matrices::{split, unit};
use crate::format::{AxisMap, Conversion, Found, Handedness, ImportContext, ImportError, Place};
use crate::limits::CLIP_SECONDS;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Ticks per second where the file has no rate.
const USUAL_TICKS: f32 = 4800.0;

/// Last tick below which a file without a rate counts frames.
const FRAMES: f64 = 1000.0;

/// Frames per second that are assumed then.
const GUESSED_RATE: f32 = 30.0;

/// Deviation of the length of a rotation from one without a warning.
const UNIT_TOLERANCE: f32 = 0.008;

/// Name of a take that has none in the file.
pub(super) const UNNAMED: &str = "take";

/// Returns the conventions of a file.
pub(super) fn conversion(scene: &XScene, context: &ImportContext<'_>) -> Conversion {
    let lists = || scene.sets.iter().flat_map(|set| &set.animations).flat_map(|animation| &animation.keys);
    let last = lists().flat_map(|keys| &keys.rows).map(|(ticks, _)| *ticks).fold(0.0, f64::max);
    let rate = match scene.ticks {
        Some(rate) => Some(Found::in_file(rate)),
        None if scene.sets.is_empty() => None,
        None if last > 0.0 && last < FRAMES => Some(Found::guessed(GUESSED_RATE)),
        None => Some(Found::by_format(USUAL_TICKS)),
    };
    let conversion = Conversion {
        meters_per_unit: Found::guessed(1.0),
        handedness: Found::by_format(Handedness::Left),
        frame_rate: rate,
        ..Conversion::default()
    };
    let chosen = conversion.with(context.conventions());
    if rate == Some(Found::guessed(GUESSED_RATE)) && chosen.frame_rate == rate {
        let text = format!(
            "the file has no rate and its last tick is {last}; {GUESSED_RATE} per second are assumed"
        );
        context.warn(Place::File, code::TICKS_GUESSED, text);
    }
    chosen
}

/// Returns the time of a tick in seconds.
pub(super) fn seconds(ticks: f64, conversion: &Conversion) -> f32 {
    let rate = conversion.frame_rate.map_or(USUAL_TICKS, |rate| rate.value);
    // Adding 0 turns -0 into 0, since -0 would sort before 0 and yet be equal to it.
    (ticks / f64::from(rate)) as f32 + 0.0
}

/// Returns the numbers of the rows of a list that are used, in ascending order of their times, and these times.
pub(super) fn used_rows(keys: &XKeys, conversion: &Conversion) -> (Vec<u32>, Vec<f32>) {
    let times: Vec<f32> = keys.rows.iter().map(|(ticks, _)| seconds(*ticks, conversion)).collect();
    match ascending(&times) {
        None => ((0..times.len() as u32).collect(), times),
        Some(used) => {
            let times = used.iter().map(|&row| times[row as usize]).collect();
            (used, times)
        }
    }
}

/// Makes takes of the sets of a file.
pub(super) struct SetReader<'a> {
    pub(super) file: &'a XFile<'a>,
    /// Finds lines and columns; one for all sets, since it counts lines from the last place that it was asked for.
    pub(super) places: XLexer<'a>,
    pub(super) bones: &'a BoneList<'a>,
    pub(super) axes: AxisMap,
    pub(super) conversion: &'a Conversion,
    pub(super) context: &'a ImportContext<'a>,
}

impl SetReader<'_> {
    /// Returns the take of a set. `bones` is the number of bones.
    pub(super) fn take(&self, set: &XSet, bones: usize) -> Result<Take, ImportError> {
        let context = self.context;
        let mut tracks: Vec<Track> = context.vec(&Place::File, bones)?;
        context.work(bones)?;
        tracks.extend((0..bones as BoneIndex).map(|bone| Track { bone, ..Track::default() }));
        for animation in &set.animations {
            let Some(bone) = self.bone_of(animation) else { continue };
            let track = &mut tracks[bone as usize];
            if track.is_empty() {
                *track = self.track(bone, animation)?;
            } else {
                let place = self.place(animation.block.start);
                let text = "a second animation of the same frame is left out";
                context.warn(place, code::KEYS_TWICE, text);
            }
        }
        let name =
            set.name.clone().map_or_else(|| UNNAMED.to_owned(), |name| decoded(&self.file.bytes()[name]));
        let mut take =
            Take { name, start: 0.0, length: 0.0, tracks, morphs: Vec::new(), extras: TakeExtras::default() };
        if let Some((first, last)) = take.range_of_keys() {
            (take.start, take.length) = (first, last - first);
        }
        Ok(take)
    }

    fn place(&self, at: usize) -> Place {
        self.places.place(at)
    }

    fn bone_of(&self, animation: &XAnimation) -> Option<BoneIndex> {
        let bone = animation.frame.as_deref().and_then(|name| self.bones.find(name));
        if bone.is_none() && !animation.keys.is_empty() {
            let name = animation.frame.as_deref().unwrap_or_default();
            let text = format!("keys of the frame \"{name}\", which is not in the file, are left out");
            self.context.warn(self.place(animation.block.start), code::REFERENCE_UNKNOWN, text);
        }
        bone
    }

    fn track(&self, bone: BoneIndex, animation: &XAnimation) -> Result<Track, ImportError> {
        if let Some(keys) = animation.of(XKeyKind::Matrix).filter(|keys| !keys.rows.is_empty()) {
            return self.of_matrices(bone, keys);
        }
        let mut track = Track { bone, ..Track::default() };
        for keys in &animation.keys {
            let (times, used) = self.times(keys)?;
            let vectors = |map: &dyn Fn(Vec3) -> Vec3| -> Arc<[Vec3]> {
                used.iter().map(|&row| map(Vec3::from_slice(&keys.values[3 * row as usize..]))).collect()
            };
            let interpolation = Interpolation::Linear;
            match keys.kind {
                XKeyKind::Position => {
                    let values = vectors(&|position| self.axes.position(position));
                    track.translation = Channel { times, values, interpolation };
                }
                XKeyKind::Scale => {
                    let values = vectors(&|scale| self.axes.factors(scale));
                    track.scale = Channel { times, values, interpolation };
                }
                XKeyKind::Rotation => {
                    let values = self.rotations(keys, &used);
                    track.rotation = Channel { times, values, interpolation };
                }
                XKeyKind::Matrix => {}
            }
        }
        Ok(track)
    }

    /// Returns the times of the keys of a list, and the numbers of their rows.
    fn times(&self, keys: &XKeys) -> Result<(Arc<[f32]>, Vec<u32>), ImportError> {
        let context = self.context;
        let place = || self.place(keys.block.start);
        context.charge_at(place, keys.rows.len() as u64 * (16 + 4 * keys.kind.width().min(12) as u64))?;
        context.work(2 * keys.rows.len())?;
        let (used, times) = used_rows(keys, self.conversion);
        if used.len() < keys.rows.len() || used.windows(2).any(|pair| pair[0] > pair[1]) {
            let text = "times of keys do not ascend; they were sorted, and of equal ones the last was kept";
            context.warn(place(), code::TIMES_NOT_ASCENDING, text);
        }
        // NaN is not possible: ticks are finite, and the rate is greater than zero.
        let far = times.iter().copied().find(|time| time.abs() > CLIP_SECONDS);
        if let Some(time) = far {
            let (size, limit) = (time.abs() as u64, CLIP_SECONDS as u64);
            return Err(ImportError::TooLarge { place: place(), what: "seconds", size, limit });
        }
        Ok((times.into(), used))
    }

    fn rotations(&self, keys: &XKeys, used: &[u32]) -> Arc<[Quat]> {
        let mut is_odd = false;
        let mut last = Quat::IDENTITY;
        let values = used.iter().enumerate().map(|(key, &row)| {
            let values = &keys.values[4 * row as usize..];
            // The inverse rotation, w first.
            let written = Quat::from_xyzw(-values[1], -values[2], -values[3], values[0]);
            let (rotation, error) = unit(written).unwrap_or((Quat::IDENTITY, 1.0));
            is_odd |= error > UNIT_TOLERANCE;
            let rotation = self.axes.rotation(rotation);
            last = if key > 0 && last.dot(rotation) < 0.0 { -rotation } else { rotation };
            last
        });
        let values = values.collect();
        if is_odd {
            let text =
                "rotations are not of unit length; they were normalized, and those of length zero left out";
            self.context.warn(self.place(keys.block.start), code::ROTATION_NON_UNIT, text);
        }
        values
    }

    fn of_matrices(&self, bone: BoneIndex, keys: &XKeys) -> Result<Track, ImportError> {
        let (times, used) = self.times(keys)?;
        let mut poses: Vec<Transform> = self.context.vec(&Place::File, used.len())?;
        let (mut is_odd, mut is_huge) = (false, false);
        for &row in &used {
            let numbers: [f32; 16] = std::array::from_fn(|slot| keys.values[16 * row as usize + slot]);
            let matrix = affine(Mat4::from_cols_array(&numbers), || is_odd = true);
            let parts = split(self.axes.matrix(matrix));
            is_huge |= parts.is_none();
            let (mut pose, sheared) = parts.unwrap_or_default();
            is_odd |= sheared.is_some();
            if poses.last().is_some_and(|last| last.rotation.dot(pose.rotation) < 0.0) {
                pose.rotation = -pose.rotation;
            }
            poses.push(pose);
        }
        let place = || self.place(keys.block.start);
        if is_huge {
            let reason = "a matrix is too large to be decomposed".to_owned();
            return Err(ImportError::Invalid { place: place(), code: code::HUGE_POSITION, reason });
        }
        if is_odd {
            let text = "matrices are sheared or not affine; the nearest ones that are not are used";
            self.context.warn(place(), code::MATRIX_INVALID, text);
        }
        let interpolation = Interpolation::Linear;
        let vectors = |value: fn(&Transform) -> Vec3| Channel {
            times: Arc::clone(&times),
            values: poses.iter().map(value).collect(),
            interpolation,
        };
        let rotations = poses.iter().map(|pose| pose.rotation).collect();
        Ok(Track {
            bone,
            translation: vectors(|pose| pose.translation),
            rotation: Channel { times: Arc::clone(&times), values: rotations, interpolation },
            scale: vectors(|pose| pose.scale),
        })
    }
}
