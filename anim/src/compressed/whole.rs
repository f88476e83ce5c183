//! Tracks whose keys are stored whole: few, and interpolated one bone at a time.

use super::grid::{WHOLE_BITS, rotation_from};
use crate::fast::PoseBlock;
use crate::fast::simd::LANES;
use crate::sample::mix::{lerp, slerp};
use glam::{Quat, Vec3};

/// A track whose keys are stored whole.
#[derive(Clone, Copy, Debug)]
pub(super) struct WholeTrack {
    pub(super) bone: usize,
    pub(super) part: usize,
    /// Offset of the first key in bytes.
    pub(super) offset: usize,
}

impl WholeTrack {
    pub(super) fn bytes_per_key(&self) -> usize {
        if self.part == 0 { 8 } else { 12 }
    }

    /// Returns the value of a key; the fourth number of a vector is 0. Zero past the end of the bytes.
    pub(super) fn value(&self, bytes: &[u8], key: u32) -> [f32; 4] {
        let at = self.offset + self.bytes_per_key() * key as usize;
        let rest = bytes.get(at..).unwrap_or(&[]);
        if self.part == 0 {
            let word = u64::from_le_bytes(rest.first_chunk().copied().unwrap_or_default());
            let number = |at: u32| (word >> (2 + at * WHOLE_BITS)) as u32 & ((1 << WHOLE_BITS) - 1);
            return rotation_from(word as u32 & 3, [0, 1, 2].map(number), WHOLE_BITS).to_array();
        }
        let words: [u8; 12] = rest.first_chunk().copied().unwrap_or_default();
        let number = |at: usize| f32::from_le_bytes([words[at], words[at + 1], words[at + 2], words[at + 3]]);
        [number(0), number(4), number(8), 0.0]
    }
}

/// Writes the values of tracks between a key and the one after it, the same for the last key, into a pose.
pub(super) fn put(tracks: &[WholeTrack], bytes: &[u8], keys: [u32; 2], mix: f32, out: &mut [PoseBlock]) {
    for track in tracks {
        let Some(block) = out.get_mut(track.bone / LANES) else { continue };
        let value = between(track, bytes, keys, mix);
        let rows: &mut [[f32; LANES]] = match track.part {
            0 => &mut block.rotation,
            1 => &mut block.translation,
            _ => &mut block.scale,
        };
        rows.iter_mut().zip(value).for_each(|(row, number)| row[track.bone % LANES] = number);
    }
}

fn between(track: &WholeTrack, bytes: &[u8], [key, after]: [u32; 2], mix: f32) -> [f32; 4] {
    let value = track.value(bytes, key);
    if mix == 0.0 {
        return value;
    }
    let next = track.value(bytes, after);
    if track.part == 0 {
        return slerp(Quat::from_array(value), Quat::from_array(next), mix).to_array();
    }
    let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    let mixed = lerp(three(value), three(next), mix);
    if mixed.is_finite() { mixed.extend(0.0).to_array() } else { value }
}
