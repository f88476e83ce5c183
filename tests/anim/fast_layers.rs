//! Blends, additive layers, limbs, crowds and vertices of the fast path agree with the formulas.

use crate::doors::data;
use crate::fast_path::{Worst, compare_poses, load, made};
use dragonfly_anim::data::{ModelData, Transform};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{
    FastTwoBone, KeyedTake, LaneMask, Playing, Pose, PoseLayer, Rig, RootPoses, Scratch, SkinBinding,
    SkinnedVertices, add, blend, blend_normalized, difference, distance_left, matrix, pose_character,
    pose_crowd, sample, skin_vertices, to_root, two_bone,
};
use dragonfly_anim::sample::mix::slerp;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::sync::Arc;

fn vector(random: &mut Random) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)))
}

fn poses(random: &mut Random, bones: usize) -> Vec<Transform> {
    let pose = |_| Transform {
        translation: vector(random),
        rotation: Quat::from_axis_angle(vector(random).normalize_or(Vec3::X), random.between(0.0, 3.0)),
        scale: Vec3::ONE + vector(random) * 0.3,
    };
    (0..bones).map(pose).collect()
}

/// The formula for one bone.
fn blended(base: Transform, base_weight: f32, layers: &[(Transform, f32)]) -> Transform {
    let all: Vec<(Transform, f32)> =
        std::iter::once((base, base_weight)).chain(layers.iter().copied()).collect();
    let total: f32 = all.iter().map(|layer| layer.1).sum();
    let mut lead = all[0];
    for layer in &all {
        if layer.1 > lead.1 {
            lead = *layer;
        }
    }
    let mut sum =
        Transform { translation: Vec3::ZERO, rotation: Quat::from_xyzw(0., 0., 0., 0.), scale: Vec3::ZERO };
    for (pose, weight) in all {
        let share = weight / total;
        let side = if pose.rotation.dot(lead.0.rotation) < 0.0 { -share } else { share };
        sum.translation += pose.translation * share;
        sum.rotation += pose.rotation * side;
        sum.scale += pose.scale * share;
    }
    Transform { rotation: sum.rotation.normalize(), ..sum }
}

#[test]
fn any_number_of_layers_blends_according_to_the_formula() {
    let seed = seed(5);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut worst = Worst::default();
    for round in 0..300 {
        let bones = random.choice(&[1, 7, 8, 9, 67]);
        let count = random.below(7);
        let base = poses(&mut random, bones);
        let layers: Vec<Vec<Transform>> = (0..count).map(|_| poses(&mut random, bones)).collect();
        let weights: Vec<f32> =
            (0..count).map(|_| random.choice(&[0.0, -1.0, 0.13, 0.3, 0.71, 2.0])).collect();
        let masked = random.below(2) == 0;
        let bone_weights: Vec<f32> = (0..bones).map(|_| random.choice(&[0.0, 0.37, 1.0])).collect();
        let mask = LaneMask::new(bone_weights.iter().copied());
        let soa: Vec<Pose> = layers.iter().map(|layer| Pose::from_transforms(layer)).collect();
        let list: Vec<PoseLayer> = soa
            .iter()
            .zip(&weights)
            .enumerate()
            .map(|(at, (pose, &weight))| {
                let layer = PoseLayer::new(pose.blocks(), weight);
                if masked && at.is_multiple_of(2) { layer.masked(&mask) } else { layer }
            })
            .collect();
        let fast_base = Pose::from_transforms(&base);
        for (normalized, level) in
            [false, true].into_iter().flat_map(|n| SimdLevel::all().into_iter().map(move |l| (n, l)))
        {
            let mut out = Pose::new(bones);
            let blend = if normalized { blend_normalized } else { blend };
            blend(level, fast_base.blocks(), &list, out.blocks_mut());
            let expected: Vec<Transform> = (0..bones)
                .map(|bone| {
                    let weight = |at: usize| {
                        weights[at].max(0.0)
                            * if masked && at.is_multiple_of(2) { bone_weights[bone] } else { 1.0 }
                    };
                    let parts: Vec<(Transform, f32)> =
                        (0..count).map(|at| (layers[at][bone], weight(at))).collect();
                    let sum: f32 = parts.iter().map(|part| part.1).sum();
                    let rest = match normalized {
                        true => f32::from(sum == 0.0),
                        false => (1.0 - sum).max(0.0),
                    };
                    blended(base[bone], rest, &parts)
                })
                .collect();
            compare_poses(&out, &expected, &mut worst, &format!("{round} {} {normalized}", level.name()));
        }
    }
    worst.assert("blends");
}

#[test]
fn a_blend_of_a_pose_with_itself_is_the_pose() {
    let mut random = Random::new(4);
    let pose = poses(&mut random, 67);
    let soa = Pose::from_transforms(&pose);
    let mut out = Pose::new(67);
    let layers = [0.2, 0.5, 0.9].map(|weight| PoseLayer::new(soa.blocks(), weight));
    let mut worst = Worst::default();
    for level in SimdLevel::all() {
        blend(level, soa.blocks(), &layers, out.blocks_mut());
        compare_poses(&out, &pose, &mut worst, level.name());
    }
    worst.assert("itself");
}

#[test]
fn an_additive_layer_adds_its_share_of_the_difference() {
    let mut random = Random::new(6);
    let (from, to, base) = (poses(&mut random, 67), poses(&mut random, 67), poses(&mut random, 67));
    let [from_soa, to_soa, base_soa] = [&from, &to, &base].map(|list| Pose::from_transforms(list));
    let (mut more, mut out) = (Pose::new(67), Pose::new(67));
    let mut worst = Worst::default();
    for level in SimdLevel::all() {
        difference(level, to_soa.blocks(), from_soa.blocks(), more.blocks_mut());
        add(level, from_soa.blocks(), more.blocks(), 1.0, None, out.blocks_mut());
        compare_poses(&out, &to, &mut worst, "back");
        add(level, base_soa.blocks(), more.blocks(), f32::NAN, None, out.blocks_mut());
        compare_poses(&out, &base, &mut worst, "nothing");
        for weight in [0.01, 0.3, 0.5, 0.99] {
            let expected: Vec<Transform> = (0..67)
                .map(|bone| {
                    let turn = (to[bone].rotation * from[bone].rotation.conjugate()).normalize();
                    let factor = to[bone].scale / from[bone].scale;
                    Transform {
                        translation: base[bone].translation
                            + (to[bone].translation - from[bone].translation) * weight,
                        rotation: slerp(Quat::IDENTITY, turn, weight) * base[bone].rotation,
                        scale: base[bone].scale * (Vec3::ONE + (factor - Vec3::ONE) * weight),
                    }
                })
                .collect();
            add(level, base_soa.blocks(), more.blocks(), weight, None, out.blocks_mut());
            compare_poses(&out, &expected, &mut worst, &format!("{} {weight}", level.name()));
            let half = LaneMask::new(vec![weight; 67]);
            add(level, base_soa.blocks(), more.blocks(), 1.0, Some(&half), out.blocks_mut());
            compare_poses(&out, &expected, &mut worst, &format!("{} mask {weight}", level.name()));
        }
    }
    worst.assert("additive");
}

#[test]
fn a_limb_reaches_every_reachable_target() {
    let fox = load(&data().join("gltf/Fox.glb"));
    let rig = Rig::new(&fox.animation.skeleton);
    let find = |name: &str| fox.animation.skeleton.find(name).unwrap();
    let end = find("b_LeftHand_011");
    let middle = fox.animation.skeleton.bones[end as usize].parent.unwrap();
    let root = fox.animation.skeleton.bones[middle as usize].parent.unwrap();
    let take = KeyedTake::new(&fox.animation.skeleton, &fox.animation.takes[1]);
    let mut random = Random::new(8);
    let mut pose = rig.rest().clone();
    let mut roots = RootPoses::new(&rig);
    for round in 0..500 {
        let limb = FastTwoBone {
            pole: if round % 2 == 0 { Vec3::ZERO } else { vector(&mut random) },
            ..FastTwoBone::new(root, middle, end)
        };
        sample(SimdLevel::best(), &take, random.unit(), pose.blocks_mut());
        to_root(SimdLevel::best(), &rig, pose.blocks(), &mut roots);
        let place = |bone: u32| matrix::transform_point(roots.get(bone as usize), Vec3::ZERO);
        let (a, b) = ((place(middle) - place(root)).length(), (place(end) - place(middle)).length());
        let (least, most) = ((a - b).abs(), a + b);
        let distance = least + (most - least) * random.between(0.02, 0.98);
        let target = place(root) + vector(&mut random).normalize_or(Vec3::X) * distance;
        assert!(two_bone(&limb, target, &roots, &mut pose));
        to_root(SimdLevel::best(), &rig, pose.blocks(), &mut roots);
        let left = distance_left(&limb, target, &roots);
        assert!(left < 1e-4 * most, "{round}: {left} of {most}");
        // A target out of reach: the limb is straight and points at it.
        let far = place_of(&roots, root) + vector(&mut random).normalize_or(Vec3::X) * most * 2.0;
        assert!(two_bone(&limb, far, &roots, &mut pose));
        to_root(SimdLevel::best(), &rig, pose.blocks(), &mut roots);
        assert!((distance_left(&limb, far, &roots) - most).abs() < 1e-3 * most, "{round}");
    }
    assert!(!two_bone(&FastTwoBone::new(root, middle, 999), Vec3::ZERO, &roots, &mut pose));
    assert!(!two_bone(&FastTwoBone::new(root, middle, end), Vec3::NAN, &roots, &mut pose));
}

fn place_of(roots: &RootPoses, bone: u32) -> Vec3 {
    matrix::transform_point(roots.get(bone as usize), Vec3::ZERO)
}

/// Compares the final poses and vertices of a model on the open path with those of the fast path's pipeline.
fn compare_pipeline(model: ModelData, take: usize) {
    let model = Arc::new(model);
    let rig = Rig::new(&model.animation.skeleton);
    let binding = SkinBinding::new(&rig, &model.skins[0]);
    let keyed = KeyedTake::new(&model.animation.skeleton, &model.animation.takes[take]);
    let mut evaluator = Evaluator::new(Arc::clone(&model));
    let mut scratch = Scratch::new(&rig);
    let mut finals = vec![matrix::IDENTITY; binding.joints()];
    let primitive = &model.meshes[0].primitives[0];
    let vertices = SkinnedVertices::new(primitive);
    let (mut points, mut directions) = (vec![[0.0; 3]; vertices.len()], vec![[0.0; 3]; vertices.len()]);
    let (mut open_points, mut open_directions) =
        (vec![Vec3::ZERO; vertices.len()], vec![Vec3::ZERO; vertices.len()]);
    let mut worst = Worst::default();
    for step in 0..10 {
        let time = model.animation.takes[take].length * step as f32 / 9.3;
        evaluator.pose(Some(take), time);
        evaluator.positions(0, 0, &mut open_points);
        evaluator.normals(0, 0, &mut open_directions);
        let size = open_points.iter().map(|point| point.abs().max_element()).fold(1.0, f32::max);
        for level in SimdLevel::all() {
            pose_character(level, &rig, &binding, &[Playing::new(&keyed, time)], &mut scratch, &mut finals);
            assert_eq!(
                skin_vertices(level, &vertices, &finals, &mut points, &mut directions),
                vertices.len()
            );
            for (at, (open, fast)) in open_points.iter().zip(&points).enumerate() {
                worst
                    .compare(fast, &open.to_array(), size, || format!("{} {time} vertex {at}", level.name()));
            }
            for (at, (open, fast)) in open_directions.iter().zip(&directions).enumerate() {
                worst.compare(fast, &open.to_array(), 1.0, || format!("{} {time} normal {at}", level.name()));
            }
        }
    }
    worst.assert(&model.name);
}

#[test]
fn vertices_of_the_fox_agree_with_the_open_path() {
    compare_pipeline(load(&data().join("gltf/Fox.glb")), 1);
}

#[test]
fn vertices_of_a_real_rig_are_where_the_open_path_has_them() {
    compare_pipeline(load(&data().join("bench/pab.glb")), 3);
}

#[test]
fn a_crowd_equals_its_single_characters_and_allocates_nothing() {
    let mut random = Random::new(12);
    let animation = made(67, &mut random);
    let rig = Rig::new(&animation.skeleton);
    let skin = dragonfly_anim::data::Skin {
        bones: (0..54).collect(),
        offsets: animation.skeleton.bones.iter().map(|bone| bone.offset).take(54).collect(),
        ..Default::default()
    };
    let binding = SkinBinding::new(&rig, &skin);
    let takes: Vec<KeyedTake> =
        animation.takes.iter().map(|take| KeyedTake::new(&animation.skeleton, take)).collect();
    let mask = LaneMask::new((0..67).map(|bone| (bone % 3) as f32 / 2.0));
    let characters: Vec<Vec<Playing<KeyedTake>>> = (0..50)
        .map(|_| {
            (0..random.below(4))
                .map(|_| Playing {
                    weight: random.choice(&[0.3, 1.0]),
                    mask: (random.below(2) == 0).then_some(&mask),
                    ..Playing::new(&takes[random.below(3)], random.between(-0.5, 1.5))
                })
                .collect()
        })
        .collect();
    for level in SimdLevel::all() {
        let mut scratch = Scratch::new(&rig);
        let mut crowd = vec![matrix::IDENTITY; 50 * 54];
        let (asked, ()) = count(|| {
            let characters = characters.iter().map(Vec::as_slice);
            pose_crowd(level, &rig, &binding, characters, &mut scratch, &mut crowd);
        });
        assert_eq!(asked.allocations, 0, "{}", level.name());
        for (layers, expected) in characters.iter().zip(crowd.chunks(54)) {
            let mut one = vec![matrix::IDENTITY; 54];
            pose_character(level, &rig, &binding, layers, &mut Scratch::new(&rig), &mut one);
            assert_eq!(one, expected, "the same, bit for bit");
        }
    }
}

#[test]
fn overflowing_numbers_have_the_same_result_as_on_the_open_path() {
    let mut random = Random::new(13);
    let mut animation = made(20, &mut random);
    let skeleton = Arc::make_mut(&mut animation.skeleton);
    for bone in &mut skeleton.bones {
        bone.rest.scale = Vec3::splat(1e20);
        bone.rest.translation = Vec3::new(f32::NAN, f32::MAX, -1e30);
    }
    let rig = Rig::new(skeleton);
    let mut open = vec![glam::Mat4::IDENTITY; 20];
    dragonfly_anim::animation::to_root(skeleton, &[], &mut open);
    for level in SimdLevel::all() {
        let mut roots = RootPoses::new(&rig);
        to_root(level, &rig, &[], &mut roots);
        for (bone, (fast, open)) in roots.matrices().zip(&open).enumerate() {
            assert!(fast.iter().all(|number| number.is_finite()), "{bone}");
            let fast = matrix::mat4(fast);
            for (fast, open) in fast.to_cols_array().into_iter().zip(open.to_cols_array()) {
                assert!(
                    (fast - open).abs() <= 1e-5 * open.abs().max(1e30),
                    "{bone}: {fast} instead of {open}"
                );
            }
        }
    }
}
