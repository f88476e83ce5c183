//! Boxes and spheres contain their points.

use crate::support::{animation_data, bone};
use dragonfly_anim::bounds::{Bounds, Sphere, bounds_of_bones, bounds_of_pose};
use dragonfly_anim::data::{
    Bone, Influence, Interpolation, Mesh, MeshInstance, ModelData, Primitive, Skin, Take, Track, Vertices,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Vec3};
use std::sync::Arc;

fn cloud(random: &mut Random, points: usize, size: f32) -> Vec<Vec3> {
    let stretch = Vec3::new(random.unit(), random.unit(), random.unit()) * size;
    let center = Vec3::new(random.between(-9.0, 9.0), random.between(-9.0, 9.0), 0.0) * size;
    (0..points)
        .map(|_| center + stretch * Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0))))
        .collect()
}

#[test]
fn every_point_is_inside_the_box_and_the_sphere() {
    let seed = seed(3);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..2_000 {
        let (count, size) = (1 + random.below(40), random.choice(&[1e-30, 1e-3, 1.0, 1e6, 1e36]));
        let points = cloud(&mut random, count, size);
        let bounds = Bounds::of_points(&points);
        for &point in &points {
            assert!(bounds.contains(point) && bounds.sphere.contains(point), "{round}: {point} {bounds:?}");
        }
        // No wider than the sphere through the corners of the box.
        let half = (bounds.max * 0.5 - bounds.min * 0.5).as_dvec3().length();
        assert!(f64::from(bounds.sphere.radius) <= half * 1.000_01 + 1e-37, "{round}: {bounds:?}");
    }
}

#[test]
fn a_line_and_a_ball_have_the_smallest_sphere() {
    let line = [Vec3::ZERO, Vec3::ONE, Vec3::splat(0.5)];
    assert!((Bounds::of_points(&line).sphere.radius - 0.75_f32.sqrt()).abs() < 1e-6);
    let mut random = Random::new(7);
    let ball: Vec<Vec3> = (0..3_000)
        .map(|_| Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0))).normalize_or(Vec3::X))
        .collect();
    let radius = Bounds::of_points(&ball).sphere.radius;
    assert!((1.0..1.1).contains(&radius), "{radius}");
}

#[test]
fn an_empty_model_has_empty_bounds_at_the_origin() {
    let nothing = Bounds { min: Vec3::ZERO, max: Vec3::ZERO, sphere: Sphere::default() };
    assert_eq!(Bounds::of_points(&[]), nothing);
    assert_eq!(Bounds::of_points(&[Vec3::NAN, Vec3::INFINITY]), nothing);
    assert_eq!(bounds_of_pose(&Arc::new(ModelData::default()), Some(3), 1.0), nothing);
}

#[test]
fn the_largest_floats_give_finite_bounds() {
    let bounds = Bounds::of_points(&[Vec3::MIN, Vec3::MAX, Vec3::NAN]);
    assert_eq!((bounds.min, bounds.max, bounds.center()), (Vec3::MIN, Vec3::MAX, Vec3::ZERO));
    assert_eq!(bounds.sphere, Sphere { center: Vec3::ZERO, radius: f32::MAX });
}

#[test]
fn a_skeleton_without_geometry_has_the_bounds_of_its_bones() {
    let bones = vec![bone("a", None, Vec3::X), bone("b", Some(0), Vec3::new(0.0, 2.0, 0.0))];
    let model = Arc::new(ModelData { animation: animation_data(bones, vec![]), ..ModelData::default() });
    let bounds = bounds_of_pose(&model, None, 0.0);
    assert_eq!((bounds.min, bounds.max), (Vec3::X, Vec3::new(1.0, 2.0, 0.0)));
    assert_eq!(bounds, bounds_of_bones(Evaluator::new(model).to_root()));
}

/// One bone that slides from 0 to 10 along x within a second and carries one skinned vertex and one rigid one.
fn sliding() -> Arc<ModelData> {
    let track = Track {
        translation: crate::support::along_x(&[(0.0, 0.0), (1.0, 10.0)], Interpolation::Linear),
        ..Track::default()
    };
    let take: Take = crate::support::take(vec![track]);
    let bones: Vec<Bone> = vec![bone("slider", None, Vec3::ZERO)];
    let skinned = Vertices {
        positions: vec![Vec3::Y],
        influences: vec![Influence { joint: 0, weight: 1.0 }; 4]
            .into_iter()
            .enumerate()
            .map(|(at, influence)| if at == 0 { influence } else { Influence::default() })
            .collect(),
        influences_per_vertex: 4,
        ..Vertices::default()
    };
    let rigid = Vertices { positions: vec![Vec3::NEG_Y], ..Vertices::default() };
    let mesh = |vertices| Mesh {
        primitives: vec![Primitive { vertices, ..Primitive::default() }],
        ..Mesh::default()
    };
    let instance = |mesh, skin, bone| MeshInstance {
        mesh,
        node: None,
        skin,
        bone,
        to_bone: Mat4::IDENTITY,
        morph_weights: vec![],
    };
    Arc::new(ModelData {
        meshes: vec![mesh(skinned), mesh(rigid)],
        instances: vec![instance(0, Some(0), None), instance(1, None, Some(0)), instance(1, None, None)],
        skins: vec![Skin { name: String::new(), bones: vec![0], offsets: vec![Mat4::IDENTITY] }],
        animation: animation_data(bones, vec![take]),
        ..ModelData::default()
    })
}

#[test]
fn bounds_follow_the_pose() {
    let model = sliding();
    let rest = bounds_of_pose(&model, None, 0.0);
    assert_eq!((rest.min, rest.max), (Vec3::NEG_Y, Vec3::Y));
    let half = bounds_of_pose(&model, Some(0), 0.5);
    assert_eq!((half.min, half.max), (Vec3::NEG_Y, Vec3::new(5.0, 1.0, 0.0)));
    let mut evaluator = Evaluator::new(model);
    for time in [0.0, 0.25, 1.0] {
        evaluator.pose(Some(0), time);
        let bounds = evaluator.bounds();
        for position in evaluator.all_positions() {
            assert!(bounds.contains(position) && bounds.sphere.contains(position));
        }
        assert_eq!(bounds.max.x, time * 10.0);
    }
}
