//! Extracts the root motion of a walk, moves the figure by it for many loops, and restores it in the take.
//!
//! `cargo run -p dragonfly-anim --example root_motion`

use dragonfly_anim::data::{Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_anim::motion::{RootMotionOptions, extract, restore};
use dragonfly_anim::sample::PlayMode;
use glam::{Mat4, Vec3};

pub(crate) fn main() {
    // One bone at hip height that walks 1.2 m along z in a second, slightly up and down.
    let rest = Transform { translation: Vec3::Y, ..Transform::IDENTITY };
    let name = "hips".to_owned();
    let hips = Bone { name, parent: None, rest, rest_matrix: None, offset: Mat4::IDENTITY, node: None };
    let skeleton = Skeleton { bones: vec![hips] };
    let places = [Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.95, 0.6), Vec3::new(0.0, 1.0, 1.2)];
    let translation = Channel::new([0.0, 0.5, 1.0], places, Interpolation::Linear);
    let track = Track { translation, ..Track::default() };
    let walk = Take { name: "walk".to_owned(), length: 1.0, tracks: vec![track], ..Take::default() };

    // The movement along x and z and the yaw are extracted; the height stays in the take.
    let (motion, in_place) = extract(&walk, &skeleton, 0, RootMotionOptions::default()).expect("a bone");
    println!("in place: {:?}", in_place.tracks[0].translation.values);
    println!("motion:   {:?}", motion.translation.values);

    // Every frame the figure's own matrix is multiplied by the motion since the last frame, over any number of loops.
    let mut figure = Mat4::IDENTITY;
    let (frames, seconds) = (250, 1.0 / 25.0);
    for frame in 0..frames {
        let (from, to) = (frame as f32 * seconds, (frame + 1) as f32 * seconds);
        figure *= motion.delta(from, to, PlayMode::Loop).to_matrix();
    }
    let walked = figure.w_axis.z;
    println!("after {} s: {walked:.3} m", frames as f32 * seconds);
    assert!((walked - 12.0).abs() < 1e-3);

    // The motion is plain channels: make the steps half as long, and restore it.
    let mut shorter = motion.clone();
    shorter.translation.values = motion.translation.values.iter().map(|&place| place * 0.5).collect();
    let stroll = restore(&in_place, &skeleton, &shorter).expect("a bone");
    println!("stroll:   {:?}", stroll.tracks[0].translation.values);
    assert_eq!(restore(&in_place, &skeleton, &motion).expect("a bone"), walk);
}
