//! Rotations that change too fast from key to key to be seen as motion.
//!
//! ```text
//! turn  = 2 · acos |q₁ · q₂|                 the short way, 0..π
//! speed = turn / (t₂ − t₁)                   reported above π a frame of 1/30 s, for turns over 90°
//! ```

use crate::check::channels::{channel_path, keys};
use crate::check::{Findings, PathKind, TakeContext};
use crate::data::Interpolation;
use glam::Quat;
use std::f32::consts::{FRAC_PI_2, PI};

/// Seconds.
const FRAME: f32 = 1.0 / 30.0;

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    for (number, track) in of.take.tracks.iter().enumerate() {
        // Step interpolation jumps intentionally.
        if matches!(track.rotation.interpolation, Interpolation::Step | Interpolation::Closest) {
            continue;
        }
        let mut before: Option<(f32, Quat)> = None;
        for (key, time, rotation) in keys(&track.rotation) {
            if let Some((earlier, from)) = before {
                let turn = turn_between(from, rotation);
                if turn > FRAC_PI_2 && time > earlier && turn / (time - earlier) > PI / FRAME {
                    let text = || format!("{:.0}° from {earlier} s to {time} s", turn.to_degrees());
                    findings.add(|| (channel_path(of, number, 1).then(PathKind::Key, key, ""), text()));
                }
            }
            before = Some((time, rotation));
        }
    }
}

/// Returns the angle in radians, the short way; NaN where a rotation is invalid.
fn turn_between(from: Quat, to: Quat) -> f32 {
    let (from, to) = (from.normalize(), to.normalize());
    2.0 * libm::acosf(from.dot(to).abs().min(1.0))
}
