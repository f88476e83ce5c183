//! Tracks whose keys are stored whole: few, and mixed one bone at a time.

use super::table::{Tables, WholeTrack};
use crate::fast::PoseBlock;
use crate::fast::simd::LANES;
use crate::sample::mix::{lerp, slerp};
use glam::{Quat, Vec3};

/// Puts the values between `key` and the one after it into a pose.
pub(super) fn put(tables: &Tables, bytes: &[u8], key: u32, mix: f32, out: &mut [PoseBlock]) {
    let after = (key + 1).min(tables.clock.frames - 1);
    for track in &tables.whole {
        let Some(block) = out.get_mut(track.bone / LANES) else { continue };
        let value = between(track, bytes, [key, after], mix);
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
