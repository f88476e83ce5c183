//! Moves the hand of an arm to a moving point: samples a take, solves, chains the poses again.
//!
//! `cargo run -p dragonfly-anim --example reach_with_ik`

use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Bone, Skeleton, Transform};
use dragonfly_anim::ik::{Chain, ChainScratch, Pole, TwoBone, chain, two_bone};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Vec3};

fn bone(name: &str, parent: Option<u32>, x: f32) -> Bone {
    let rest = Transform { translation: Vec3::X * x, ..Transform::IDENTITY };
    Bone { name: name.to_owned(), parent, rest, rest_matrix: None, offset: Mat4::IDENTITY, node: None }
}

pub(crate) fn main() {
    // A shoulder at the origin, 30 cm and 25 cm of arm along x.
    let bones = vec![bone("shoulder", None, 0.0), bone("elbow", Some(0), 0.3), bone("hand", Some(1), 0.25)];
    let skeleton = Skeleton { bones };
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];

    // The elbow points down; the last tenth of the reach is slowed, so that the arm does not snap straight.
    let arm = TwoBone { pole: Pole::Direction(Vec3::NEG_Y), softness: 0.1, ..TwoBone::new(0, 1, 2) };
    for step in 0..=4 {
        let target = Vec3::new(0.2 + 0.1 * step as f32, 0.1, 0.0);
        // No take here, so the rest pose; a real program passes the take that is played.
        sample_take(None, &skeleton, 0.0, &mut poses);
        to_root(&skeleton, &poses, &mut matrices);
        let reach = two_bone(&skeleton, &matrices, &arm, target, &mut poses).expect("an arm");
        to_root(&skeleton, &poses, &mut matrices);
        let hand = matrices[2].w_axis.truncate();
        println!("target {target:.2}, hand {hand:.3}, {:.1} mm left", reach.distance * 1000.0);
        assert!((hand.distance(target) - reach.distance).abs() < 1e-5);
    }

    // The same with a chain of any number of bones; here no joint may turn more than 75°.
    let mut scratch = ChainScratch::with_capacity(skeleton.len());
    let mut limit = |_bone, wish: glam::Quat| {
        let (axis, angle) = wish.to_axis_angle();
        glam::Quat::from_axis_angle(axis, angle.min(75_f32.to_radians()))
    };
    let target = Vec3::new(0.4, 0.2, 0.0);
    sample_take(None, &skeleton, 0.0, &mut poses);
    to_root(&skeleton, &poses, &mut matrices);
    let row = Chain::new(0, 2);
    let reach = chain(&skeleton, &matrices, &row, target, Some(&mut limit), &mut scratch, &mut poses);
    println!("chain: {:?}", reach.expect("a chain"));
}
