//! A baked take has a key at every frame, where the take is.

use crate::support::{about_z, along_x, take};
use dragonfly_anim::bake::baked;
use dragonfly_anim::data::{Interpolation, MorphTrack, Take, Track};
use dragonfly_anim::frames::FramesError;
use dragonfly_anim::sample::{sample_channel, sample_morph_weights};
use glam::{Quat, Vec3};

fn moving() -> Take {
    let mut track = Track {
        translation: along_x(&[(0.5, 0.0), (1.0, 3.0), (2.02, 1.0)], Interpolation::Linear),
        rotation: about_z(&[(0.5, 0.0), (0.8, 1.0), (1.9, -1.0)], Interpolation::Step),
        ..Track::default()
    };
    track.scale = along_x(&[(1.0, 2.0)], Interpolation::Linear);
    let mut moving = take(vec![track]);
    moving.morphs.push(MorphTrack {
        instance: 0,
        targets: 2,
        times: [0.5, 1.5].into(),
        weights: vec![0.0, 1.0, 1.0, 0.0].into(),
        interpolation: Interpolation::Linear,
    });
    moving
}

#[test]
fn a_baked_take_has_the_values_of_the_take_at_every_frame() {
    let (before, rate) = (moving(), 24.0);
    let after = baked(&before, rate).unwrap();
    let (old, new) = (&before.tracks[0], &after.tracks[0]);
    // From 0.5 s to the first frame after 2.02 s.
    assert_eq!(new.translation.len(), 38);
    assert_eq!(after.start, 0.5);
    for (frame, &time) in new.translation.times.iter().enumerate() {
        assert!((time - 0.5 - frame as f32 / rate).abs() < 1e-6);
        assert_eq!(new.translation.values[frame], sample_channel(&old.translation, Vec3::ZERO, time));
        assert_eq!(new.rotation.values[frame], sample_channel(&old.rotation, Quat::IDENTITY, time));
        let weights = [&before, &after].map(|take| {
            let mut weights = [0.0; 2];
            sample_morph_weights(Some(take), 0, &[], time, &mut weights);
            weights
        });
        assert_eq!(weights[0], weights[1], "at {time}");
    }
    assert_eq!((new.rotation.interpolation, &new.scale), (Interpolation::Linear, &old.scale));
    assert_eq!(baked(&after, rate).unwrap(), after, "baked once, it stays");
}

#[test]
fn rates_that_are_none_and_takes_that_are_too_long_are_refused() {
    for rate in [0.0, -24.0, f32::NAN, f32::INFINITY] {
        assert!(matches!(baked(&moving(), rate), Err(FramesError::Rate { .. })), "{rate}");
    }
    assert!(matches!(baked(&moving(), 1e9), Err(FramesError::TooMany { .. })));
    assert_eq!(baked(&Take::default(), 30.0).unwrap().keys(), 0);
}
