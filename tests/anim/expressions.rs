//! Facial expressions of a VRM animation set the shape keys that the same expressions set in a model; exports list what they lose.

use crate::support::{animation_data, bone, take};
use dragonfly_anim::data::{
    Avatar, Channel, ExpressionBind, FaceExpression, HumanBone, Interpolation, MeshInstance, ModelData,
    MorphTrack, Take, Track,
};
use dragonfly_anim::format::{BUILTIN, TABLES};
use dragonfly_anim::retarget::retarget_expressions;
use dragonfly_anim::sample::sample_morph_weights;
use glam::{Mat4, Vec3};

/// Returns an avatar whose expressions have these bones, from 0.
fn animated(names: &[&str]) -> Avatar {
    let expression = |(bone, name): (u32, &&str)| FaceExpression {
        name: (*name).to_owned(),
        binds: Vec::new(),
        weight_bone: Some(bone),
    };
    Avatar { expressions: (0..).zip(names).map(expression).collect(), ..Avatar::default() }
}

/// Returns a model with two meshes of three shape keys each: `happy` sets the first two of both meshes, `sad` the second of the
/// first mesh. The last shape key rests at 0.25.
fn face() -> ModelData {
    let bind = |instance, target, weight| ExpressionBind { instance, target, weight };
    let expression = |name: &str, binds: Vec<ExpressionBind>| FaceExpression {
        name: name.to_owned(),
        binds,
        weight_bone: None,
    };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: vec![0.0, 0.0, 0.25],
    };
    let expressions = vec![
        expression("happy", vec![bind(0, 0, 1.0), bind(0, 1, 0.5), bind(1, 0, 0.25)]),
        expression("sad", vec![bind(0, 1, 1.0)]),
    ];
    ModelData {
        instances: vec![instance.clone(), instance],
        avatar: Avatar { expressions, ..Avatar::default() },
        ..ModelData::default()
    }
}

/// Returns a take whose bones have these x translations.
fn weights(channels: Vec<Channel<Vec3>>) -> Take {
    let track = |(bone, translation): (u32, Channel<Vec3>)| Track { bone, translation, ..Track::default() };
    take((0..).zip(channels).map(track).collect())
}

fn along_x(times: &[f32], values: &[f32], interpolation: Interpolation) -> Channel<Vec3> {
    Channel::new(times, values.iter().map(|&x| Vec3::new(x, 9.0, 9.0)).collect::<Vec<_>>(), interpolation)
}

fn at(tracks: &[MorphTrack], instance: u32, time: f32) -> [f32; 3] {
    let take = Take { morphs: tracks.to_vec(), ..Take::default() };
    let mut weights = [0.0; 3];
    sample_morph_weights(Some(&take), instance, &[0.0, 0.0, 0.25], time, &mut weights);
    weights
}

fn assert_near(got: [f32; 3], wanted: [f32; 3]) {
    assert!(got.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{got:?}, not {wanted:?}");
}

#[test]
fn an_expression_sets_the_shape_keys_of_the_expression_of_its_name_and_leaves_the_others() {
    let source = animated(&["happy", "wink"]);
    let moved = weights(vec![
        along_x(&[0.0, 2.0], &[0.0, 1.0], Interpolation::Linear),
        along_x(&[0.0, 2.0], &[1.0, 1.0], Interpolation::Linear),
    ]);
    let tracks = retarget_expressions(&moved, &source, &face());
    assert_eq!(
        tracks.iter().map(|track| (track.instance, track.targets)).collect::<Vec<_>>(),
        [(0, 3), (1, 3)]
    );
    assert_eq!(*tracks[0].times, [0.0, 2.0], "the keys of the file");
    assert_near(at(&tracks, 0, 1.0), [0.5, 0.25, 0.25]);
    assert_near(at(&tracks, 1, 2.0), [0.25, 0.0, 0.25]);
    assert_eq!(retarget_expressions(&moved, &Avatar::default(), &face()), []);
    assert_eq!(retarget_expressions(&moved, &source, &ModelData::default()), []);
}

#[test]
fn limited_weights_of_expressions_that_set_one_shape_key_are_added() {
    let moved = weights(vec![
        along_x(&[0.0, 2.0], &[0.0, 1.0], Interpolation::Linear),
        along_x(&[0.5, 1.0], &[0.0, 0.9], Interpolation::Linear),
    ]);
    let tracks = retarget_expressions(&moved, &animated(&["happy", "sad"]), &face());
    assert_eq!(*tracks[0].times, [0.0, 0.5, 1.0, 2.0]);
    assert_near(at(&tracks, 0, 0.5), [0.25, 0.125, 0.25]);
    assert_near(at(&tracks, 0, 0.75), [0.375, 0.1875 + 0.45, 0.25]);
    assert_near(at(&tracks, 0, 2.0), [1.0, 1.4, 0.25]);
    let outside = weights(vec![along_x(&[0.0, 1.0], &[-3.0, 7.0], Interpolation::Linear)]);
    let tracks = retarget_expressions(&outside, &animated(&["happy"]), &face());
    assert_near(at(&tracks, 0, 0.0), [0.0, 0.0, 0.25]);
    assert_near(at(&tracks, 0, 1.0), [1.0, 0.5, 0.25]);
}

#[test]
fn steps_stay_steps_and_splines_with_the_same_times_stay_splines() {
    let steps = along_x(&[0.0, 1.0], &[0.0, 1.0], Interpolation::Step);
    let later = along_x(&[0.5, 1.0], &[0.4, 0.0], Interpolation::Step);
    let tracks = retarget_expressions(&weights(vec![steps, later]), &animated(&["happy", "sad"]), &face());
    assert_eq!(tracks[0].interpolation, Interpolation::Step);
    assert_near(at(&tracks, 0, 0.9), [0.0, 0.4, 0.25]);
    assert_near(at(&tracks, 0, 1.1), [1.0, 0.5, 0.25]);
    let numbers = [0.0, 0.2, 0.5, -0.25, 0.6, 0.0];
    let spline = along_x(&[0.0, 1.0], &numbers, Interpolation::CubicSpline);
    let both = weights(vec![spline.clone(), spline.clone()]);
    let tracks = retarget_expressions(&both, &animated(&["happy", "sad"]), &face());
    assert_eq!((tracks[0].interpolation, tracks[0].times.len()), (Interpolation::CubicSpline, 2));
    let at_half = dragonfly_anim::sample::sample_channel(&spline, Vec3::ZERO, 0.4).x;
    assert_near(at(&tracks, 0, 0.4), [at_half, 1.5 * at_half, 0.25]);
    // Of different kinds, lines with more keys.
    let lines = along_x(&[0.0, 1.0], &[0.0, 0.2], Interpolation::Linear);
    let tracks = retarget_expressions(&weights(vec![spline, lines]), &animated(&["happy", "sad"]), &face());
    assert_eq!(tracks[0].interpolation, Interpolation::Linear);
    let got = at(&tracks, 0, 0.4);
    assert!((got[0] - at_half).abs() < 1e-3 && (got[1] - 0.5 * at_half - 0.08).abs() < 1e-3, "{got:?}");
}

#[test]
fn every_format_but_vrma_lists_the_parts_of_the_body_and_the_expressions_as_lost() {
    let mut model = face();
    let mut moved = take(vec![Track::default()]);
    moved.name = "a".to_owned();
    model.animation = animation_data(vec![bone("hips", None, Vec3::Y)], vec![moved]);
    model.instances.clear();
    model.avatar.bones = vec![HumanBone { name: "hips".to_owned(), bone: 0 }];
    let without = ModelData { avatar: Avatar::default(), ..model.clone() };
    for format in BUILTIN.iter().chain(TABLES).filter(|format| format.name != "vrma") {
        let lists = |model: &ModelData| {
            let plan = format.export.unwrap()(model, "a").unwrap();
            plan.lost.iter().any(|lost| lost.to_string().starts_with("/avatar: humanoid bones and facial"))
        };
        assert!(lists(&model) && !lists(&without), "{}", format.name);
    }
}
