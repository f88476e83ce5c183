//! A compressed take: its bytes, and the tables to play them.

use super::FormatError;
use super::kernel::Decode;
use super::read::read;
use super::stored::BETWEEN;
use super::table::Tables;
use crate::data::{Channel, Take, Track};
use crate::fast::simd::{Simd, SimdLevel};
use crate::fast::{Playable, Pose, PoseBlock, StillPose};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// A take in few bytes that can be sampled at any time.
///
/// Contains the bytes, checked, and tables ([`Self::bytes_in_memory`]); there is no state per character, so one take
/// can be shared by any number of them.
#[derive(Clone, Debug)]
pub struct CompressedTake {
    bytes: Arc<[u8]>,
    tables: Tables,
    level: SimdLevel,
}

impl CompressedTake {
    /// Reads the take in `bytes`, as returned by [`Self::as_bytes`].
    ///
    /// Every number is checked. Bytes that are truncated, altered or made up give an error with the offset of the first
    /// invalid item; an accepted take can be sampled without a panic and gives finite numbers.
    pub fn from_bytes(bytes: impl Into<Arc<[u8]>>) -> Result<Self, FormatError> {
        let bytes = bytes.into();
        let tables = read(&bytes)?;
        Ok(Self { bytes, tables, level: SimdLevel::best() })
    }

    /// Returns the bytes: little-endian, complete, with a version; see [`super`] for the layout.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the take, to be sampled with the instructions of `level`.
    pub fn with_level(mut self, level: SimdLevel) -> Self {
        self.level = level;
        self
    }

    /// Returns the name of the take, at most 255 bytes of it.
    pub fn name(&self) -> &str {
        &self.tables.name
    }

    /// Returns the time of the first key in seconds.
    pub fn start(&self) -> f32 {
        self.tables.clock.start
    }

    /// Returns the seconds from the first key to the last.
    pub fn length(&self) -> f32 {
        self.tables.clock.length
    }

    /// Returns the number of keys, evenly spaced from the start to the end; at least one.
    pub fn keys(&self) -> usize {
        self.tables.clock.frames as usize
    }

    /// Returns the number of bones.
    pub fn bones(&self) -> usize {
        self.tables.bones
    }

    /// Returns the size in memory in bytes: [`Self::as_bytes`] and the tables.
    pub fn bytes_in_memory(&self) -> usize {
        self.bytes.len() + self.tables.bytes()
    }

    /// Writes the pose of every bone at `time` seconds, each relative to its parent.
    ///
    /// Any time costs the same. Times outside the take, and NaN, give the first or the last key, as [`crate::sample`]
    /// does. Rotations are slerped, translations and scales interpolated linearly. Bones past the end of `pose` are
    /// left out; bones of `pose` past the take's stay as they are, from the next multiple of eight on. Allocates
    /// nothing.
    pub fn sample(&self, time: f32, pose: &mut Pose) {
        crate::fast::sample(self.level, self, time, pose.blocks_mut());
    }

    /// Returns an ordinary take with the decoded keys, to be edited, shown or sampled on the open path.
    ///
    /// Each bone has all three channels: with a key at each key time where it moves, else with one.
    pub fn decompress(&self) -> Take {
        let clock = &self.tables.clock;
        let times: Arc<[f32]> = (0..clock.frames).map(|key| clock.time(key, self.tables.interval)).collect();
        let mut tracks: Vec<Track> = (0..self.tables.bones).map(|bone| self.still(bone)).collect();
        for place in self.tables.slots() {
            let value = |key| self.tables.value(&self.bytes, &place, key);
            put(&mut tracks[place.bone], place.part, &times, value);
        }
        for track in &self.tables.whole {
            put(&mut tracks[track.bone], track.part, &times, |key| track.value(&self.bytes, key));
        }
        Take {
            name: self.tables.name.clone(),
            start: clock.start,
            length: clock.length,
            tracks,
            ..Take::default()
        }
    }

    /// Returns the track of a bone that does not move.
    fn still(&self, bone: usize) -> Track {
        let pose = self.tables.still_pose(bone);
        let start: Arc<[f32]> = Arc::new([self.tables.clock.start]);
        Track {
            bone: bone as u32,
            translation: Channel::new(Arc::clone(&start), [pose.translation], BETWEEN),
            rotation: Channel::new(Arc::clone(&start), [pose.rotation], BETWEEN),
            scale: Channel::new(start, [pose.scale], BETWEEN),
        }
    }
}

impl PartialEq for CompressedTake {
    /// Returns whether the bytes are equal.
    fn eq(&self, other: &Self) -> bool {
        self.bytes == other.bytes
    }
}

/// Fills a channel of a track with a value for each of `times`.
fn put(track: &mut Track, part: usize, times: &Arc<[f32]>, value: impl Fn(u32) -> [f32; 4]) {
    let values = (0..times.len() as u32).map(value);
    let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    let times = Arc::clone(times);
    match part {
        0 => track.rotation = Channel::new(times, values.map(Quat::from_array).collect::<Vec<_>>(), BETWEEN),
        1 => track.translation = Channel::new(times, values.map(three).collect::<Vec<_>>(), BETWEEN),
        _ => track.scale = Channel::new(times, values.map(three).collect::<Vec<_>>(), BETWEEN),
    }
}

impl Playable for CompressedTake {
    fn bones(&self) -> usize {
        self.bones()
    }

    fn start(&self) -> f32 {
        self.start()
    }

    fn length(&self) -> f32 {
        self.length()
    }

    fn still(&self) -> &Arc<StillPose> {
        &self.tables.still
    }

    #[inline(always)]
    fn sample_moving_with<S: Simd>(&self, time: f32, out: &mut [PoseBlock]) {
        S::call(Decode { tables: &self.tables, bytes: &self.bytes, time, out });
    }
}
