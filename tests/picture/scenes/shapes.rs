//! Shape keys of roles are drawn with the weights that the scene has, also of roles that share a model.

use super::{script, settings, shown, view_of};
use dragonfly_document::{Cancel, LoadedModel, Source, load_model};
use dragonfly_kit::folder::data;
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::posed::PosedModel;
use dragonfly_picture::{Look, PictureSettings, ThroughCamera};
use glam::Vec3;
use std::sync::Arc;

/// Returns a cube whose take moves its two shape keys.
fn cube() -> Arc<LoadedModel> {
    let source = Source::File(data("gltf/AnimatedMorphCube.glb"));
    Arc::new(load_model(&source, &mut |_| {}, &Cancel::default()).unwrap())
}

/// Returns a scene in which each of these roles plays the take, `begin` seconds later than it begins.
fn roles(begins: &[f32]) -> String {
    let cast: String = (0..begins.len())
        .map(|role| format!("<role id=\"r{role}\" model=\"cube\" at=\"{} 0 0\"/>", 4 * role))
        .collect();
    let plays: String = (begins.iter().enumerate())
        .map(|(role, begin)| format!("<play who=\"r{role}\" take=\"Square\" begin=\"{begin}\"/>"))
        .collect();
    script(&cast, &plays)
}

/// Returns the weights that are drawn of the model alone.
fn alone(loaded: &Arc<LoadedModel>, time: f32) -> Vec<f32> {
    let mut posed = PosedModel::new(Arc::clone(loaded));
    posed.pose(Some(0), time, false);
    posed.weights().to_vec()
}

#[test]
fn roles_that_share_a_model_have_weights_of_their_own_and_those_of_the_model_alone() {
    let loaded = cube();
    assert_eq!(loaded.model.animation.takes[0].name, "Square");
    let view = view_of(&roles(&[0.0, 0.5, 2.0]), &loaded);
    for seconds in [0.0_f32, 0.75, 2.0, 3.25] {
        let scene = shown(&view, seconds);
        let drawn: Vec<f32> = scene.draw_sets().flat_map(|set| set.weights().to_vec()).collect();
        let start = loaded.model.animation.takes[0].start;
        let own = |begin: f32| {
            if seconds < begin {
                // Before its take a role has the weights of the model.
                return loaded.model.instances[0].morph_weights.clone();
            }
            alone(&loaded, start + seconds - begin)
        };
        let expected: Vec<f32> = [0.0, 0.5, 2.0].map(own).concat();
        let is_near = drawn.iter().zip(&expected).all(|(drawn, expected)| (drawn - expected).abs() < 1e-6);
        assert!(is_near && drawn.len() == 6, "at {seconds}: {drawn:?} is not {expected:?}");
    }
}

#[test]
fn the_picture_of_a_role_is_that_of_the_model_alone_at_that_time() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = cube();
    let view = view_of(&roles(&[0.0]), &loaded);
    let camera = Camera { target: Vec3::ZERO, distance: 8.0, yaw: 0.5, pitch: 0.4, ..Camera::default() };
    let mut pictures = Vec::new();
    for time in [0.0_f32, 1.0, 2.5] {
        let look = Look { contact_shadow: false, ..settings(ThroughCamera::Free, time).look };
        let settings = PictureSettings {
            look,
            camera: Some(camera),
            take: Some(0),
            ..settings(ThroughCamera::Free, time)
        };
        let role = studio.render_scene(&view, &settings).unwrap();
        let model = studio.render(&loaded, &settings).unwrap();
        let different = difference(&role, &model);
        assert!(different < 20, "{different} pixels at {time}");
        pictures.push(role);
    }
    assert!(difference(&pictures[0], &pictures[1]) > 500, "the shape keys move the cube");
    assert!(difference(&pictures[1], &pictures[2]) > 500, "the shape keys move the cube");
}
