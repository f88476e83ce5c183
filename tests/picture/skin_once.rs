//! Vertices are posed once for all passes that draw them where lamps cast shadows, and look as those that each pass poses do.

use crate::scenes::{arms, script, settings, view};
use dragonfly_document::{Cancel, LoadedModel, Source, load_model};
use dragonfly_kit::document::large;
use dragonfly_kit::folder::data;
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{EffectLook, Look, PictureSettings, Studio, ThroughCamera};
use std::sync::Arc;

/// More than any model of these tests needs.
const PLENTY: u64 = 64 << 20;

/// Bytes of the posed vertices of an arm: its tube of 13 rings of 16. The pane is carried by one bone.
const ARM: u64 = 40 * 13 * 16;

fn open(name: &str) -> Arc<LoadedModel> {
    Arc::new(load_model(&Source::File(data(name)), &mut |_| {}, &Cancel::default()).unwrap())
}

/// Returns settings of a small image of a model in the studio, whose key light casts shadows.
fn in_studio(take: usize, time: f32) -> PictureSettings {
    let effects = EffectLook { studio_shadows: true, ..EffectLook::default() };
    let look = Look { effects, ..Look::default() };
    let base = dragonfly_kit::picture::images::settings();
    PictureSettings { take: Some(take), time, yaw: 0.9, pitch: 0.3, look, ..base }
}

/// Returns the number of vertices that were posed once in the last frame.
fn skinned(studio: &mut Studio) -> u64 {
    studio.stage().skinned_vertices()
}

#[test]
fn vertices_posed_once_are_drawn_bit_for_bit_as_those_posed_in_each_pass() {
    let Some(mut studio) = studio::studio() else { return };
    // Four influences a vertex, shape keys, and many meshes on bones.
    let models =
        [("gltf/Fox.glb", 2), ("gltf/AnimatedMorphCube.glb", 0), ("collection/RobotExpressive.glb", 0)];
    for (name, take) in models {
        let loaded = open(name);
        let start = loaded.model.animation.takes[take].start;
        for time in [0.0_f32, 0.4] {
            let settings = in_studio(take, start + time);
            studio.stage().set_skin_budget(PLENTY);
            let once = studio.render(&loaded, &settings).unwrap();
            assert!(skinned(&mut studio) > 0, "{name} is posed once");
            studio.stage().set_skin_budget(0);
            let each = studio.render(&loaded, &settings).unwrap();
            assert_eq!(skinned(&mut studio), 0, "{name} is posed in each pass");
            assert_eq!(difference(&once, &each), 0, "{name} at {time}");
        }
    }
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn only_what_has_changed_is_posed_again() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = open("gltf/Fox.glb");
    let vertices: usize =
        loaded.model.meshes.iter().flat_map(|mesh| &mesh.primitives).map(|part| part.vertices.len()).sum();
    let mut posed_at = |time: f32, yaw: f32| {
        studio.render(&loaded, &PictureSettings { yaw, ..in_studio(1, time) }).unwrap();
        studio.stage().skinned_vertices()
    };
    assert_eq!(posed_at(0.1, 0.0), vertices as u64);
    assert_eq!(posed_at(0.1, 0.5), 0, "the camera poses nothing");
    assert_eq!(posed_at(0.3, 0.5), vertices as u64);
}

#[test]
fn models_that_do_not_fit_the_budget_are_posed_in_each_pass() {
    let Some(mut studio) = studio::studio() else { return };
    let sun = r#"<light id="sun" kind="sun" direction="-1 -2 -1" strength="3"/></cast>"#;
    let view = view(&arms().replace("</cast>", sun));
    let mut with = |budget: u64| {
        studio.stage().set_skin_budget(budget);
        let picture = studio.render_scene(&view, &settings(ThroughCamera::Shot, 0.5)).unwrap();
        (picture, studio.stage().skinned_vertices())
    };
    let (fits, all) = with(2 * ARM);
    let (does_not, none) = with(2 * ARM - 1);
    assert_eq!((all, none), (2 * ARM / 40, 0));
    assert_eq!(difference(&fits, &does_not), 0);
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn copies_that_one_matrix_moves_need_no_memory() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = large::instances(300);
    studio.render(&loaded, &in_studio(0, 0.0)).unwrap();
    assert_eq!(skinned(&mut studio), 0);
    assert!((1..=3).contains(&studio.stage().shadow_draws()), "one draw for all copies in each map");
}

#[test]
fn nothing_is_posed_before_it_is_drawn_without_shadows() {
    let Some(mut studio) = studio::studio() else { return };
    // The same scene three times: without a lamp, with one that casts no shadow, and with shadows off.
    let lamp = |shadow: &str| {
        format!(r#"<role id="a" model="arm"/><light id="sun" kind="sun" strength="3" shadow="{shadow}"/>"#)
    };
    let off = EffectLook { shadows: false, ..EffectLook::default() };
    let cases = [
        (r#"<role id="a" model="arm"/>"#.to_owned(), EffectLook::default()),
        (lamp("no"), EffectLook::default()),
        (lamp("yes"), off),
    ];
    let mut counts = Vec::new();
    for (cast, effects) in cases {
        let base = settings(ThroughCamera::Free, 0.0);
        let look = Look { effects, ..base.look.clone() };
        let view = view(&script(&cast, "<wait dur=\"1\"/>"));
        studio.render_scene(&view, &PictureSettings { look, ..base }).unwrap();
        let stage = studio.stage();
        assert_eq!((stage.skinned_vertices(), stage.shadow_draws()), (0, 0), "{cast}");
        counts.push((stage.draw_calls(), stage.state_changes()));
    }
    // The tube, and both sides of the pane. Bind group 0 is set in both passes, 1 and 2 for each part, and three pipelines.
    assert_eq!(counts, [(3, 9); 3]);
}
