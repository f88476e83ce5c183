//! Clips: for each bone a list of keys with time, position, scale and rotation.

use super::check as code;
use super::scan::M3dScanner;
use crate::data::{BoneIndex, Channel, Interpolation, Take, TakeExtras, Track};
use crate::format::key_times::ascending;
use crate::format::matrices::unit;
use crate::format::{AxisMap, ImportContext, ImportError};
use crate::limits::{CLIP_SECONDS, HUGE, KEYS, KEYS_PER_CHANNEL};
use glam::{Quat, Vec3};
use std::ops::Range;
use std::sync::Arc;

/// Deviation of the length of a rotation from one without a warning.
const UNIT_TOLERANCE: f32 = 0.008;

/// Bytes of the shortest clip without bones, list of keys, and key.
const CLIP_BYTES: usize = 8;
const LIST_BYTES: usize = 8;
const ROW_BYTES: usize = 30;

/// A clip.
pub(super) struct M3dClip {
    pub(super) name: Range<usize>,
    /// From the label to the closing brace.
    pub(super) block: Range<usize>,
    /// Keys of each bone.
    pub(super) bones: Vec<M3dKeys>,
}

/// Keys of one bone in one clip.
pub(super) struct M3dKeys {
    /// Place of the number of keys.
    pub(super) count: Range<usize>,
    /// End of the opening brace.
    pub(super) open: usize,
    pub(super) rows: Vec<M3dRow>,
}

/// A key, as in the file.
#[derive(Clone, Copy)]
pub(super) struct M3dRow {
    /// Start of its first label and end of its last number.
    pub(super) at: usize,
    pub(super) end: usize,
    pub(super) time: f32,
    pub(super) position: Vec3,
    pub(super) scale: Vec3,
    pub(super) rotation: Quat,
}

impl M3dKeys {
    /// Returns the numbers of the rows that are used, in ascending order of their times.
    pub(super) fn used(&self) -> Vec<u32> {
        let times: Vec<f32> = self.rows.iter().map(|row| row.time).collect();
        ascending(&times).unwrap_or_else(|| (0..times.len() as u32).collect())
    }
}

/// Reads the section of clips. Their number was not checked before.
pub(super) fn clips(
    scanner: &mut M3dScanner<'_>,
    count: usize,
    bones: usize,
    context: &ImportContext<'_>,
) -> Result<Vec<M3dClip>, ImportError> {
    scanner.label("the section AnimationClips")?;
    let place = scanner.place(scanner.at());
    if scanner.left() / CLIP_BYTES.max(bones.saturating_mul(LIST_BYTES)) < count {
        let reason = format!("the text is too short for {count} clips of {bones} bones");
        return Err(scanner.invalid(scanner.at(), crate::format::text::UNEXPECTED_END, reason));
    }
    let mut clips = context.vec(&place, count)?;
    let mut keys = 0;
    for _ in 0..count {
        let start = scanner.label("a clip")?.at;
        let name = scanner.word("the name of a clip")?;
        scanner.label("a brace")?;
        let mut lists = context.vec(&place, bones)?;
        for _ in 0..bones {
            let list = list(scanner, context)?;
            keys += list.rows.len();
            if keys > KEYS {
                let (size, limit) = (keys as u64, KEYS as u64);
                return Err(ImportError::TooLarge { place, what: "keys in all", size, limit });
            }
            lists.push(list);
        }
        let close = scanner.label("a brace")?;
        let name = name.at..name.at + name.text.len();
        clips.push(M3dClip { name, block: start..close.at + close.text.len(), bones: lists });
    }
    Ok(clips)
}

fn list(scanner: &mut M3dScanner<'_>, context: &ImportContext<'_>) -> Result<M3dKeys, ImportError> {
    scanner.label("the keys of a bone")?;
    let (count, token) = scanner.count("the number of keys", ROW_BYTES)?;
    let place = scanner.place(token.at);
    if count > KEYS_PER_CHANNEL {
        let (size, limit) = (count as u64, KEYS_PER_CHANNEL as u64);
        return Err(ImportError::TooLarge { place, what: "keys", size, limit });
    }
    let open = scanner.label("a brace")?;
    let mut rows = context.vec(&place, count)?;
    for _ in 0..count {
        context.work(16)?;
        rows.push(row(scanner)?);
    }
    scanner.label("a brace")?;
    Ok(M3dKeys { count: token.at..token.at + token.text.len(), open: open.at + open.text.len(), rows })
}

fn row(scanner: &mut M3dScanner<'_>) -> Result<M3dRow, ImportError> {
    let at = scanner.label("the time of a key")?.at;
    let [time] = scanner.floats("the time of a key")?;
    if time.abs() > CLIP_SECONDS {
        let (size, limit) = (time.abs() as u64, CLIP_SECONDS as u64);
        return Err(ImportError::TooLarge { place: scanner.place(at), what: "seconds", size, limit });
    }
    let position = Vec3::from(scanner.labelled::<3>("the position of a key")?);
    let scale = Vec3::from(scanner.labelled::<3>("the scale of a key")?);
    let rotation = Quat::from_array(scanner.labelled::<4>("the rotation of a key")?);
    if position.abs().max(scale.abs()).max_element() > HUGE {
        return Err(scanner.invalid(at, code::HUGE_POSITION, "the key is too large"));
    }
    // Adding 0 turns -0 into 0, since -0 would sort before 0 and yet be equal to it.
    Ok(M3dRow { at, end: scanner.at(), time: time + 0.0, position, scale, rotation })
}

/// Returns the take of a clip.
pub(super) fn take(
    clip: &M3dClip,
    bytes: &[u8],
    axes: &AxisMap,
    scanner: &M3dScanner<'_>,
    context: &ImportContext<'_>,
) -> Result<Take, ImportError> {
    let mut tracks = context.vec(&scanner.place(clip.block.start), clip.bones.len())?;
    for (number, keys) in clip.bones.iter().enumerate() {
        tracks.push(track(number as BoneIndex, keys, axes, scanner, context)?);
    }
    let name = String::from_utf8_lossy(&bytes[clip.name.clone()]).into_owned();
    let mut take =
        Take { name, start: 0.0, length: 0.0, tracks, morphs: Vec::new(), extras: TakeExtras::default() };
    if let Some((first, last)) = take.range_of_keys() {
        (take.start, take.length) = (first, last - first);
    }
    Ok(take)
}

fn track(
    bone: BoneIndex,
    keys: &M3dKeys,
    axes: &AxisMap,
    scanner: &M3dScanner<'_>,
    context: &ImportContext<'_>,
) -> Result<Track, ImportError> {
    let place = || scanner.place(keys.count.start);
    if keys.rows.is_empty() {
        let text = format!("bone {bone} has no key; it is at rest");
        context.warn(place(), code::KEYS_MISSING, text);
        return Ok(Track { bone, ..Track::default() });
    }
    context.charge(&place(), keys.rows.len() as u64 * 60)?;
    context.work(keys.rows.len())?;
    let used = keys.used();
    if used.len() < keys.rows.len() || used.windows(2).any(|pair| pair[0] > pair[1]) {
        let text = "times of keys do not ascend; they were sorted, and of equal ones the last was kept";
        context.warn(place(), code::TIMES_NOT_ASCENDING, text);
    }
    let rows = || used.iter().map(|&row| &keys.rows[row as usize]);
    let times: Arc<[f32]> = rows().map(|row| row.time).collect();
    let mut last = Quat::IDENTITY;
    let mut is_odd = false;
    let rotations: Arc<[Quat]> = rows()
        .enumerate()
        .map(|(key, row)| {
            let (rotation, error) = unit(row.rotation).unwrap_or((Quat::IDENTITY, 1.0));
            is_odd |= error > UNIT_TOLERANCE;
            let rotation = axes.rotation(rotation);
            // The first one as in the file, and each next one in the hemisphere of the one before.
            last = if key > 0 && last.dot(rotation) < 0.0 { -rotation } else { rotation };
            last
        })
        .collect();
    if is_odd {
        let text =
            "rotations are not of unit length; they were normalized, and those of length zero left out";
        context.warn(place(), code::ROTATION_NON_UNIT, text);
    }
    let vectors = |value: fn(&M3dRow) -> Vec3, map: &dyn Fn(Vec3) -> Vec3| Channel {
        times: Arc::clone(&times),
        values: rows().map(|row| map(value(row))).collect(),
        interpolation: Interpolation::Linear,
    };
    Ok(Track {
        bone,
        translation: vectors(|row| row.position, &|position| axes.position(position)),
        rotation: Channel {
            times: Arc::clone(&times),
            values: rotations,
            interpolation: Interpolation::Linear,
        },
        scale: vectors(|row| row.scale, &|scale| axes.factors(scale)),
    })
}
