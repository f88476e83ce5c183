//! Shadows of lamps: at the places that geometry gives, at rest while the camera moves, and none of lamps whose script turns them off.

use crate::scenes::{SIZE, script, settings, shown, view};
use dragonfly_anim::data::{AlphaMode, Filter, Material, Primitive, TextureRef, TextureTransform, Wrap};
use dragonfly_document::{DecodedImage, SceneView};
use dragonfly_kit::counting;
use dragonfly_kit::document::{arm, made};
use dragonfly_kit::picture::studio;
use dragonfly_picture::camera::{Camera, Projection};
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{
    CASCADES, EffectLook, Look, PictureSettings, SPOT_SHADOWS, ShadowMap, Studio, ThroughCamera,
};
use glam::{Vec2, Vec3, Vec4};
use image::{Rgba, RgbaImage};
use std::f32::consts::{FRAC_PI_2, SQRT_2};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Half the side of the box that is drawn for a prop without a model, meters; its lower side is on the ground.
const HALF: f32 = 0.15;

/// A sun that shines to the right, down at 45 degrees.
const SUN: &str = r#"<light id="sun" kind="sun" direction="1 -1 0" strength="3"/>"#;

/// Returns a box on the ground in the light of these lamps.
fn lit_box(lamps: &str) -> Arc<SceneView> {
    view(&script(&format!(r#"<prop id="box" model="lost"/>{lamps}"#), "<wait dur=\"1\"/>"))
}

/// Returns an orthographic camera straight above, with X to the right.
fn above() -> Camera {
    Camera {
        target: Vec3::X * 0.3,
        distance: 1.5,
        yaw: 0.0,
        pitch: FRAC_PI_2,
        projection: Projection::Orthographic,
        ..Camera::default()
    }
}

/// Renders a scene with or without shadows over a plain background.
fn picture(studio: &mut Studio, view: &Arc<SceneView>, camera: Camera, shadows: bool) -> RgbaImage {
    let effects = EffectLook { shadows, ..EffectLook::default() };
    let base = settings(ThroughCamera::Free, 0.0);
    let look = Look { effects, ..base.look.clone() };
    let camera = Some(camera);
    let settings =
        PictureSettings { look, camera, grid: true, background: Some([200, 200, 200, 255]), ..base };
    studio.render_scene(view, &settings).unwrap()
}

fn light(pixel: &Rgba<u8>) -> f32 {
    let value = f32::from(pixel[1]) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Returns the share of the light that shadows keep from each pixel of the row through a point of the ground with this z.
fn shadow_along(studio: &mut Studio, lamps: &str, camera: Camera, z: f32) -> Vec<f32> {
    let view = lit_box(lamps);
    // The scene with shadows last: the caller looks at its maps.
    let [without, with] = [false, true].map(|shadows| picture(studio, &view, camera, shadows));
    let unit = camera.units_per_pixel(SIZE[1] as f32);
    let row = (SIZE[1] as f32 / 2.0 + (z - camera.target.z) / unit) as u32;
    (0..SIZE[0]).map(|x| 1.0 - light(with.get_pixel(x, row)) / light(without.get_pixel(x, row))).collect()
}

#[test]
fn the_edge_of_a_shadow_on_the_ground_is_where_geometry_has_it() {
    let Some(mut studio) = studio::studio() else { return };
    let camera = above();
    let shadow = shadow_along(&mut studio, SUN, camera, 0.05);
    let unit = camera.units_per_pixel(SIZE[1] as f32);
    let pixel_of = |x: f32| (x - camera.target.x) / unit + SIZE[0] as f32 / 2.0 - 0.5;
    let at = |x: f32| shadow[pixel_of(x).round() as usize];
    // The upper edge at x = 0.15, 0.3 meters high, casts the end of the shadow.
    let end = HALF + 2.0 * HALF;
    let deep = at(end - 0.1);
    assert!(deep > 0.3, "the sun is most of the light: {deep}");
    assert!(at(end + 0.1).abs() < 0.02 && at(-HALF - 0.1).abs() < 0.02, "no shadow outside");
    let first = pixel_of(end - 0.1) as usize;
    let crossing = (first..).find(|&x| shadow[x] >= deep / 2.0 && shadow[x + 1] < deep / 2.0).unwrap();
    let part = (shadow[crossing] - deep / 2.0) / (shadow[crossing] - shadow[crossing + 1]);
    let measured = (crossing as f32 + part + 0.5 - SIZE[0] as f32 / 2.0) * unit + camera.target.x;
    let shadows = *studio.stage().scene.shadows().expect("shadows");
    // A texel is seen under 45 degrees.
    let texel = shadows.cascades()[0].texel * SQRT_2;
    println!("{measured} instead of {end}: {} texels", (measured - end) / texel);
    assert!((measured - end).abs() < 2.0 * texel, "{measured} instead of {end}, texel {texel}");
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn the_lit_sides_of_a_box_have_no_shadow_of_their_own() {
    let Some(mut studio) = studio::studio() else { return };
    let camera = above();
    // The top of the box, 45 degrees to the sun, and the ground to its left.
    let shadow = shadow_along(&mut studio, SUN, camera, 0.05);
    let unit = camera.units_per_pixel(SIZE[1] as f32);
    let pixel = |x: f32| ((x - camera.target.x) / unit + SIZE[0] as f32 / 2.0) as usize;
    // Devices differ in the part of the pixel of the edge that is ground.
    let edge = pixel(-HALF);
    let lit = (pixel(-HALF - 0.1)..pixel(HALF - 0.02)).filter(|&x| x != edge);
    let darkened: Vec<_> = lit.filter(|&x| shadow[x] >= 0.05).map(|x| (x, shadow[x])).collect();
    assert!(darkened.is_empty(), "{darkened:?}, where the box begins at pixel {edge}");
    assert!(shadow[edge] < 0.15, "the edge: {}", shadow[edge]);
}

#[test]
fn a_step_of_the_camera_moves_shadows_with_the_ground() {
    let Some(mut studio) = studio::studio() else { return };
    let (view, start) = (lit_box(SUN), above());
    let unit = start.units_per_pixel(SIZE[1] as f32);
    let first = picture(&mut studio, &view, start, true);
    for step in 1..=4_u32 {
        // A pixel of the picture, which is no whole number of texels.
        let camera = Camera { target: start.target + Vec3::X * unit * step as f32, ..start };
        let moved = picture(&mut studio, &view, camera, true);
        let mut different = 0;
        for (x, y, pixel) in moved.enumerate_pixels().filter(|(x, ..)| x + step < SIZE[0]) {
            let before = first.get_pixel(x + step, y);
            different += usize::from((0..3).any(|part| pixel[part].abs_diff(before[part]) > 3));
        }
        println!("step {step}: {different} pixels");
        assert!(different * 1000 < (SIZE[0] * SIZE[1]) as usize, "step {step}: {different} pixels");
    }
}

/// Returns the texels of a map in which a point is seen.
fn texel_of(map: &ShadowMap, side: u32, point: Vec3) -> Vec2 {
    let clip = map.clip_from_world * point.extend(1.0);
    (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * side as f32
}

#[test]
fn maps_of_a_sun_move_by_whole_texels() {
    let view = lit_box(SUN);
    let mut scene = shown(&view, 0.0);
    scene.look.through = ThroughCamera::Free;
    scene.camera = Camera { distance: 2.0, ..Camera::default() };
    let point = Vec3::new(0.123, 0.05, -0.07);
    let mut before: Option<[(f32, Vec2); CASCADES]> = None;
    let (mut compared, mut resized) = (0, 0);
    for step in 0..60 {
        scene.camera.orbit(0.003, 0.001);
        scene.camera.target += Vec3::new(0.0007, 0.0002, 0.0003);
        scene.prepare(Instant::now() + Duration::from_millis(step));
        let shadows = *scene.shadows().expect("shadows");
        let maps = shadows.cascades();
        assert_eq!(maps.len(), CASCADES);
        let now: [(f32, Vec2); CASCADES] =
            std::array::from_fn(|index| (maps[index].texel, texel_of(&maps[index], shadows.side(), point)));
        for ((texel, at), (old_texel, old)) in now.iter().zip(before.unwrap_or(now)) {
            if *texel == old_texel {
                let moved = *at - old;
                let rest = (moved - moved.round()).abs().max_element();
                assert!(rest < 0.01, "step {step}: {moved} texels");
                compared += 1;
            } else {
                resized += 1;
            }
        }
        before = Some(now);
    }
    assert!(compared > 100 && resized <= 2 * CASCADES, "{compared} {resized}");
}

#[test]
fn everything_between_the_nearest_and_the_farthest_ground_is_in_a_map() {
    let view = lit_box(SUN);
    let mut scene = shown(&view, 0.0);
    scene.look.through = ThroughCamera::Free;
    let mut seen = 0;
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for distance in [0.4, 1.5, 6.0] {
            scene.camera = Camera { distance, projection, target: Vec3::Y * HALF, ..Camera::default() };
            scene.prepare(Instant::now());
            let shadows = *scene.shadows().expect("shadows");
            let is_inside = |map: &ShadowMap, point: Vec3| {
                let at = texel_of(map, shadows.side(), point) / shadows.side() as f32;
                at.cmpgt(Vec2::ZERO).all() && at.cmplt(Vec2::ONE).all()
            };
            for x in -4..=4 {
                let point = Vec3::new(x as f32 * 0.1, 0.0, 0.05);
                let clip = scene.uniform().clip_from_world * point.extend(1.0);
                let is_seen = clip.truncate().truncate().abs().max_element() < clip.w;
                let found = shadows.cascades().iter().any(|map| is_inside(map, point));
                seen += usize::from(is_seen);
                assert!(found || !is_seen, "{projection:?} from {distance}: {point}");
            }
        }
    }
    assert!(seen > 20, "{seen} places are seen");
}

/// Returns the number of pixels that shadows darken.
fn darkened(studio: &mut Studio, lamps: &str) -> usize {
    let view = lit_box(lamps);
    let [with, without] = [true, false].map(|shadows| picture(studio, &view, above(), shadows));
    with.pixels().zip(without.pixels()).filter(|(a, b)| light(a) < 0.9 * light(b)).count()
}

#[test]
fn lamps_cast_shadows_unless_their_script_turns_them_off() {
    let Some(mut studio) = studio::studio() else { return };
    let no = SUN.replace("/>", r#" shadow="no"/>"#);
    assert!(darkened(&mut studio, SUN) > 1000);
    assert_eq!(darkened(&mut studio, &no), 0);
    let point = r#"<light id="lamp" kind="point" at="-0.5 1 0" strength="3"/>"#;
    assert_eq!(darkened(&mut studio, point), 0, "point lights cast none");
    // From the upper left of the box, so that the shadow is on its right.
    let spot = r#"<light id="lamp" kind="spot" at="-1 1.2 0" direction="1 -1 0" strength="9"/>"#;
    let of_spot = darkened(&mut studio, spot);
    assert!((300..8000).contains(&of_spot), "{of_spot}");
    assert_eq!(darkened(&mut studio, &spot.replace("1 -1 0\"", "-1 1 0\"")), 0, "the box is behind the spot");
    let many: String = (0..7).map(|index| spot.replace("\"lamp\"", &format!("\"lamp{index}\""))).collect();
    assert!(darkened(&mut studio, &many) > 300);
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn at_most_four_spot_lights_and_one_sun_have_maps() {
    let spot = |index: usize| {
        format!(r#"<light id="s{index}" kind="spot" at="0 2 {index}" direction="0 -1 0" strength="2"/>"#)
    };
    let lamps: String = (0..6).map(spot).chain([SUN.to_owned()]).collect();
    let scene = shown(&lit_box(&lamps), 0.0);
    let shadows = scene.shadows().expect("shadows");
    assert_eq!((shadows.cascades().len(), shadows.spots().len()), (CASCADES, SPOT_SHADOWS));
    let marks: Vec<f32> = scene.uniform().lights.iter().map(|light| light.direction.w).collect();
    assert_eq!(marks, [2.0, 3.0, 4.0, 5.0, 0.0, 0.0, 1.0, 0.0]);
    // Two suns: the first one.
    let two = format!("{SUN}{}", SUN.replace("\"sun\" kind", "\"other\" kind"));
    let scene = shown(&lit_box(&two), 0.0);
    assert_eq!(scene.uniform().lights.map(|light| light.direction.w)[..2], [1.0, 0.0]);
}

#[test]
fn masked_surfaces_have_holes_in_their_shadows() {
    let Some(mut studio) = studio::studio() else { return };
    let texture = TextureRef {
        image: 0,
        set: 0,
        wrap: [Wrap::ClampToEdge; 2],
        magnify: Filter::Nearest,
        minify: Filter::Nearest,
        mip: false,
        transform: TextureTransform::IDENTITY,
    };
    // The left half is open. The key light of the studio comes from the left and the front: the shadow is next to the sheet.
    let image = DecodedImage { width: 2, height: 1, pixels: vec![255, 255, 255, 0, 255, 255, 255, 255] };
    let flat = |height: f32, size: f32, material: u32| {
        let mut sheet = made::sheet();
        for (position, normal) in sheet.vertices.positions.iter_mut().zip(&mut sheet.vertices.normals) {
            (*position, *normal) = (Vec3::new(position.x * size, height, -position.y * size), Vec3::Y);
        }
        Primitive { material: Some(material), ..sheet }
    };
    let mut dark = |alpha_mode: AlphaMode| {
        let white = made::paint(Vec4::splat(0.8).with_w(1.0));
        let leaf =
            Material { alpha_mode, double_sided: true, base_color_texture: Some(texture), ..white.clone() };
        let model = made::standing(vec![flat(0.0, 2.2, 0), flat(2.0, 0.5, 1)], vec![white, leaf]);
        let loaded = made::loaded(model, vec![image.clone()]);
        let mut draw = |studio_shadows: bool| {
            let effects = EffectLook { studio_shadows, ..EffectLook::default() };
            let base = settings(ThroughCamera::Free, 0.0);
            let look = Look { effects, ..base.look.clone() };
            studio.render(&loaded, &PictureSettings { look, yaw: 0.0, pitch: 1.2, ..base }).unwrap()
        };
        let (with, without) = (draw(true), draw(false));
        with.pixels().zip(without.pixels()).filter(|(a, b)| light(a) < 0.85 * light(b)).count()
    };
    let whole = dark(AlphaMode::Opaque);
    let half = dark(AlphaMode::Mask(0.5));
    let blended = dark(AlphaMode::Blend);
    println!("{whole} pixels, {half} with a mask, {blended} where it is transparent");
    assert!(whole > 400, "{whole}");
    assert!((whole / 4..whole * 3 / 4).contains(&half), "{half} of {whole}");
    assert!((whole / 4..whole * 3 / 4).contains(&blended), "{blended} of {whole}");
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn shadows_of_the_studio_are_off_unless_asked_for_and_follow_the_viewer() {
    let now = Instant::now();
    let mut scene = Scene::new(now);
    scene.show_model(arm::loaded());
    scene.look = Look { viewport: [0, 0, SIZE[0], SIZE[1]], ..Look::default() };
    scene.prepare(now);
    assert!(scene.shadows().is_none());
    scene.look.effects.studio_shadows = true;
    let mut towards = |yaw: f32| {
        scene.camera.yaw = yaw;
        scene.prepare(now);
        let shadows = *scene.shadows().expect("shadows");
        assert!(shadows.is_studio());
        // The depth grows towards the lamp.
        shadows.cascades()[0].clip_from_world.row(2).truncate().normalize()
    };
    let front = towards(0.0);
    assert!(front.abs_diff_eq(Vec3::new(-0.4830, 0.7043, 0.5202), 1e-3), "{front}");
    let right = towards(FRAC_PI_2);
    assert!(right.abs_diff_eq(Vec3::new(0.5202, 0.7043, 0.4830), 1e-3), "{right}");
    scene.look.shading = dragonfly_picture::Shading::Unlit;
    scene.prepare(now);
    assert!(scene.shadows().is_none(), "without light there is no shadow");
}

#[test]
fn frames_with_shadows_allocate_nothing_after_the_first() {
    let roles: String = (0..5).map(|at| format!(r#"<role id="r{at}" model="arm" at="{at} 0 0"/>"#)).collect();
    let spot = r#"<light id="lamp" kind="spot" at="0 4 0" direction="0 -1 0" strength="2"/>"#;
    let view = view(&script(&format!("{roles}{SUN}{spot}"), "<play who=\"r0\" take=\"bend\"/>"));
    let mut scene = shown(&view, 0.0);
    let start = Instant::now();
    scene.playback = PlaybackClock { playing: true, ..PlaybackClock::of_scene(10.0, start) };
    scene.prepare(start);
    assert_eq!(scene.shadows().map(|shadows| shadows.maps().count()), Some(CASCADES + 1));
    let (count, ()) = counting::count(|| {
        (1..60).for_each(|frame| scene.prepare(start + Duration::from_millis(16 * frame)));
    });
    assert_eq!(count.allocations, 0, "{count:?}");
}

#[test]
fn a_lost_device_has_the_same_shadows_again() {
    let Some(mut studio) = studio::studio() else { return };
    let view = lit_box(SUN);
    let before = picture(&mut studio, &view, above(), true);
    studio.stage().device().lose();
    assert!(picture(&mut studio, &view, above(), true) == before);
}
