//! The device morphs and skins as the processor does: the image of a moving model equals that of a static copy whose
//! vertices the processor has moved.

use dragonfly_anim::data::*;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::skin::skin_tangents;
use dragonfly_document::{Cancel, DecodedImage, LoadedModel, Source, load_model};
use dragonfly_kit::document::made;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{PictureSettings, Shading, Studio};
use glam::{Mat4, Quat, Vec3, Vec4};
use image::RgbaImage;
use std::sync::Arc;

/// Returns a copy of `model` in the pose of its first take at `time`: only vertices, in scene space.
fn baked(model: &Arc<ModelData>, time: f32) -> ModelData {
    let mut evaluator = Evaluator::new(Arc::clone(model));
    evaluator.pose(Some(0), time);
    let mut meshes = Vec::new();
    for (index, instance) in model.instances.iter().enumerate() {
        let mut mesh = model.meshes[instance.mesh as usize].clone();
        for (number, primitive) in mesh.primitives.iter_mut().enumerate() {
            let movement = evaluator.movement(index, number).unwrap();
            let mut vertices = primitive.vertices.clone();
            evaluator.positions(index, number, &mut vertices.positions);
            evaluator.normals(index, number, &mut vertices.normals);
            skin_tangents(primitive, movement, evaluator.morph_weights(index), &mut vertices.tangents);
            (vertices.influences, vertices.influences_per_vertex) = (Vec::new(), 0);
            // A mirrored triangle has the opposite winding.
            if movement.matrix(primitive, 0).determinant() < 0.0 {
                primitive.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
            }
            primitive.vertices = vertices;
            primitive.morph_targets.clear();
        }
        mesh.morph_weights.clear();
        meshes.push(mesh);
    }
    ModelData {
        instances: (0..meshes.len() as u32).map(|mesh| made::instance(mesh, None, None)).collect(),
        meshes,
        materials: model.materials.clone(),
        images: model.images.clone(),
        ..ModelData::default()
    }
}

/// Returns `model` as loaded, with the pixels of `like` and these bounds.
fn shown(model: Arc<ModelData>, like: &LoadedModel, bounds: &Arc<ModelData>) -> Arc<LoadedModel> {
    Arc::new(LoadedModel {
        conversion: Default::default(),
        title: like.title.clone(),
        path: None,
        format: like.format,
        model,
        bounds: Evaluator::new(Arc::clone(bounds)).bounds(),
        images: like.images.clone(),
        warnings: Vec::new(),
        notes: Vec::new(),
    })
}

/// Returns the number of pixels that differ by more than rounding.
fn unlike(a: &RgbaImage, b: &RgbaImage) -> usize {
    let far = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| (0..4).any(|i| a[i].abs_diff(b[i]) > 8);
    a.pixels().zip(b.pixels()).filter(|(a, b)| far(a, b)).count()
}

/// Draws `loaded` at `time` of its first take, and its baked copy, from two sides with two looks, and compares the
/// images.
fn check(studio: &mut Studio, loaded: &LoadedModel, time: f32) {
    let copy = Arc::new(baked(&loaded.model, time));
    let moving = shown(Arc::clone(&loaded.model), loaded, &copy);
    let still = shown(Arc::clone(&copy), loaded, &copy);
    for (yaw, shading) in [(0.5, Shading::Material), (3.4, Shading::Clay)] {
        let base = PictureSettings {
            size: [200, 150],
            yaw,
            grid: false,
            ..dragonfly_kit::picture::images::settings()
        };
        let base = PictureSettings { background: Some([0; 4]), ..base };
        let camera = Some(studio.camera(&still, &base));
        let mut draw = |loaded, take, time| {
            let look = dragonfly_picture::Look { shading, ..base.look.clone() };
            studio.render(loaded, &PictureSettings { take, time, camera, look, ..base.clone() }).unwrap()
        };
        let rest = draw(&moving, None, 0.0);
        let (device, processor) = (draw(&moving, Some(0), time), draw(&still, None, 0.0));
        let seen = processor.pixels().filter(|pixel| pixel[3] > 0).count();
        assert!(seen > 1500, "only {seen} pixels show the model");
        assert!(unlike(&rest, &device) > 150, "it hardly moves: {} pixels", unlike(&rest, &device));
        let wrong = unlike(&device, &processor);
        assert!(wrong * 200 < seen, "{wrong} of {seen} pixels differ, {shading:?} seen from {yaw}");
    }
    assert_eq!(studio.stage().device().errors(), 0);
}

fn open(source: &Source) -> LoadedModel {
    load_model(source, &mut |_| {}, &Cancel::default()).unwrap()
}

/// Returns a red material with a normal map that tilts every normal to the upper right.
fn tilted() -> (Vec<Material>, Vec<DecodedImage>) {
    let map = TextureRef {
        image: 0,
        set: 0,
        wrap: [Wrap::Repeat; 2],
        magnify: Filter::Linear,
        minify: Filter::Linear,
        mip: false,
        transform: TextureTransform::IDENTITY,
    };
    let image = DecodedImage { width: 1, height: 1, pixels: vec![192, 204, 217, 255] };
    let red = made::paint(Vec4::new(0.8, 0.25, 0.1, 1.0));
    (vec![Material { normal_texture: Some(map), ..red }], vec![image])
}

/// Returns a ball carried by a bone that moves from rest to `end`.
fn carried(end: Transform) -> ModelData {
    let (materials, _) = tilted();
    ModelData {
        instances: vec![made::instance(0, None, Some(0))],
        animation: made::chain(1, Vec3::ZERO, |_| end),
        ..made::standing(vec![made::ball()], materials)
    }
}

/// Returns a ball stretched to a column with `count` bones inside, all of which influence each vertex.
fn column(count: usize, end: impl Fn(u32) -> Transform) -> ModelData {
    let mut ball = made::ball();
    let vertices = &mut ball.vertices;
    let top = (count - 1) as f32;
    vertices.influences_per_vertex = count;
    for position in &mut vertices.positions {
        position.y = (position.y + 1.0) * 0.5 * top;
        let share = |bone: usize| 1.0 / (0.5 + (bone as f32 - position.y).powi(2));
        let sum: f32 = (0..count).map(share).sum();
        let mut all: Vec<Influence> =
            (0..count).map(|bone| Influence { joint: bone as u16, weight: share(bone) / sum }).collect();
        all.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        vertices.influences.extend(all);
    }
    let (materials, _) = tilted();
    let animation = made::chain(count as u32, Vec3::Y, end);
    let skin = Skin {
        name: String::new(),
        bones: (0..count as u32).collect(),
        offsets: animation.skeleton.bones.iter().map(|bone| bone.offset).collect(),
    };
    ModelData {
        instances: vec![made::instance(0, Some(0), None)],
        skins: vec![skin],
        animation,
        ..made::standing(vec![ball], materials)
    }
}

fn check_made(model: ModelData) {
    let Some(mut studio) = studio::studio() else { return };
    check(&mut studio, &made::loaded(model, tilted().1), 0.8);
}

#[test]
fn the_device_skins_the_built_in_dragonfly_like_the_processor() {
    let Some(mut studio) = studio::studio() else { return };
    let mut loaded = open(&Source::BuiltIn);
    // The comparison uses the first take, so the requested take is moved there.
    let mut model = ModelData::clone(&loaded.model);
    let cruise = model.animation.takes.iter().position(|take| take.name.eq_ignore_ascii_case("cruise"));
    model.animation.takes.swap(0, cruise.expect("a take called cruise"));
    loaded.model = Arc::new(model);
    let take = &loaded.model.animation.takes[0];
    let time = take.start + take.length * 0.37;
    check(&mut studio, &loaded, time);
}

#[test]
fn four_bones_can_influence_a_vertex() {
    check_made(column(4, |_| Transform { rotation: Quat::from_rotation_z(0.5), ..Transform::IDENTITY }));
}

#[test]
fn eight_bones_can_influence_a_vertex() {
    check_made(column(8, |_| Transform { rotation: Quat::from_rotation_z(0.25), ..Transform::IDENTITY }));
}

#[test]
fn scaled_bones_keep_the_shading_correct() {
    check_made(column(4, |bone| Transform {
        scale: if bone % 2 == 0 { Vec3::new(2.5, 1.0, 0.6) } else { Vec3::new(0.2, 1.0, 1.5) },
        ..Transform::IDENTITY
    }));
}

#[test]
fn the_device_morphs_the_sample_cube_like_the_processor() {
    let Some(mut studio) = studio::studio() else { return };
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/gltf/AnimatedMorphCube.glb");
    let loaded = open(&Source::File(folder.into()));
    let take = &loaded.model.animation.takes[0];
    check(&mut studio, &loaded, take.start + take.length * 0.4);
}

#[test]
fn morph_targets_move_positions_normals_and_tangents() {
    let mut model = carried(Transform { rotation: Quat::from_rotation_y(0.7), ..Transform::IDENTITY });
    let ball = &mut model.meshes[0].primitives[0];
    let target = |to: Mat4| {
        let moved = |column: &[Vec3]| column.iter().map(|&at| to.transform_vector3(at) - at).collect();
        let tangents: Vec<Vec3> = ball.vertices.tangents.iter().map(|tangent| tangent.truncate()).collect();
        MorphTarget {
            name: String::new(),
            positions: moved(&ball.vertices.positions),
            normals: moved(&ball.vertices.normals),
            tangents: moved(&tangents),
        }
    };
    ball.morph_targets = vec![
        target(Mat4::from_scale(Vec3::new(1.0, 3.0, 1.0))),
        target(Mat4::from_rotation_x(1.0)),
        target(Mat4::from_scale(Vec3::new(0.1, 1.0, 1.0))),
    ];
    model.instances[0].morph_weights = vec![0.0; 3];
    let mut take = Take::clone(&model.animation.takes[0]);
    take.morphs.push(MorphTrack {
        instance: 0,
        targets: 3,
        times: vec![0.0, 1.0].into(),
        weights: vec![0.0, 0.0, 0.0, 0.5, 0.8, 0.0].into(),
        interpolation: Interpolation::Linear,
    });
    model.animation.takes = vec![Arc::new(take)];
    check_made(model);
}

#[test]
fn a_bone_carries_a_rigid_mesh() {
    check_made(carried(Transform {
        translation: Vec3::new(2.0, 1.0, -1.0),
        rotation: Quat::from_rotation_x(0.9),
        scale: Vec3::splat(1.5),
    }));
}

#[test]
fn a_mirrored_bone_flips_winding_and_normals() {
    check_made(carried(Transform {
        rotation: Quat::from_rotation_z(0.4),
        scale: Vec3::new(-2.0, 1.0, 1.0),
        ..Transform::IDENTITY
    }));
}

#[test]
fn mirrored_joints_flip_winding_and_normals() {
    check_made(column(4, |bone| Transform {
        rotation: Quat::from_rotation_z(0.2),
        scale: if bone == 0 { Vec3::new(1.0, 1.0, -2.0) } else { Vec3::ONE },
        ..Transform::IDENTITY
    }));
}

#[test]
fn every_instance_has_its_own_matrices_and_weights() {
    let mut model = column(4, |_| Transform { rotation: Quat::from_rotation_z(0.4), ..Transform::IDENTITY });
    let mut ball = made::ball();
    let squeezed = |positions: &[Vec3]| positions.iter().map(|&at| at * Vec3::new(0.0, -0.8, 0.0)).collect();
    ball.morph_targets =
        vec![MorphTarget { positions: squeezed(&ball.vertices.positions), ..MorphTarget::default() }];
    model.meshes.push(made::mesh(ball));
    for (bone, side, weight) in [(1, 2.5, 0.9), (3, -2.5, 0.3)] {
        model.instances.push(MeshInstance {
            to_bone: Mat4::from_translation(Vec3::X * side),
            morph_weights: vec![weight],
            ..made::instance(1, None, Some(bone))
        });
    }
    // The same column again, bound at other positions.
    let offsets = model.skins[0].offsets.iter().map(|&offset| offset * Mat4::from_translation(Vec3::Z * 3.0));
    model.skins.push(Skin { offsets: offsets.collect(), ..model.skins[0].clone() });
    model.instances.push(made::instance(0, Some(1), None));
    check_made(model);
}

#[test]
fn unequal_scales_tilt_normals_like_on_the_processor() {
    check_made(carried(Transform {
        rotation: Quat::from_rotation_z(0.6),
        scale: Vec3::new(3.0, 0.4, 1.0),
        ..Transform::IDENTITY
    }));
}

#[test]
fn a_mesh_in_tiny_units_is_lit() {
    let mut model = carried(Transform { rotation: Quat::from_rotation_z(0.9), ..Transform::IDENTITY });
    let unit = 1e-7;
    for position in &mut model.meshes[0].primitives[0].vertices.positions {
        *position = *position * Vec3::new(1.0, 2.0, 1.0) / unit;
    }
    model.instances[0].to_bone = Mat4::from_scale(Vec3::splat(unit));
    check_made(model);
}

#[test]
fn a_normal_map_tilts_the_same_way_with_and_without_tangents() {
    let Some(mut studio) = studio::studio() else { return };
    let (materials, images) = tilted();
    let material = Material { double_sided: true, ..materials[0].clone() };
    let plain = Material { normal_texture: None, ..material.clone() };
    let texel = Vec3::new(192.0, 204.0, 217.0) / 127.5 - 1.0;
    let mut with = made::sheet();
    with.vertices.tangents = vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4];
    let mut turned = made::sheet();
    turned.vertices.normals = vec![texel.normalize(); 4];
    for yaw in [0.0, 0.8, 3.5] {
        let settings = PictureSettings {
            yaw,
            grid: false,
            background: Some([0; 4]),
            ..dragonfly_kit::picture::images::settings()
        };
        let mut draw = |sheet: &Primitive, material: &Material| {
            let model = made::standing(vec![sheet.clone()], vec![material.clone()]);
            studio.render(&made::loaded(model, images.clone()), &settings).unwrap()
        };
        let expected = draw(&turned, &plain);
        let [flat, with, without] =
            [draw(&made::sheet(), &plain), draw(&with, &material), draw(&made::sheet(), &material)];
        assert!(unlike(&expected, &flat) > 500, "from {yaw}: the tilt cannot be seen");
        assert!(unlike(&expected, &with) < 20, "from {yaw}: {} with tangents", unlike(&expected, &with));
        assert!(unlike(&expected, &without) < 20, "from {yaw}: {} without", unlike(&expected, &without));
    }
    assert_eq!(studio.stage().device().errors(), 0);
}
