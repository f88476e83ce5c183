//! Instances of a mesh that share a draw call look as copies of the mesh do that are drawn one by one.

use dragonfly_anim::data::*;
use dragonfly_kit::document::{arm, made};
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::camera::{Camera, Projection};
use dragonfly_picture::{PictureSettings, Studio};
use glam::{Mat4, Quat, Vec3, Vec4};

/// Returns the model with a mesh of its own for each instance.
fn copied(model: &ModelData) -> ModelData {
    let mut copy = model.clone();
    copy.meshes =
        copy.instances.iter().map(|instance| model.meshes[instance.mesh as usize].clone()).collect();
    copy.instances.iter_mut().zip(0..).for_each(|(instance, mesh)| instance.mesh = mesh);
    copy
}

/// Checks that instances of `model` look as copies do, and returns the numbers of draw calls of both.
fn same(studio: &mut Studio, model: &ModelData, settings: &PictureSettings) -> [usize; 2] {
    let [(shared, draws), (own, more)] = [model.clone(), copied(model)].map(|model| {
        let picture = studio.render(&made::loaded(model, Vec::new()), settings).unwrap();
        (picture, studio.stage().draw_calls())
    });
    let first = *shared.get_pixel(0, 0);
    assert!(shared.pixels().filter(|&&pixel| pixel != first).count() > 500, "something is seen");
    assert_eq!(difference(&shared, &own), 0);
    [draws, more]
}

fn settings() -> PictureSettings {
    PictureSettings { size: [320, 240], grid: false, background: Some([0; 4]), ..PictureSettings::default() }
}

/// Returns nine instances of a ball; every second is mirrored.
fn balls(material: Material) -> ModelData {
    let mut model = made::standing(vec![made::ball()], vec![material]);
    model.instances = (0..9)
        .map(|index| {
            let at = Vec3::new((index % 3) as f32 * 1.5, (index / 3) as f32 * 1.5, (index * 7 % 9) as f32);
            let scale = if index % 2 == 0 { Vec3::ONE } else { Vec3::new(-1.0, 1.2, 0.8) };
            let to_bone = Mat4::from_scale_rotation_translation(scale, Quat::from_rotation_y(0.3), at);
            MeshInstance { to_bone, ..made::instance(0, None, None) }
        })
        .collect();
    model
}

#[test]
fn solid_instances_look_as_copies_do_also_where_some_are_mirrored() {
    let Some(mut studio) = studio::studio() else { return };
    let red = made::paint(Vec4::new(0.8, 0.2, 0.1, 0.5));
    assert_eq!(same(&mut studio, &balls(red.clone()), &settings()), [2, 9]);
    let mask = Material { alpha_mode: AlphaMode::Mask(0.4), double_sided: true, ..red };
    assert_eq!(same(&mut studio, &balls(mask), &settings()), [2, 9]);
}

#[test]
fn blended_instances_keep_their_order_from_back_to_front() {
    let Some(mut studio) = studio::studio() else { return };
    let glass = Material { alpha_mode: AlphaMode::Blend, ..made::paint(Vec4::new(0.2, 0.5, 0.8, 0.5)) };
    let mut model = balls(glass.clone());
    // Another color between them.
    let other = Material { base_color: Vec4::new(0.9, 0.2, 0.1, 0.6), ..glass.clone() };
    model.materials.push(other);
    model.meshes.push(made::mesh(Primitive { material: Some(1), ..made::ball() }));
    model.instances.iter_mut().skip(4).step_by(3).for_each(|instance| instance.mesh = 1);
    for yaw in [0.0, 1.2, 3.0] {
        let [draws, more] = same(&mut studio, &model, &PictureSettings { yaw, ..settings() });
        assert!(draws <= 9 && more == 9, "{draws}");
    }
    model.instances.iter_mut().for_each(|instance| instance.to_bone *= Mat4::from_scale(Vec3::splat(0.9)));
    model.materials.iter_mut().for_each(|material| material.double_sided = true);
    assert_eq!(same(&mut studio, &model, &settings()), [18, 18], "the far side of each before its near side");
}

#[test]
fn skinned_and_morphed_instances_look_as_copies_do() {
    let Some(mut studio) = studio::studio() else { return };
    let model = ModelData::clone(&arm::loaded().model);
    let mut many = model.clone();
    for index in 1..4 {
        // The same skin, and one with other offsets.
        for instance in &model.instances {
            let skin = instance.skin.map(|skin| {
                let mut other = model.skins[skin as usize].clone();
                let aside = Mat4::from_translation(Vec3::X * index as f32);
                other.offsets = other.offsets.iter().map(|&offset| offset * aside).collect();
                many.skins.push(other);
                many.skins.len() as u32 - 1
            });
            many.instances.push(MeshInstance { skin, ..instance.clone() });
        }
    }
    let time = arm::LENGTH * 0.4;
    let draws = same(&mut studio, &many, &PictureSettings { time, ..settings() });
    assert_eq!(draws, [1 + 4 * 2, 4 * (1 + 2)], "the tube once; both sides of each pane, which is blended");

    let mut ball = made::ball();
    let up = ball.vertices.positions.iter().map(|at| Vec3::Y * at.x).collect();
    ball.morph_targets = vec![MorphTarget { positions: up, ..MorphTarget::default() }];
    let mut model = made::standing(vec![ball], vec![made::paint(Vec4::ONE)]);
    model.instances = (0..4)
        .map(|index| MeshInstance {
            to_bone: Mat4::from_translation(Vec3::X * 2.5 * index as f32),
            morph_weights: vec![index as f32 * 0.5],
            ..made::instance(0, None, None)
        })
        .collect();
    assert_eq!(same(&mut studio, &model, &settings()), [1, 4]);
}

/// Balls at whole numbers are the same in one mesh, which is never outside of the view.
#[test]
fn leaving_out_what_is_outside_the_view_changes_no_pixel() {
    let Some(mut studio) = studio::studio() else { return };
    let places: Vec<Vec3> = (0..125u8)
        .map(|index| Vec3::new(f32::from(index % 5), f32::from(index / 5 % 5), f32::from(index / 25)) * 4.0)
        .collect();
    let mut corner = made::sheet();
    corner.vertices.positions.truncate(3);
    corner.indices = vec![0, 1, 2, 0, 2, 1];
    let mut one = Primitive { vertices: Vertices::default(), indices: Vec::new(), ..corner.clone() };
    for place in &places {
        let first = one.vertices.len() as u32;
        one.vertices.positions.extend(corner.vertices.positions.iter().map(|&at| at + *place));
        one.vertices.normals.extend([Vec3::Z; 3]);
        one.indices.extend(corner.indices.iter().map(|index| first + index));
    }
    corner.vertices =
        Vertices { positions: corner.vertices.positions, normals: vec![Vec3::Z; 3], ..Vertices::default() };
    let paint = made::paint(Vec4::new(0.8, 0.5, 0.1, 1.0));
    let mut model = made::standing(vec![corner], vec![paint.clone()]);
    model.instances = places
        .iter()
        .map(|&place| MeshInstance {
            to_bone: Mat4::from_translation(place),
            ..made::instance(0, None, None)
        })
        .collect();
    let whole = made::loaded(made::standing(vec![one], vec![paint]), Vec::new());
    let model = made::loaded(model, Vec::new());
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for index in 0..12 {
            let camera = Camera {
                projection,
                target: places[index * 10],
                distance: 3.0 + index as f32,
                yaw: index as f32 * 0.7,
                pitch: index as f32 * 0.3 - 1.5,
                ..Camera::default()
            };
            let settings = PictureSettings { camera: Some(camera), ..settings() };
            let expected = studio.render(&whole, &settings).unwrap();
            let picture = studio.render(&model, &settings).unwrap();
            assert_eq!(difference(&picture, &expected), 0, "{projection:?} {index}");
            let shown = studio.stage().scene.model().unwrap().batches().instances().len();
            assert!(shown < places.len(), "{projection:?} {index}: some are outside");
        }
    }
}
