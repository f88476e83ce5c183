//! Damaged models are explained with the values that are played.

use crate::explain::{made, vertex_of};
use dragonfly_anim::data::{ModelData, Take, Transform};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::explain::{ExplainError, ExplainTarget, Explanation, explain};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Damages a model in one way.
type Damage = fn(&mut ModelData);

/// Every reference that can be missing, and every number that can be invalid.
const DAMAGES: &[(&str, Damage)] = &[
    ("a take with too few tracks", |model| change_take(model, |take| take.tracks.truncate(1))),
    ("no tracks", |model| change_take(model, |take| take.tracks.clear())),
    ("fewer values than times", |model| {
        change_take(model, |take| take.tracks[0].rotation.values = [Quat::from_rotation_x(1.0)].into());
    }),
    ("values without times", |model| {
        change_take(model, |take| take.tracks[0].translation.times = [].into());
    }),
    ("times that are no numbers", |model| {
        change_take(model, |take| {
            take.tracks[0].rotation.times = [f32::NAN, f32::INFINITY, -1.0].into();
        });
    }),
    ("values that are no numbers", |model| {
        change_take(model, |take| {
            take.tracks[0].rotation.values = [Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0); 3].into();
            take.tracks[0].translation.values = [Vec3::splat(f32::INFINITY); 6].into();
            take.tracks[1].translation.values = [Vec3::NAN; 2].into();
        });
    }),
    ("more morph weights than targets", |model| change_take(model, |take| take.morphs[0].targets = 9)),
    ("morph weights that are no numbers", |model| {
        change_take(model, |take| take.morphs[0].weights = [f32::NAN, f32::INFINITY].into());
    }),
    ("a morph target without positions", |model| {
        model.meshes[0].primitives[0].morph_targets[0].positions.clear();
    }),
    ("a skin with too few bones", |model| model.skins[0].bones.truncate(1)),
    ("a skin with a bone that is not there", |model| model.skins[0].bones[1] = 99),
    ("a skin without offsets", |model| model.skins[0].offsets.clear()),
    ("offsets that are no numbers", |model| model.skins[0].offsets.fill(Mat4::NAN)),
    ("no skin", |model| model.skins.clear()),
    ("an influence of no joint", |model| {
        model.meshes[0].primitives[0].vertices.influences[0].joint = 99;
    }),
    ("no influences", |model| model.meshes[0].primitives[0].vertices.influences.clear()),
    ("a weight that is no number", |model| {
        model.meshes[0].primitives[0].vertices.influences[0].weight = f32::NAN;
    }),
    ("positions that are no numbers", |model| {
        model.meshes[0].primitives[0].vertices.positions.fill(Vec3::NAN);
    }),
    ("normals that are no numbers", |model| {
        model.meshes[0].primitives[0].vertices.normals.fill(Vec3::ZERO);
    }),
    ("a carrier that is not there", |model| model.instances[1].bone = Some(99)),
    ("a parent below its child", |model| {
        let bones = &mut Arc::make_mut(&mut model.animation.skeleton).bones;
        bones[0].parent = Some(1);
    }),
    ("a parent that is not there", |model| {
        let bones = &mut Arc::make_mut(&mut model.animation.skeleton).bones;
        bones[1].parent = Some(99);
    }),
    ("a bone that is its own parent", |model| {
        let bones = &mut Arc::make_mut(&mut model.animation.skeleton).bones;
        bones[1].parent = Some(1);
    }),
    ("a rest that is no number", |model| {
        let bones = &mut Arc::make_mut(&mut model.animation.skeleton).bones;
        bones[1].rest = Transform { translation: Vec3::NAN, ..Transform::IDENTITY };
    }),
];

fn change_take(model: &mut ModelData, change: impl FnOnce(&mut Take)) {
    let mut take = (*model.animation.takes[0]).clone();
    change(&mut take);
    model.animation.takes[0] = Arc::new(take);
}

/// Checks the bones of an explanation: finite numbers, parents before children, each bone once, and the played values.
fn check_sound(explanation: &Explanation, damage: &str) {
    for (number, step) in explanation.bones.iter().enumerate() {
        assert!(step.to_root.is_finite() && step.to_parent.is_finite() && step.pose.is_finite(), "{damage}");
        assert!(step.translation.value.is_finite() && step.rotation.value.is_finite(), "{damage}");
        for keys in [&step.translation.keys, &step.scale.keys].into_iter().flatten() {
            let tangents = [keys.before.tangent, keys.after.tangent];
            assert!(tangents.into_iter().flatten().all(Vec3::is_finite), "{damage}");
            assert!(keys.before.value.is_finite() && keys.after.value.is_finite(), "{damage}");
        }
        if let Some(keys) = &step.rotation.keys {
            assert!(keys.before.value.is_finite() && keys.after.value.is_finite(), "{damage}");
        }
        let above = explanation.bones[..number].iter();
        assert!(above.clone().all(|above| above.bone < step.bone), "{damage}: {:?}", step.bone);
        let explained = step.parent.is_none_or(|parent| above.clone().any(|above| above.bone == parent));
        assert!(explained, "{damage}: the parent of bone {} does not come before it", step.bone);
    }
    assert!(!explanation.to_string().is_empty());
}

#[test]
fn damaged_models_are_explained_without_a_panic() {
    for (damage, change) in DAMAGES {
        let mut model = (*made()).clone();
        change(&mut model);
        let model = Arc::new(model);
        let mut evaluator = Evaluator::new(Arc::clone(&model));
        for time in [f32::NAN, f32::NEG_INFINITY, 0.5, 1.5, f32::MAX] {
            evaluator.pose(Some(0), time);
            for bone in 0..2 {
                let explanation = explain(&model, Some(0), time, ExplainTarget::Bone(bone)).unwrap();
                check_sound(&explanation, damage);
                let to_root = explanation.bone(bone).unwrap().to_root;
                assert_eq!(to_root, evaluator.to_root()[bone as usize], "{damage}");
            }
            for instance in 0..3 {
                let what = ExplainTarget::Vertex { instance, primitive: 0, vertex: 0 };
                let explanation = explain(&model, Some(0), time, what).unwrap();
                check_sound(&explanation, damage);
                let mut played = [Vec3::ZERO];
                evaluator.positions(instance as usize, 0, &mut played);
                let explained = vertex_of(&explanation).final_position;
                assert!(
                    explained == played[0] || explained.is_nan() && played[0].is_nan(),
                    "{damage}: {explained} {played:?}"
                );
            }
        }
    }
}

#[test]
fn an_instance_of_no_mesh_has_no_primitives() {
    let mut model = (*made()).clone();
    model.instances[0].mesh = 99;
    let error = explain(&model, None, 0.0, ExplainTarget::Vertex { instance: 0, primitive: 0, vertex: 0 })
        .unwrap_err();
    assert_eq!(error, ExplainError::NoPrimitive { instance: 0, primitive: 0, primitives: 0 });
}
