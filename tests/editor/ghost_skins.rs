//! Ghosts drawn as skins: what was in one colour, what comes in another, and nothing of them where none is wanted.

use crate::picture::difference;
use crate::program::data;
use crate::studio;
use dragonfly::document::{Cancel, Source, load_model};
use dragonfly::graphics::{Appearance, PictureSettings};
use dragonfly::panels::settings::GhostSettings;
use image::RgbaImage;
use std::sync::Arc;

/// Pixels beside the fox, which is orange, in which one channel came to stand out.
fn tinted(picture: &RgbaImage, before: &RgbaImage, red: bool) -> usize {
    let more = |now: &image::Rgba<u8>, then: &image::Rgba<u8>| {
        let by = |channel: usize| i32::from(now[channel]) - i32::from(then[channel]);
        let beside = then[0] < then[2].saturating_add(20);
        beside && if red { by(0) > by(2) + 12 } else { by(2) > by(0) + 12 }
    };
    picture.pixels().zip(before.pixels()).filter(|(now, then)| more(now, then)).count()
}

#[test]
fn the_skin_is_seen_before_and_after_and_the_skeleton_in_its_place() {
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
        let controls = &mut studio.stage().scene.controls;
        controls.receive(Appearance::Ghosts(times.to_vec()));
        controls.receive(Appearance::GhostSkins(skins));
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

#[test]
fn how_ghosts_are_drawn_is_remembered_and_they_begin_as_skeletons() {
    assert!(!GhostSettings::default().skin);
    let text = "{\"hand\":{\"ghosts\":{\"skin\":true,\"step\":3}}}";
    let ghosts = dragonfly::panels::Settings::parse(text).hand.ghosts;
    assert_eq!((ghosts.skin, ghosts.step, ghosts.count), (true, 3, [3, 3]));
}
