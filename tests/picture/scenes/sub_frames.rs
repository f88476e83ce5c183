//! Scenes as the mean of sub-frames: the depth of field of their cameras, and cuts.

use super::{SIZE, script, settings, view, view_of};
use dragonfly_anim::data::Material;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_kit::document::made;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{FrameSampling, PictureSettings, ThroughCamera};
use image::Rgba32FImage;

/// Half the side of a small bright square, meters.
const HALF: f32 = 0.01;
/// Focal length of a lens that is as wide as it is long, meters.
const LENS: f32 = 0.1;
/// Distance of the square from the camera, meters.
const AWAY: f32 = 10.0;

/// Returns the sum of alpha, and the mean variance of its place along both axes, pixels.
fn spread(picture: &Rgba32FImage) -> (f64, f64) {
    let mut sums = [0.0; 5];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let [x, y, alpha] = [f64::from(x), f64::from(y), f64::from(pixel.0[3])];
        for (sum, factor) in sums.iter_mut().zip([1.0, x, y, x * x, y * y]) {
            *sum += alpha * factor;
        }
    }
    let [alpha, x, y, xx, yy] = sums;
    let variance = |first: f64, second: f64| second / alpha - (first / alpha) * (first / alpha);
    (alpha, (variance(x, xx) + variance(y, yy)) / 2.0)
}

#[test]
fn a_small_light_out_of_focus_is_a_disc_of_the_size_that_the_thin_lens_gives_it() {
    let Some(mut studio) = studio::studio() else { return };
    let mut dot = made::sheet();
    dot.vertices.positions.iter_mut().for_each(|corner| *corner *= HALF);
    let material = Material { unlit: true, double_sided: true, ..Material::default() };
    let model = made::loaded(made::standing(vec![dot], vec![material]), Vec::new());
    let mut seen = |focus: &str, depth_of_field: bool| {
        let camera =
            format!(r#"<camera id="eye" at="0 1 10" look="0 1 0" lens="100mm" {focus} aperture="1"/>"#);
        let cast = format!(r#"<prop id="spark" model="dot" at="0 1 0"/>{camera}"#);
        let view = view_of(&script(&cast, r#"<wait dur="1"/>"#), &model);
        let sampling = FrameSampling { samples: 64, depth_of_field, ..FrameSampling::default() };
        let settings = PictureSettings { sampling, ..settings(ThroughCamera::Shot, 0.5) };
        spread(&studio.render_scene_linear(&view, &settings).expect("an image"))
    };
    let pixels = SIZE[0] as f32 / 0.036;
    let side = f64::from(2.0 * HALF * LENS / AWAY * pixels);
    let (sharp, width) = seen(r#"focus="3""#, false);
    assert!((sharp / (side * side) - 1.0).abs() < 0.1, "{sharp} of {} pixels", side * side);
    for focus in ["", r#"focus="spark""#, r#"focus="10""#] {
        let (alpha, in_focus) = seen(focus, true);
        assert!((in_focus - width).abs() < 0.05 && (alpha / sharp - 1.0).abs() < 0.05, "{focus}: {in_focus}");
    }
    for focus in [3.0_f32, 5.0, 30.0] {
        let (alpha, blurred) = seen(&format!(r#"focus="{focus}""#), true);
        assert!((alpha / sharp - 1.0).abs() < 0.05, "the light is spread, not lost: {alpha} of {sharp}");
        // The variance of a disc along an axis is a sixteenth of its squared diameter.
        let diameter = 4.0 * (blurred - width).max(0.0).sqrt();
        let opening = LENS;
        let on_image = opening * LENS * (AWAY - focus).abs() / (AWAY * (focus - LENS));
        let expected = f64::from(on_image * pixels);
        println!("focus {focus} m: {diameter:.2} pixels, by the formula {expected:.2}");
        assert!((diameter / expected - 1.0).abs() < 0.1, "{focus}: {diameter}, not {expected}");
    }
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn a_frame_next_to_a_cut_shows_one_shot() {
    let Some(mut studio) = studio::studio() else { return };
    let text = script(
        r#"<role id="anna" model="arm"/><camera id="wide" at="0 1.5 9" look="0 1.2 0"/>
        <camera id="away" at="0 1.5 9" look="0 1.2 20"/>"#,
        r#"<wait dur="2"/><shot who="wide" begin="0"/><shot who="away" begin="0.5"/>"#,
    );
    let view = view(&text);
    let mut at = |seconds: f64| {
        let sampling = FrameSampling { samples: 4, shutter: 360.0, ..FrameSampling::default() };
        let moment = Some(StageTime::from_seconds(seconds));
        let settings = PictureSettings { sampling, moment, ..settings(ThroughCamera::Shot, 0.0) };
        studio.render_scene(&view, &settings).expect("an image")
    };
    let before = at(0.3);
    assert!(before.pixels().any(|pixel| pixel[3] == 255), "the role is seen");
    assert!(at(0.49) == before, "the last frame of the shot has nothing of the next one");
    assert!(at(0.5).pixels().all(|pixel| pixel[3] == 0), "the first frame has nothing of the one before");
}
