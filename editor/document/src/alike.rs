//! Compares a take with the same take after saving and reading. They may differ in the last bit: importers normalize
//! rotations and give them the sign of their neighbors, which is the same rotation.

use dragonfly_anim::data::{Channel, MorphTrack, Take, Track};
use glam::{Quat, Vec3};

/// Relative difference that reading may cause.
const GRAIN: f32 = 1e-5;

/// Returns whether two takes are equivalent. Names, times and interpolations must be equal to the bit.
pub(super) fn alike(one: &Take, other: &Take) -> bool {
    (&one.name, one.start, one.length) == (&other.name, other.start, other.length)
        && one.tracks.len() == other.tracks.len()
        && one.tracks.iter().zip(&other.tracks).all(|(one, other)| alike_tracks(one, other))
        && one.morphs.len() == other.morphs.len()
        && one.morphs.iter().zip(&other.morphs).all(|(one, other)| alike_morphs(one, other))
}

fn alike_tracks(one: &Track, other: &Track) -> bool {
    one.bone == other.bone
        && alike_channels(&one.translation, &other.translation, near)
        && alike_channels(&one.rotation, &other.rotation, same_turn)
        && alike_channels(&one.scale, &other.scale, near)
}

fn alike_channels<T: Copy + PartialEq>(
    one: &Channel<T>,
    other: &Channel<T>,
    alike: impl Fn(T, T) -> bool,
) -> bool {
    one.interpolation == other.interpolation
        && one.times == other.times
        && one.values.len() == other.values.len()
        && one.values.iter().zip(other.values.iter()).all(|(one, other)| one == other || alike(*one, *other))
}

fn alike_morphs(one: &MorphTrack, other: &MorphTrack) -> bool {
    (one.instance, one.targets, one.interpolation) == (other.instance, other.targets, other.interpolation)
        && one.times == other.times
        && one.weights == other.weights
}

fn near(one: Vec3, other: Vec3) -> bool {
    (one - other).abs().max_element() <= GRAIN * one.abs().max_element().max(1e-20)
}

/// Compares the tangents of a spline, too, which need not be of unit length.
fn same_turn(one: Quat, other: Quat) -> bool {
    let grain = GRAIN * one.length().max(1e-20);
    (one - other).length().min((one + other).length()) <= grain
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_anim::data::Interpolation;

    fn take(rotation: Quat, scale: Vec3) -> Take {
        let track = Track {
            rotation: Channel {
                times: [0.5].into(),
                values: [rotation].into(),
                interpolation: Interpolation::Linear,
            },
            scale: Channel {
                times: [0.5].into(),
                values: [scale].into(),
                interpolation: Interpolation::Linear,
            },
            ..Track::default()
        };
        Take { name: "walk".to_owned(), tracks: vec![track], ..Take::default() }
    }

    #[test]
    fn takes_are_alike_if_rotations_differ_only_in_their_sign_or_last_digit() {
        let turn = Quat::from_rotation_z(2.7);
        let one = take(turn, Vec3::ONE);
        for other in [turn, -turn, turn * (1.0 + 2e-7)] {
            assert!(alike(&one, &take(other, Vec3::ONE)));
        }
        assert!(!alike(&one, &take(Quat::from_rotation_z(2.701), Vec3::ONE)));
        assert!(!alike(&one, &take(turn, Vec3::splat(1.001))));
        let mut other = one.clone();
        other.tracks[0].scale.times = [0.500_000_06].into();
        assert!(!alike(&one, &other));
        other = Take { name: "run".to_owned(), ..one.clone() };
        assert!(!alike(&one, &other) && !alike(&one, &Take::default()));
    }
}
