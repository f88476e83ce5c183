//! Shadows in sub-frames: where those of a frame drawn once are, of another point of the sun each, and the same in any order.

use super::still;
use crate::scenes::{arms, script, settings, shown, view};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneView;
use dragonfly_kit::picture::studio;
use dragonfly_picture::camera::{Camera, Projection};
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{
    EffectLook, FrameSampling, Look, PictureSettings, SampledFrame, Studio, ThroughCamera,
};
use glam::Vec3;
use image::RgbaImage;
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;
use std::time::Instant;

/// A sun that shines to the right, down at 45 degrees.
const SUN: &str = r#"<light id="sun" kind="sun" direction="1 -1 0" strength="3"/>"#;

/// Tangent of half the angle of 0.53 degrees that the sun takes in the sky.
const SUN_RADIUS: f32 = 0.004_625;

/// Returns a box on the ground in the light of the sun.
fn lit_box() -> Arc<SceneView> {
    view(&script(&format!(r#"<prop id="box" model="lost"/>{SUN}"#), "<wait dur=\"1\"/>"))
}

/// Returns the direction in which the depth of the first map grows: towards the sun.
fn towards(scene: &Scene) -> Vec3 {
    let shadows = scene.shadows().expect("shadows");
    shadows.cascades()[0].clip_from_world.row(2).truncate().normalize()
}

#[test]
fn each_sub_frame_has_the_shadows_of_another_point_of_the_sun() {
    let now = Instant::now();
    let mut scene = shown(&lit_box(), 0.0);
    let (middle, once) = (towards(&scene), *scene.shadows().expect("shadows"));
    assert!(middle.abs_diff_eq(Vec3::new(-1.0, 1.0, 0.0).normalize(), 1e-6), "{middle}");
    let frame = |samples| SampledFrame::new(still(samples), StageTime::ZERO);
    scene.set_sub_frame(Some(frame(1).sub_frame(0, 4)));
    scene.prepare(now);
    assert_eq!(scene.shadows(), Some(&once), "a single one has those of the middle");
    let (mut sum, mut farthest) = (Vec3::ZERO, 0.0_f32);
    for index in 0..16 {
        scene.set_sub_frame(Some(frame(16).sub_frame(index, 4)));
        scene.prepare(now);
        let away = towards(&scene) - middle;
        assert!(away.length() < SUN_RADIUS, "{index}: {away}");
        farthest = farthest.max(away.length());
        sum += away;
    }
    assert!(farthest > 0.9 * SUN_RADIUS, "{farthest}");
    assert!((sum / 16.0).length() < 0.15 * SUN_RADIUS, "{sum}");
    scene.set_sub_frame(None);
    scene.prepare(now);
    assert_eq!(scene.shadows(), Some(&once));
}

/// Renders the box from straight above, over a plain background.
fn from_above(studio: &mut Studio, samples: u32, shadows: bool) -> RgbaImage {
    let camera = Camera {
        target: Vec3::X * 0.3,
        distance: 1.5,
        yaw: 0.0,
        pitch: FRAC_PI_2,
        projection: Projection::Orthographic,
        ..Camera::default()
    };
    let effects = EffectLook { shadows, ..EffectLook::default() };
    let base = settings(ThroughCamera::Free, 0.0);
    let look = Look { effects, ..base.look.clone() };
    let sampling = still(samples);
    let background = Some([200, 200, 200, 255]);
    let settings = PictureSettings { look, camera: Some(camera), grid: true, background, sampling, ..base };
    studio.render_scene(&lit_box(), &settings).expect("an image")
}

#[test]
fn sub_frames_have_their_shadows_where_a_frame_drawn_once_has_them() {
    let Some(mut studio) = studio::studio() else { return };
    let mut darkened = |samples: u32| -> Vec<bool> {
        let [with, without] = [true, false].map(|shadows| from_above(&mut studio, samples, shadows));
        let pairs = with.pixels().zip(without.pixels());
        pairs.map(|(with, without)| f32::from(with[1]) < 0.9 * f32::from(without[1])).collect()
    };
    let (once, mean) = (darkened(1), darkened(16));
    let count = |pixels: &[bool]| pixels.iter().filter(|is_dark| **is_dark).count();
    let different = once.iter().zip(&mean).filter(|(once, mean)| once != mean).count();
    println!("{} and {} pixels, {different} differ", count(&once), count(&mean));
    assert!(count(&once) > 1000 && different * 20 < count(&once), "{different} of {}", count(&once));
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn frames_with_shadows_are_the_same_in_any_order_and_after_a_loss_of_the_device() {
    let Some(mut studio) = studio::studio() else { return };
    let view = view(&arms().replace("</cast>", &format!("{SUN}</cast>")));
    let mut frame = |time: f32, is_lost_before: bool| {
        if is_lost_before {
            studio.stage().device().lose();
        }
        let sampling = FrameSampling { samples: 4, ..FrameSampling::default() };
        let settings = PictureSettings { sampling, ..settings(ThroughCamera::Shot, time) };
        let picture = studio.render_scene(&view, &settings).expect("an image");
        assert!(studio.stage().shadow_draws() > 0, "{time}: shadows are drawn");
        picture
    };
    let [second, first] = [0.9, 0.3].map(|time| frame(time, false));
    assert!(first != second);
    assert!(frame(0.9, false) == second && frame(0.3, true) == first);
}
