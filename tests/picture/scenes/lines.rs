//! Drawn lines in pictures: those for movies alone, at their times, in their colors and widths.

use super::{SIZE, arms, projected, settings, state, view};
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_document::SceneView;
use dragonfly_kit::picture::studio;
use dragonfly_picture::ThroughCamera;
use glam::Vec3;
use std::sync::Arc;

/// Two lines above the arms, and one that moves with a role: straight, from left to right.
const LINES: &str = r##"<lines version="1">
  <line id="film" points="-2 3 0  -1 3 0  1 3 0  2 3 0" color="#0000ff" width="6" from="1" in-movie="yes"/>
  <line id="note" points="-2 2.5 0  -1 2.5 0  1 2.5 0  2 2.5 0" color="#00ff00" width="6"/>
  <line id="held" points="-0.5 3 0  -0.2 3 0  0.2 3 0  0.5 3 0" of="ben" color="#ff00ff" width="6" in-movie="yes"/>
</lines>
"##;

#[test]
fn movies_show_the_lines_that_ask_for_it_in_their_colors_at_their_times_and_with_what_they_move() {
    let Some(mut studio) = studio::studio() else { return };
    let lines = DrawnLines::read(LINES).unwrap_or_else(|errors| panic!("{}", errors[0].in_file(LINES)));
    let view = Arc::new(SceneView { lines: Some(Arc::new(lines)), ..SceneView::clone(&view(&arms())) });
    for seconds in [0.5_f32, 1.25] {
        let picture =
            studio.render_scene(&view, &settings(ThroughCamera::Of("wide".into()), seconds)).unwrap();
        let state = state(&view, f64::from(seconds));
        let camera = view.plan.as_ref().unwrap().camera_of(2, &state).unwrap();
        let pixel = |place: Vec3, down: f32| {
            let at = projected(camera.position, camera.rotation, camera.lens, place).unwrap();
            let [x, y] = [(at.x + 1.0) / 2.0 * SIZE[0] as f32, (1.0 - at.y) / 2.0 * SIZE[1] as f32];
            picture.get_pixel(x as u32, (y + down) as u32).0
        };
        let is_blue =
            |[red, green, blue, alpha]: [u8; 4]| blue > 200 && red < 60 && green < 60 && alpha > 200;
        let film = Vec3::new(0.0, 3.0, 0.0);
        assert_eq!(is_blue(pixel(film, 0.0)), seconds >= 1.0, "at {seconds}");
        if seconds >= 1.0 {
            // Six pixels wide.
            assert!(is_blue(pixel(film, 2.0)) && is_blue(pixel(film, -2.0)) && !is_blue(pixel(film, 5.0)));
        }
        let note = pixel(Vec3::new(0.0, 2.5, 0.0), 0.0);
        assert!(note[1] < 200, "{note:?}: notes are in no movie");
        // Ben looks back, turned by 180 degrees, and walks.
        let held = pixel(state.things[1].transform.translation + Vec3::Y * 3.0, 0.0);
        assert!(held[0] > 200 && held[2] > 200 && held[1] < 60, "{held:?} at {seconds}");
    }
    assert_eq!(studio.stage().device().errors(), 0);
}
