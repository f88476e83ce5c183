//! Small models written in one line, and comparisons, for the tests of this crate.

use dragonfly_anim::data::{AnimationData, Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Returns a bone that rests at `translation` from its parent.
pub(crate) fn bone(name: &str, parent: Option<u32>, translation: Vec3) -> Bone {
    Bone {
        name: name.to_owned(),
        parent,
        rest: Transform { translation, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    }
}

/// Returns a channel of `Vec3` along x: `[(seconds, x)]`.
pub(crate) fn along_x(keys: &[(f32, f32)], interpolation: Interpolation) -> Channel<Vec3> {
    let times: Vec<f32> = keys.iter().map(|key| key.0).collect();
    let values: Vec<Vec3> = keys.iter().map(|key| Vec3::new(key.1, 0.0, 0.0)).collect();
    Channel { times: times.into(), values: values.into(), interpolation }
}

/// Returns a channel of rotations about z: `[(seconds, radians)]`.
pub(crate) fn about_z(keys: &[(f32, f32)], interpolation: Interpolation) -> Channel<Quat> {
    let times: Vec<f32> = keys.iter().map(|key| key.0).collect();
    let values: Vec<Quat> = keys.iter().map(|key| Quat::from_rotation_z(key.1)).collect();
    Channel { times: times.into(), values: values.into(), interpolation }
}

/// Returns a take with a track for each bone; its start and length are those of the keys.
pub(crate) fn take(tracks: Vec<Track>) -> Take {
    let times = || tracks.iter().flat_map(Track::key_times);
    let start = times().fold(f32::INFINITY, f32::min);
    let end = times().fold(f32::NEG_INFINITY, f32::max);
    let (start, length) = if start <= end { (start, end - start) } else { (0.0, 0.0) };
    let tracks =
        tracks.into_iter().enumerate().map(|(index, track)| Track { bone: index as u32, ..track }).collect();
    Take { name: "take".to_owned(), start, length, tracks, ..Take::default() }
}

/// Returns a skeleton with takes.
pub(crate) fn animation_data(bones: Vec<Bone>, takes: Vec<Take>) -> AnimationData {
    AnimationData { skeleton: Arc::new(Skeleton { bones }), takes: takes.into_iter().map(Arc::new).collect() }
}

/// Fails if two matrices differ by more than `tolerance` relative to the larger of 1 and their largest number.
#[track_caller]
pub(crate) fn assert_near(got: Mat4, expected: Mat4, tolerance: f32) {
    let largest = expected.to_cols_array().into_iter().map(f32::abs).fold(1.0, f32::max);
    assert!(got.abs_diff_eq(expected, tolerance * largest), "got {got}\nexpected {expected}");
}

/// Returns the smallest angle between two rotations, radians.
pub(crate) fn angle_between(a: Quat, b: Quat) -> f32 {
    let (near, far) = ((a - b).length(), (a + b).length());
    4.0 * near.min(far).atan2(near.max(far))
}
