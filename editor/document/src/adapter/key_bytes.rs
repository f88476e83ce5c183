//! The size of keys, and its limit.

use dragonfly_anim::data::Take;
use dragonfly_anim::limits::MEMORY_MAX;

/// Largest size of the keys of all takes in bytes. Importing a file needs about twice the size of its keys, and must leave room for
/// meshes and images.
pub const KEY_BYTES: u64 = MEMORY_MAX / 4;

/// Returns the size of the keys of a take in bytes.
pub(crate) fn key_bytes(take: &Take) -> u64 {
    let of_tracks = take.tracks.iter().map(|track| {
        let times = track.translation.times.len() + track.rotation.times.len() + track.scale.times.len();
        let vectors = track.translation.values.len() + track.scale.values.len();
        4 * times + 12 * vectors + 16 * track.rotation.values.len()
    });
    let of_morphs = take.morphs.iter().map(|morph| 4 * (morph.times.len() + morph.weights.len()));
    of_tracks.chain(of_morphs).map(|bytes| bytes as u64).sum()
}
