//! The error of a decoded pose compared with the raw one: the largest visible distance.
//!
//! Three points are at the shell distance `d` from each bone along its axes, and move with it:
//!
//! ```text
//! error = max over key times, bones and axes a of  | to_root_raw * (d a)  -  to_root_decoded * (d a) |
//! ```
//!
//! All in scene space ("object space", "model space"), after the whole chain, so an error of the hip counts at the
//! finger, where it is visible. ACL (Animation Compression Library) measures the same three points with its `qvvf`
//! transforms; here the matrices are those of the open path, so scale and shear of parents count as they are drawn.

use super::frames::SampledFrames;
use super::settings::Exactness;
use glam::{Affine3A, Vec3A};

/// The largest error and its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestError {
    /// Distance in the length unit of the model; infinite where a decoded pose is not finite.
    pub distance: f32,
    /// Bone of the shell point.
    pub bone: usize,
    /// Time in seconds.
    pub time: f32,
}

/// Returns the distance of the farthest of the three shell points.
pub(super) fn shell_distance(raw: &Affine3A, decoded: &Affine3A, shell: f32) -> f32 {
    let moved = raw.translation - decoded.translation;
    let axes = [
        raw.matrix3.x_axis - decoded.matrix3.x_axis,
        raw.matrix3.y_axis - decoded.matrix3.y_axis,
        raw.matrix3.z_axis - decoded.matrix3.z_axis,
    ];
    let squares = axes.map(|axis: Vec3A| (moved + axis * shell).length_squared());
    let largest =
        squares.into_iter().fold(
            0.0,
            |largest: f32, square| {
                if square.is_finite() { largest.max(square) } else { f32::INFINITY }
            },
        );
    largest.sqrt()
}

/// Returns the largest error in units of its bone's tolerance, and its details.
///
/// `decoded` has the layout of the matrices of `frames`.
pub(super) fn largest_error(
    frames: &SampledFrames,
    decoded: &[Affine3A],
    exactness: &[Exactness],
) -> (f32, LargestError) {
    let mut largest = (0.0, LargestError { distance: 0.0, bone: 0, time: frames.clock.start });
    let interval = frames.clock.interval();
    for (index, (raw, decoded)) in frames.to_root.iter().zip(decoded).enumerate() {
        let (frame, bone) = (index / frames.bones, index % frames.bones);
        let distance = shell_distance(raw, decoded, exactness[bone].shell);
        let share = distance / exactness[bone].tolerance;
        if share > largest.0 {
            let time = frames.clock.time(frame as u32, interval);
            largest = (share, LargestError { distance, bone, time });
        }
    }
    largest
}
