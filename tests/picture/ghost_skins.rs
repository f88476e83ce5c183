//! Ghosts drawn as skins: earlier poses in one color, later ones in another, and none where none is requested.

use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_document::{Cancel, LoadedModel, Source, View, load_model};
use dragonfly_kit::document::arm;
use dragonfly_kit::folder::data;
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::frustum::ViewFrustum;
use dragonfly_picture::ghosts::GhostSkins;
use dragonfly_picture::{GhostAppearance, PictureSettings};
use glam::{Mat4, Vec3, Vec4};
use image::RgbaImage;
use std::sync::Arc;

/// Returns the number of pixels that are orange in neither image (the fox is orange), and have become more
/// red, or more blue.
fn tinted(picture: &RgbaImage, before: &RgbaImage, red: bool) -> usize {
    let more = |now: &image::Rgba<u8>, then: &image::Rgba<u8>| {
        let by = |channel: usize| i32::from(now[channel]) - i32::from(then[channel]);
        let beside = then[0] < then[2].saturating_add(20);
        beside && if red { by(0) > by(2) + 12 } else { by(2) > by(0) + 12 }
    };
    picture.pixels().zip(before.pixels()).filter(|(now, then)| more(now, then)).count()
}

#[test]
fn ghosts_show_the_skin_before_and_after_the_current_pose() {
    let Some(mut studio) = studio::studio() else { return };
    let source = Source::File(data("gltf/Fox.glb"));
    let loaded = Arc::new(load_model(&source, &mut |_| {}, &Cancel::default()).unwrap());
    let large = std::env::var_os("DRAGONFLY_SHOTS");
    let size = if large.is_some() { [960, 640] } else { [240, 160] };
    let settings = PictureSettings {
        size,
        take: Some(2),
        time: 0.5,
        yaw: 1.1,
        pitch: 0.15,
        ..PictureSettings::default()
    };
    let mut shown = |times: &[(f32, i32)], skins: bool| {
        studio.stage().scene.appearances.set(GhostAppearance { times: times.to_vec(), skins });
        studio.render(&loaded, &settings).unwrap()
    };
    let many: Vec<(f32, i32)> =
        (1..=3).flat_map(|at| [-at, at]).map(|at| (0.5 + at as f32 * 0.1, at)).collect();
    let all = shown(&many, true);
    if let Some(folder) = large {
        all.save(std::path::Path::new(&folder).join("ghosts.png")).unwrap();
    }
    let none = shown(&[], true);
    let (past, future) = ([(0.35, -1)], [(0.65, 1)]);
    let before = shown(&past, true);
    assert!(tinted(&before, &none, true) > 300, "only {} pixels are red", tinted(&before, &none, true));
    assert!(tinted(&before, &none, false) < tinted(&before, &none, true) / 4);
    let after = shown(&future, true);
    assert!(tinted(&after, &none, false) > 300, "only {} are blue", tinted(&after, &none, false));
    let bones = shown(&past, false);
    assert!(difference(&bones, &none) > 100 && difference(&bones, &before) > 300, "the skeleton alone");
    assert_eq!(difference(&shown(&[], true), &none), 0, "gone without a trace");
    assert_eq!(studio.stage().device().errors(), 0);
}

/// Whether a mesh is mirrored, and so seen from inside, is determined for each ghost separately.
#[test]
fn a_mesh_that_is_mirrored_at_one_time_is_mirrored_only_in_the_ghost_of_that_time() {
    let loaded = Arc::into_inner(arm::loaded()).expect("the only one");
    let mut model = Arc::into_inner(loaded.model).expect("the only one");
    let mut take = (*model.animation.takes[0]).clone();
    let scales = vec![Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)];
    take.tracks[arm::BONES - 1].scale = Channel::new(vec![0.0, arm::LENGTH], scales, Interpolation::Step);
    model.animation.takes = vec![Arc::new(take)];
    let view = View::opened(1, Arc::new(LoadedModel { model: Arc::new(model), ..loaded }));
    let mut ghosts = GhostSkins::default();
    // All that is not infinitely large is inside.
    let all = ViewFrustum::new(&Mat4::from_diagonal(Vec4::new(0.0, 0.0, 0.0, 1.0)));
    ghosts.pose(&view, &[], Some(0), &[(0.0, -1), (arm::LENGTH, 1)], [[0.0; 3]; 2], &all);
    // The tube is bound to all bones; the pane is attached to the last one.
    let inside: Vec<bool> = ghosts.batches_from(0).iter().map(|batch| batch.mirrored).collect();
    assert_eq!(inside.len(), 4, "two surfaces of two ghosts");
    assert_eq!(inside[..2], [false, false]);
    assert!(inside[3], "the pane");
}
