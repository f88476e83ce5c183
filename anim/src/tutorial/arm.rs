//! The arm of the tutorial, as built by the first five steps: the starting point of the examples of the later steps.
//!
//! The examples of the first five steps compare their results with it.

use crate::animation;
use crate::data::{
    Bone, Channel, Influence, Interpolation, Primitive, Skeleton, Skin, Take, Track, Transform, Vertices,
};
use crate::sample::sample_take;
use crate::trig::rotation_about;
use glam::{DVec3, Mat4, Quat, Vec3};

/// Returns the skeleton after step 1.
pub fn without_offsets() -> Skeleton {
    let bone = |name: &str, parent, translation| Bone {
        name: name.to_owned(),
        parent,
        rest: Transform { translation, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    Skeleton { bones: vec![bone("upper", None, Vec3::ZERO), bone("lower", Some(0), Vec3::X)] }
}

/// Returns the skeleton after step 3.
pub fn skeleton() -> Skeleton {
    let mut skeleton = without_offsets();
    let rest = to_root(&skeleton, None, 0.0);
    for (bone, to_root) in skeleton.bones.iter_mut().zip(rest) {
        bone.offset = to_root.inverse();
    }
    skeleton
}

/// Returns the three vertices of step 4.
pub fn primitive() -> Primitive {
    let influence = |joint, weight| Influence { joint, weight };
    let mut influences = vec![Influence::default(); 12];
    influences[0] = influence(0, 1.0);
    influences[4] = influence(0, 0.5);
    influences[5] = influence(1, 0.5);
    influences[8] = influence(1, 1.0);
    let vertices = Vertices {
        positions: vec![Vec3::ZERO, Vec3::X, 2.0 * Vec3::X],
        influences,
        influences_per_vertex: 4,
        ..Vertices::default()
    };
    Primitive { vertices, indices: vec![0, 1, 2], ..Primitive::default() }
}

/// Returns the skin of step 4.
pub fn skin() -> Skin {
    let offsets = skeleton().bones.iter().map(|bone| bone.offset).collect();
    Skin { name: "arm".to_owned(), bones: vec![0, 1], offsets }
}

/// Returns the take of step 5.
pub fn bend() -> Take {
    let turns = [Quat::IDENTITY, rotation_about(DVec3::Z, std::f64::consts::FRAC_PI_2).as_quat()];
    let rotation = Channel::new([0.0, 1.0], turns, Interpolation::Linear);
    Take {
        name: "bend".to_owned(),
        start: 0.0,
        length: 1.0,
        tracks: vec![Track::default(), Track { bone: 1, rotation, ..Track::default() }],
        ..Take::default()
    }
}

/// Computes steps 6 and 7.
pub fn to_root(skeleton: &Skeleton, take: Option<&Take>, time: f32) -> [Mat4; 2] {
    let (mut poses, mut matrices) = ([Transform::IDENTITY; 2], [Mat4::IDENTITY; 2]);
    sample_take(take, skeleton, time, &mut poses);
    animation::to_root(skeleton, &poses, &mut matrices);
    matrices
}
