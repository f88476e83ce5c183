//! Takes: named animations, with one track per bone.

use super::{BoneIndex, Channel, TakeExtras, Transform};
use glam::{Quat, Vec3};

/// The pose of one bone at one time, assembled from a track's columns (thesis §3.1.2).
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(alias = "key")]
pub struct Keyframe {
    /// Seconds.
    pub time: f32,
    /// Relative to the parent bone; for a root: the offset of the whole model.
    pub pose: Transform,
}

/// All keys of one bone in one take.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// The bone that it moves.
    pub bone: BoneIndex,
    /// Meters, parent space.
    pub translation: Channel<Vec3>,
    /// Unit quaternions, parent space; neighboring ones are in one hemisphere.
    pub rotation: Channel<Quat>,
    /// Factors per axis.
    pub scale: Channel<Vec3>,
}

impl Track {
    /// Returns whether the track animates nothing.
    pub fn is_empty(&self) -> bool {
        self.translation.is_empty() && self.rotation.is_empty() && self.scale.is_empty()
    }

    /// Returns the number of keys summed over channels.
    pub fn keys(&self) -> usize {
        self.translation.len() + self.rotation.len() + self.scale.len()
    }

    /// Returns every time at which any channel has a key, ascending, each once.
    pub fn key_times(&self) -> Vec<f32> {
        let mut times: Vec<f32> = [&self.translation.times, &self.rotation.times, &self.scale.times]
            .into_iter()
            .flat_map(|times| times.iter().copied())
            .collect();
        times.sort_by(f32::total_cmp);
        times.dedup();
        times
    }
}

/// Weights of a mesh's morph targets over time.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphTrack {
    /// Position in [`super::ModelData::instances`].
    pub instance: u32,
    /// Number of targets; `weights` has this many values per key (three times this for a cubic spline: all in-tangents,
    /// all values, all out-tangents).
    pub targets: u32,
    /// Seconds, strictly ascending.
    pub times: std::sync::Arc<[f32]>,
    /// Target weights, usually 0..1.
    pub weights: std::sync::Arc<[f32]>,
    /// How values between keys are computed.
    pub interpolation: super::Interpolation,
}

/// A take (clip, glTF animation): one track per bone, a start and a length (thesis §3.1.2).
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias("clip", "animation", "action"))]
pub struct Take {
    /// As in the file; may be empty.
    pub name: String,
    /// Time of the first key of any channel, in seconds.
    pub start: f32,
    /// Seconds from the first to the last key of any channel; zero for a single pose.
    pub length: f32,
    /// One track per bone, in bone order; a bone that does not move has an empty track.
    pub tracks: Vec<Track>,
    /// Morph weights, only for meshes with animated weights.
    pub morphs: Vec<MorphTrack>,
    /// Data that a program keeps with the take: layers, contacts, events.
    pub extras: TakeExtras,
}

impl Take {
    /// Returns the time of the last key of any channel, in seconds.
    pub fn end(&self) -> f32 {
        self.start + self.length
    }

    /// Returns the times of the first and the last key of any channel in seconds, morph weights included; `None`
    /// without keys.
    pub fn range_of_keys(&self) -> Option<(f32, f32)> {
        let of_bones = self.tracks.iter().flat_map(|track| {
            [track.translation.range(), track.rotation.range(), track.scale.range()].into_iter().flatten()
        });
        let of_morphs =
            self.morphs.iter().filter_map(|morph| Some((*morph.times.first()?, *morph.times.last()?)));
        of_bones.chain(of_morphs).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// Returns the number of keys summed over all channels.
    pub fn keys(&self) -> usize {
        self.tracks.iter().map(Track::keys).sum::<usize>()
            + self.morphs.iter().map(|morph| morph.times.len()).sum::<usize>()
    }

    /// Returns the number of tracks that animate something, morph weights included.
    pub fn moving_tracks(&self) -> usize {
        self.tracks.iter().filter(|track| !track.is_empty()).count() + self.morphs.len()
    }
}
