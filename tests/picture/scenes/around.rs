//! The scene around a model that is edited in it.

use super::{script, settings, view};
use dragonfly_kit::document::arm;
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::{AroundClip, Look, PictureSettings, SceneAround, ThroughCamera};
use glam::{Mat4, Vec3};
use std::sync::Arc;

fn around(text: &str, model_from_scene: Mat4) -> SceneAround {
    let clip = AroundClip { take: 0, take_seconds: 0.5, scene_seconds: 0.5, speed: 1.0 };
    SceneAround {
        view: view(text),
        left_out: vec!["anna".into()],
        model_from_scene,
        clip: Some(clip),
        seconds: 0.5,
    }
}

#[test]
fn a_model_edited_in_its_scene_looks_as_it_does_in_the_scene_with_the_others_around_it() {
    let Some(mut studio) = studio::studio() else { return };
    let text = |place: &str| {
        script(
            &format!(
                r#"<role id="anna" model="arm" at="{place}"/><role id="ben" model="arm" at="{place}" facing="90"/>"#
            ),
            r#"<par><play who="anna" take="bend"/><play who="ben" take="bend"/></par>"#,
        )
    };
    let loaded = arm::loaded();
    let camera = Camera { target: Vec3::Y * 1.5, distance: 9.0, ..Camera::default() };
    let settings =
        || PictureSettings { take: Some(0), camera: Some(camera), ..settings(ThroughCamera::Free, 0.75) };
    let mut edited = |place: &str, model_from_scene: Mat4| {
        let look = Look { around: Some(Arc::new(around(&text(place), model_from_scene))), ..Look::default() };
        studio.render(&loaded, &PictureSettings { look, ..settings() }).expect("a picture")
    };
    let in_place = edited("0 0 0", Mat4::IDENTITY);
    let elsewhere = edited("3 0 2", Mat4::from_translation(Vec3::new(-3.0, 0.0, -2.0)));
    let alone = studio.render(&loaded, &settings()).expect("a picture");
    let (other, moved) = (difference(&in_place, &alone), difference(&in_place, &elsewhere));
    println!("{other} pixels are of the other arm, {moved} differ elsewhere");
    assert!(other > 100, "{other} pixels: the other arm is there");
    assert!(moved * 10 < other, "{moved} pixels: wherever the thing is in its scene");
    let scene = studio.render_scene(&view(&text("0 0 0")), &settings());
    let apart = difference(&in_place, &scene.expect("a picture"));
    // The transparent parts of both arms are drawn in another order.
    assert!(apart * 4 < other, "{apart}: it is the same picture as that of the scene");
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn a_time_of_the_take_is_the_time_of_the_scene_at_which_its_clip_plays_it() {
    let still = SceneAround { seconds: 4.0, ..around(&super::arms(), Mat4::IDENTITY) };
    let clip = AroundClip { take: 2, take_seconds: 1.0, scene_seconds: 5.0, speed: -2.0 };
    let around = SceneAround { clip: Some(clip), ..still.clone() };
    assert_eq!(around.time_of(Some(2), 1.0), 5.0);
    assert_eq!(around.time_of(Some(2), 0.0), 5.5, "backwards at twice the speed");
    assert_eq!(around.time_of(Some(2), 100.0), 0.0, "not before the start of the scene");
    assert_eq!(around.time_of(Some(1), 3.0), 4.0, "another take, another time");
    assert_eq!(SceneAround { clip: None, ..around }.time_of(None, 3.0), 4.0);
}
