//! Effects of the scene, drawn without a window over a plain background.

use super::compare::SCENES;
use super::drawing;
use super::reference::{self, HOW_TO_UPDATE};
use crate::scene_bench;
use dragonfly_document::SceneView;
use dragonfly_kit::picture::studio::studio;
use dragonfly_kit::skip::{TestNeed, skip};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::{Look, PictureSettings, ThroughCamera};
use glam::Vec3;
use std::sync::Arc;

/// Size of the pictures, pixels.
const SIZE: [u32; 2] = [320, 180];

/// A picture: its name, and the lamps of its scene in place of the sun.
type EffectRow = (&'static str, &'static str);

const EFFECTS: &[EffectRow] = &[
    ("shadow-sun", r#"<light id="sun" kind="sun" direction="-1 -2 -1" strength="3"/>"#),
    ("shadow-spot", r#"<light id="sun" kind="spot" at="2 3 1" direction="-2 -3 -1" strength="25"/>"#),
];

/// Returns the names of all pictures of this file.
pub(super) fn names() -> impl Iterator<Item = String> {
    EFFECTS.iter().map(|(name, _)| file_name(name))
}

fn file_name(name: &str) -> String {
    format!("effects/{name}")
}

/// Returns the scene of two foxes in the light of these lamps.
fn foxes(lamps: &str) -> Arc<SceneView> {
    let sun = r#"<light  id="sun"   kind="sun" direction="-1 -2 -1"/>"#;
    let script = scene_bench::FOXES.replace(sun, lamps);
    assert_ne!(script, scene_bench::FOXES);
    let bench = scene_bench::scene(&script);
    bench.state.read().view.and_then(|view| view.scene.clone()).expect("a scene")
}

#[test]
fn the_effects_look_as_stored() {
    match drawing::program_draws_on_processor() {
        Some(true) => {}
        Some(false) => {
            return skip(TestNeed::Adapter, "the stored scenes are those of a driver on the processor");
        }
        None => return,
    }
    let Some(mut studio) = studio() else { return };
    let camera = Camera { target: Vec3::Y * 0.3, distance: 3.6, yaw: 0.5, pitch: 0.45, ..Camera::default() };
    let mut complaints = Vec::new();
    for (name, lamps) in EFFECTS {
        let settings = PictureSettings {
            size: SIZE,
            time: 1.0,
            camera: Some(camera),
            background: Some([120, 130, 140, 255]),
            look: Look { through: ThroughCamera::Free, ..Look::default() },
            ..PictureSettings::default()
        };
        let picture = studio.render_scene(&foxes(lamps), &settings).expect("a picture");
        complaints.extend(reference::compare(&file_name(name), &picture, SCENES));
    }
    assert!(complaints.is_empty(), "\n  {}\n{HOW_TO_UPDATE}", complaints.join("\n  "));
}
