//! Written files of models that are made in code: odd names, few bones, scales, takes of every kind of key, presets.

use crate::round_trip::RoundTrip;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Image, Influence, Interpolation, Material, Mesh, MeshInstance, ModelData,
    MorphTarget, MorphTrack, Primitive, Skeleton, Skin, Take, Track, Transform, Vertices,
};
use dragonfly_fbx::code::NOT_IN_FBX;
use dragonfly_fbx::{PRESETS, preset};
use glam::{EulerRot, Mat4, Quat, Vec3};
use std::sync::Arc;

/// Returns a bone at rest in this pose.
fn bone(name: &str, parent: Option<u32>, rest: Transform) -> Bone {
    let name = name.to_owned();
    Bone { name, parent, rest, rest_matrix: None, offset: Mat4::IDENTITY, node: None }
}

fn at(x: f32, y: f32, z: f32) -> Transform {
    Transform { translation: Vec3::new(x, y, z), ..Transform::IDENTITY }
}

/// Returns a model of bones alone.
fn bones(bones: Vec<Bone>) -> ModelData {
    let animation = AnimationData { skeleton: Arc::new(Skeleton { bones }), takes: Vec::new() };
    ModelData { animation, ..ModelData::default() }
}

/// Returns a take of these tracks, one for each bone.
fn take(name: &str, tracks: Vec<Track>) -> Arc<Take> {
    let mut take = Take { name: name.to_owned(), tracks, ..Take::default() };
    for (bone, track) in take.tracks.iter_mut().enumerate() {
        track.bone = bone as u32;
    }
    let (start, end) = take.range_of_keys().unwrap_or_default();
    (take.start, take.length) = (start, end - start);
    Arc::new(take)
}

/// Returns a triangle whose corners are moved by these joints.
fn triangle(joints: [u16; 3]) -> Mesh {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let influences = joints.map(|joint| {
        let own = Influence { joint, weight: 1.0 };
        [own, Influence::default(), Influence::default(), Influence::default()]
    });
    let vertices = Vertices {
        normals: vec![Vec3::Z; 3],
        positions,
        influences: influences.concat(),
        influences_per_vertex: 4,
        ..Vertices::default()
    };
    let primitive = Primitive { vertices, indices: vec![0, 1, 2], ..Primitive::default() };
    Mesh { name: "triangle".to_owned(), primitives: vec![primitive], morph_weights: Vec::new() }
}

fn instance(bone: Option<u32>, to_bone: Mat4) -> MeshInstance {
    MeshInstance { mesh: 0, node: None, skin: None, bone, to_bone, morph_weights: Vec::new() }
}

/// Returns a model of three bones with a skin whose joints are out of order, bound in another pose than at rest.
fn skinned() -> ModelData {
    let turn = Transform { rotation: Quat::from_rotation_z(0.5), ..at(0.0, 1.0, 0.0) };
    let mut model = bones(vec![
        bone("hips", None, at(0.0, 1.0, 0.2)),
        bone("spine", Some(0), turn),
        bone("head", Some(1), at(0.0, 0.5, 0.0)),
    ]);
    let offsets = [Vec3::new(0.0, -2.5, -0.2), Vec3::new(0.0, -1.0, -0.2), Vec3::new(0.0, -2.0, -0.2)];
    let offsets = offsets.map(Mat4::from_translation).to_vec();
    model.skins.push(Skin { name: "skin".to_owned(), bones: vec![2, 0, 1], offsets });
    model.meshes.push(triangle([1, 2, 0]));
    model.instances.push(MeshInstance { skin: Some(0), ..instance(None, Mat4::IDENTITY) });
    let rotations = [Quat::IDENTITY, Quat::from_euler(EulerRot::XYZ, 1.0, 1.2, -2.0)];
    let rotation = Channel::new([0.0, 1.0], rotations, Interpolation::Linear);
    model.animation.takes =
        vec![take("Walk", vec![Track::default(), Track { rotation, ..Track::default() }, Track::default()])];
    model
}

/// Asserts that bones and vertices agree at rest and at many times of each take.
fn assert_same(trip: &mut RoundTrip, limit: f32) {
    let size = trip.size();
    let takes = trip.before.model().animation.takes.clone();
    assert_eq!(takes.len(), trip.after.model().animation.takes.len());
    for (index, take) in takes.iter().enumerate() {
        for step in 0..=40 {
            let time = take.start + take.length * step as f32 / 40.0;
            let (difference, place) = trip.bone_difference(Some(index), time, size);
            assert!(difference < limit, "{difference:e} at {place}");
            assert!(trip.vertex_difference(size) < limit, "a vertex at {time} s of take {index}");
        }
    }
    let (difference, place) = trip.bone_difference(None, 0.0, size);
    assert!(difference < limit, "{difference:e} at {place}");
}

#[test]
fn names_of_any_kind_are_kept_and_takes_of_one_name_are_numbered() {
    let names = ["Hüfte 骨", "Model::spine", "twin", "twin", "", "a|b/c\\d"];
    let list = names.iter().enumerate();
    let list =
        list.map(|(at_bone, name)| bone(name, at_bone.checked_sub(1).map(|at| at as u32), at(0.0, 0.1, 0.0)));
    let mut model = bones(list.collect());
    let takes = ["Walk", "Walk", "", "Geh::en 走"];
    model.animation.takes = takes.iter().map(|name| take(name, vec![Track::default(); 6])).collect();
    let trip = RoundTrip::of(model, None);
    let read = trip.after.model();
    let found: Vec<&str> = read.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
    assert_eq!(found, ["Hüfte 骨", "Model::spine", "twin", "twin", "bone", "a|b/c\\d"]);
    let found: Vec<&str> = read.animation.takes.iter().map(|take| take.name.as_str()).collect();
    assert_eq!(found, ["Walk", "Walk_2", "Take", "Geh::en 走"]);
    assert_eq!(trip.lost.len(), 3, "{:?}", trip.lost);
    assert!(trip.lost.iter().all(|lost| lost.code == NOT_IN_FBX));
}

#[test]
fn a_model_of_nothing_and_one_of_one_bone_can_be_written() {
    let trip = RoundTrip::of(ModelData::default(), None);
    assert!(trip.after.model().animation.skeleton.is_empty() && trip.lost.is_empty());
    let trip = RoundTrip::of(bones(vec![bone("one", None, at(1.0, 2.0, 3.0))]), None);
    let read = trip.after.model();
    assert_eq!(read.animation.skeleton.bones[0].rest.translation, Vec3::new(1.0, 2.0, 3.0));
    assert!(read.animation.takes.is_empty() && read.meshes.is_empty());
}

#[test]
fn skins_with_joints_out_of_order_and_another_bind_pose_deform_as_before() {
    assert_same(&mut RoundTrip::of(skinned(), None), 1e-4);
}

#[test]
fn scales_that_differ_by_axis_and_mirrored_ones_are_kept() {
    let scaled = Transform {
        scale: Vec3::new(2.0, 0.5, 1.5),
        rotation: Quat::from_rotation_x(0.7),
        ..at(1.0, 0.0, 0.0)
    };
    let mirrored = Transform { scale: Vec3::new(-1.0, 1.0, 1.0), ..at(0.0, 1.0, 0.0) };
    let turned = Transform { rotation: Quat::from_rotation_z(1.0), ..at(0.0, 0.5, 0.5) };
    let mut model = bones(vec![
        bone("scaled", None, scaled),
        bone("mirrored", Some(0), mirrored),
        bone("turned", Some(1), turned),
    ]);
    model.meshes.push(triangle([0; 3]));
    let sheared = Mat4::from_scale(Vec3::new(1.0, 3.0, 1.0)) * Mat4::from_rotation_z(0.6);
    model.instances = vec![
        instance(Some(2), Mat4::from_scale(Vec3::new(-2.0, 1.0, 1.0))),
        instance(Some(1), sheared),
        instance(None, Mat4::from_translation(Vec3::X)),
    ];
    let values = [Vec3::new(2.0, 0.5, 1.5), Vec3::new(1.0, 4.0, -1.0)];
    let scale = Channel::new([0.0, 2.0], values, Interpolation::Linear);
    model.animation.takes =
        vec![take("grow", vec![Track { scale, ..Track::default() }, Track::default(), Track::default()])];
    let mut trip = RoundTrip::of(model, None);
    assert_same(&mut trip, 1e-4);
    assert_eq!(trip.after.model().instances.len(), 3);
    assert!(trip.lost.is_empty(), "{:?}", trip.lost);
}

#[test]
fn instances_of_a_mesh_share_its_geometry() {
    let mut model = bones(vec![bone("a", None, at(1.0, 0.0, 0.0)), bone("b", None, at(-1.0, 0.0, 0.0))]);
    model.meshes.push(triangle([0; 3]));
    model.instances = vec![instance(Some(0), Mat4::IDENTITY), instance(Some(1), Mat4::from_rotation_y(1.0))];
    let mut trip = RoundTrip::of(model, None);
    assert_same(&mut trip, 1e-5);
    assert_eq!((trip.after.model().meshes.len(), trip.after.model().instances.len()), (1, 2));
}

/// Returns a model whose take has every kind of key, and far rotations.
fn every_key() -> ModelData {
    let kinds =
        [Interpolation::Step, Interpolation::Linear, Interpolation::Closest, Interpolation::CubicSpline];
    let mut model =
        bones(kinds.iter().map(|kind| bone(&format!("{kind:?}"), None, at(0.0, 1.0, 0.0))).collect());
    let times = [0.5_f32, 1.0, 2.25];
    let turns = [
        Quat::from_euler(EulerRot::XYZ, 0.1, 0.2, 0.3),
        Quat::from_euler(EulerRot::YXZ, 2.0, -1.5, 1.0),
        Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
    ];
    let moves = [Vec3::ZERO, Vec3::new(1.0, -0.5, 0.25), Vec3::new(-1.0, 0.0, 2.0)];
    let tracks = kinds.iter().map(|&kind| {
        let is_spline = kind == Interpolation::CubicSpline;
        let rotations: Vec<Quat> = match is_spline {
            true => turns
                .iter()
                .flat_map(|&turn| {
                    [Quat::from_xyzw(0.1, 0.3, -0.2, 0.0), turn, Quat::from_xyzw(0.4, -0.1, 0.2, 0.1)]
                })
                .collect(),
            false => turns.to_vec(),
        };
        let translations: Vec<Vec3> = match is_spline {
            true => moves
                .iter()
                .flat_map(|&value| [Vec3::new(1.0, 2.0, 0.0), value, Vec3::new(-3.0, 0.0, 1.0)])
                .collect(),
            false => moves.to_vec(),
        };
        let rotation = Channel::new(times, rotations, kind);
        Track { rotation, translation: Channel::new(times, translations, kind), ..Track::default() }
    });
    model.animation.takes = vec![take("all", tracks.collect())];
    model
}

#[test]
fn every_kind_of_key_is_followed_and_splines_of_positions_keep_their_keys() {
    let mut trip = RoundTrip::of(every_key(), None);
    let size = 2.0;
    for step in 0..200 {
        let time = 0.5 + 1.75 * (step as f32 + 0.5) / 200.0;
        let (difference, place) = trip.bone_difference(Some(0), time, size);
        assert!(difference < 1e-3, "{difference:e} at {place}");
    }
    let tracks = &trip.after.model().animation.takes[0].tracks;
    let kinds = tracks.iter().map(|track| (track.translation.interpolation, track.translation.len()));
    let (step, linear, cubic) = (Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline);
    assert_eq!(kinds.collect::<Vec<_>>(), [(step, 3), (linear, 3), (step, 4), (cubic, 3)]);
    assert!(trip.loses("half way between") && trip.lost.len() == 1, "{:?}", trip.lost);
}

#[test]
fn shapes_are_kept_with_their_weights_over_time() {
    let mut model = bones(vec![bone("a", None, at(0.0, 0.0, 0.0))]);
    let mut mesh = triangle([0; 3]);
    let target = |name: &str, offset: Vec3| MorphTarget {
        name: name.to_owned(),
        positions: vec![Vec3::ZERO, offset, Vec3::ZERO],
        ..MorphTarget::default()
    };
    mesh.primitives[0].morph_targets =
        vec![target("smile", Vec3::X), target("smile", Vec3::Z), target("", Vec3::Y)];
    mesh.morph_weights = vec![0.0, 0.25, 0.0];
    model.meshes.push(mesh);
    let placed = instance(Some(0), Mat4::IDENTITY);
    model.instances = vec![
        MeshInstance { morph_weights: vec![0.0, 0.25, 0.0], ..placed.clone() },
        MeshInstance { morph_weights: vec![0.5, 0.0, 0.0], ..placed },
    ];
    let weights = vec![0.0, 0.25, 1.0, 1.0, 0.0, 0.5];
    let morph = MorphTrack {
        instance: 1,
        targets: 3,
        times: vec![0.0, 1.0].into(),
        weights: weights.into(),
        interpolation: Interpolation::Linear,
    };
    let track = Track::default();
    model.animation.takes = vec![Arc::new(Take {
        name: "talk".to_owned(),
        start: 0.0,
        length: 1.0,
        tracks: vec![track],
        morphs: vec![morph],
        ..Take::default()
    })];
    let mut trip = RoundTrip::of(model, None);
    assert_same(&mut trip, 1e-4);
    let names: Vec<&str> = trip.after.model().meshes[0].primitives[0]
        .morph_targets
        .iter()
        .map(|target| target.name.as_str())
        .collect();
    assert_eq!(names, ["smile", "smile_2", "shape 2"]);
    assert_eq!(trip.lost.iter().filter(|lost| lost.text.contains("is called")).count(), 2);
    assert_eq!(trip.after.model().meshes.len(), 2, "weights belong to a geometry");
}

#[test]
fn what_a_file_does_not_contain_is_listed() {
    let mut model = skinned();
    model.materials.push(Material { double_sided: true, unlit: true, ..Material::default() });
    model.images.push(Image { name: "missing".to_owned(), ..Image::default() });
    model.meshes[0].primitives[0].material = Some(0);
    let mut with_events = Take::clone(&model.animation.takes[0]);
    with_events.extras.set("events", Some("[]".into()));
    model.animation.takes = vec![Arc::new(with_events)];
    let trip = RoundTrip::of(model, None);
    for words in ["metallic", "both sides", "not lit", "no bytes", "events are not stored"] {
        assert!(trip.loses(words), "{words}: {:?}", trip.lost);
    }
    assert_eq!(trip.lost.len(), 5, "{:?}", trip.lost);
}

#[test]
fn presets_state_their_units_and_axes_and_keep_the_motion() {
    let expected = [
        ("unity", "1 unit = 0.01 m (file), Y up (file), right-handed (file)"),
        ("unreal", "1 unit = 0.01 m (file), Z up (file), right-handed (file)"),
        ("maya", "1 unit = 0.01 m (file), Y up (file), right-handed (file)"),
        ("blender", "1 unit = 1 m (file), Z up (file), right-handed (file)"),
    ];
    assert_eq!(PRESETS.len(), expected.len());
    for (name, conventions) in expected {
        let preset = preset(name).expect("a preset");
        assert!(!preset.title().is_empty() && !preset.explanation().is_empty());
        let mut trip = RoundTrip::of(skinned(), Some(preset));
        assert_eq!(trip.conventions, conventions, "{name}");
        let size = trip.size();
        let read = trip.after.model().clone();
        for step in 0..=24 {
            // Frames at which the preset of an engine has keys.
            let time = step as f32 / 24.0;
            trip.before.pose(Some(0), time);
            trip.after.pose(Some(0), time);
            let (before, after) = (trip.before.all_positions(), trip.after.all_positions());
            for (a, b) in before.iter().zip(&after) {
                assert!(a.distance(*b) < 1e-3 * size, "{name} at {time} s: {a} and {b}");
            }
        }
        let names: Vec<&str> = read.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
        match name {
            "unreal" => assert_eq!(names, ["root", "hips", "spine", "head"]),
            _ => assert_eq!(names, ["hips", "spine", "head"]),
        }
        assert_eq!(trip.loses("rests in its bind pose"), name == "unity");
        assert_eq!(trip.loses("keys at every frame"), name == "unreal");
        let spine = &read.animation.skeleton.bones.iter().find(|bone| bone.name == "spine").unwrap().rest;
        let is_bound = spine.rotation.angle_between(Quat::IDENTITY) < 1e-4;
        assert_eq!(is_bound, name == "unity", "{name}: {spine:?}");
    }
    assert!(preset("cinema").is_none());
}

#[test]
fn the_unreal_preset_leaves_no_scale_on_bones_and_every_vertex_where_it_was() {
    let mut model = skinned();
    let mut skeleton = Skeleton::clone(&model.animation.skeleton);
    skeleton.bones[0].rest.scale = Vec3::splat(0.01);
    model.animation.skeleton = Arc::new(skeleton);
    for offset in &mut model.skins[0].offsets {
        *offset = Mat4::from_scale(Vec3::splat(100.0)) * *offset;
    }
    model.instances.push(instance(Some(2), Mat4::from_scale(Vec3::splat(20.0))));
    let mut trip = RoundTrip::of(model, preset("unreal"));
    for bone in &trip.after.model().animation.skeleton.bones {
        assert!((bone.rest.scale - Vec3::ONE).length() < 1e-6, "{}: {}", bone.name, bone.rest.scale);
    }
    for frame in 0..=24 {
        trip.before.pose(Some(0), frame as f32 / 24.0);
        trip.after.pose(Some(0), frame as f32 / 24.0);
        let mut after = trip.after.all_positions();
        for position in trip.before.all_positions() {
            let nearest = after
                .iter()
                .enumerate()
                .min_by(|a, b| a.1.distance(position).total_cmp(&b.1.distance(position)));
            let (index, found) = nearest.map(|(index, found)| (index, *found)).expect("as many vertices");
            assert!(found.distance(position) < 1e-3, "frame {frame}: {position} and {found}");
            after.swap_remove(index);
        }
    }
}

#[test]
fn the_blender_preset_has_lines_only() {
    let mut trip = RoundTrip::of(every_key(), preset("blender"));
    let scene = ufbx::load_memory(&trip.bytes, ufbx::LoadOpts::default()).expect("a good file");
    let keys: Vec<&ufbx::Keyframe> =
        scene.anim_curves.into_iter().flat_map(|curve| &curve.keyframes).collect();
    let is_linear = |key: &&ufbx::Keyframe| key.interpolation == ufbx::Interpolation::Linear;
    assert!(keys.len() > 100 && keys.iter().all(is_linear));
    let (difference, place) = trip.bone_difference(Some(0), 1.3, 2.0);
    assert!(difference < 1e-3, "{difference:e} at {place}");
}
