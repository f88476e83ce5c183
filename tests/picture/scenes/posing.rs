//! The things of a scene are where the plan has them, at the exact time of a frame, computed once and without an allocation.

use super::{arms, script, shown, state, view};
use dragonfly_anim::data::Transform;
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_document::SceneView;
use dragonfly_kit::counting;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use glam::{Mat4, Vec3};
use std::time::{Duration, Instant};

/// Returns the matrices of the skin of each copy, as the plan and the skeleton give them, one after another.
fn expected(view: &SceneView, seconds: f64) -> Vec<Mat4> {
    let state = state(view, seconds);
    let plan = view.plan.as_ref().unwrap();
    let roles = plan.things().iter().zip(&state.things).filter(|(thing, _)| thing.model.is_some());
    let matrices =
        |(thing, state): (&dragonfly_anim::stage::PlannedThing, &dragonfly_anim::stage::ThingState)| {
            let model = thing.model.as_ref().unwrap().data();
            let Transform { translation, rotation, scale } = state.transform;
            let place = Mat4::from_scale_rotation_translation(scale, rotation, translation);
            let to_root = |bone: u32| mat4(state.pose.as_ref().unwrap().to_root.get(bone as usize));
            let skin = &model.skins[0];
            let joints =
                skin.bones.iter().zip(&skin.offsets).map(|(&bone, offset)| place * to_root(bone) * *offset);
            let rigid = model
                .instances
                .iter()
                .map(|instance| place * instance.bone.map_or(Mat4::IDENTITY, to_root) * instance.to_bone);
            joints.chain(rigid).collect::<Vec<_>>()
        };
    roles.flat_map(matrices).collect()
}

fn palettes(scene: &Scene) -> Vec<Mat4> {
    scene.draw_sets().flat_map(|set| set.palettes()).map(|&affine| affine.into()).collect()
}

#[test]
fn each_role_has_the_matrices_of_its_pose_at_its_place() {
    let view = view(&arms());
    for seconds in [0.0, 0.37, 1.0, 2.0, 9.0] {
        let (drawn, expected) = (palettes(&shown(&view, seconds)), expected(&view, f64::from(seconds)));
        assert_eq!(drawn.len(), expected.len(), "two copies of one model");
        for (at, (drawn, expected)) in drawn.iter().zip(&expected).enumerate() {
            assert!(
                drawn.abs_diff_eq(*expected, 1e-4),
                "matrix {at} at {seconds}: {drawn} is not {expected}"
            );
        }
    }
}

#[test]
fn the_time_of_a_frame_is_exact() {
    let view = view(&arms());
    let plan = view.plan.as_ref().unwrap();
    for frame in [0, 1, 7, 23, 24, 36] {
        let exact = plan.rate().frame(frame);
        let scene = shown(&view, (frame as f64 / 24.0) as f32);
        assert_eq!(scene.cast().unwrap().state().time, exact, "frame {frame}");
    }
}

#[test]
fn preparing_a_frame_of_a_scene_allocates_nothing() {
    let view = view(&arms());
    let mut scene = shown(&view, 0.0);
    let start = Instant::now();
    scene.look.helpers = true;
    scene.playback = PlaybackClock { playing: true, ..PlaybackClock::of_scene(2.0, start) };
    assert!(scene.moves(start));
    let frames = |scene: &mut Scene| {
        for frame in 0..100 {
            scene.prepare(start + Duration::from_millis(16 * frame));
        }
    };
    // The lists of lines grow once.
    frames(&mut scene);
    let (count, ()) = counting::count(|| frames(&mut scene));
    assert_eq!(count.allocations, 0, "{count:?}");
    assert!(counting::so_far().allocations > 0, "the counter counts");
}

#[test]
fn a_scene_that_stands_still_is_computed_once() {
    let view = view(&arms());
    let mut scene = shown(&view, 0.5);
    let revision = |scene: &Scene| scene.draw_sets().map(|set| set.revision()).collect::<Vec<_>>();
    let first = revision(&scene);
    scene.camera.orbit(0.3, 0.1);
    scene.prepare(Instant::now());
    assert_eq!(revision(&scene), first, "the camera moves nothing");
    assert!(!scene.moves(Instant::now()));
    scene.playback.anchor_time = 0.6;
    scene.prepare(Instant::now());
    assert_ne!(revision(&scene), first);
}

#[test]
fn the_box_around_a_role_has_its_bones_inside_and_bounds_have_all_boxes() {
    let view = view(&arms());
    let scene = shown(&view, 0.8);
    let (cast, state) = (scene.cast().unwrap(), state(&view, 0.8));
    for thing in 0..2 {
        let around = cast.box_of(thing);
        let place = state.things[thing].transform.to_matrix();
        for matrix in state.things[thing].pose.as_ref().unwrap().to_root.matrices() {
            let bone = place.transform_point3(mat4(matrix).w_axis.truncate());
            assert!(
                (around.min - 1e-3).cmple(bone).all() && bone.cmple(around.max + 1e-3).all(),
                "{bone} {around:?}"
            );
        }
        assert!(scene.bounds().contains(around.min) && scene.bounds().contains(around.max));
    }
    assert!(cast.box_of(2).is_empty(), "nothing is drawn of a camera");
}

#[test]
fn a_missing_model_is_shown_as_a_figure_or_a_box_of_human_size() {
    let text = script(
        r#"<role id="anna" model="lost" at="1 0 0" scale="0.01"/><prop id="cup" model="lost" at="0 1 0"/>"#,
        "<wait dur=\"1\"/>",
    );
    let scene = shown(&view(&text), 0.0);
    let [anna, cup] = [0, 1].map(|thing| scene.cast().unwrap().box_of(thing));
    assert!((anna.max.y - 1.75).abs() < 0.01 && anna.min.y.abs() < 0.01, "{anna:?}");
    assert!(anna.contains(Vec3::new(1.0, 0.5, 0.0)));
    assert!((cup.min.y - 1.0).abs() < 0.01 && cup.max.y < 1.5, "{cup:?}");
}

#[test]
fn what_a_new_view_of_a_scene_has_in_common_with_the_old_one_is_kept() {
    let first = view(&arms());
    let mut scene = shown(&first, 0.0);
    let memory = |scene: &Scene| scene.draw_sets().map(|set| set.palettes().as_ptr()).collect::<Vec<_>>();
    let before = memory(&scene);
    let loaded = std::sync::Arc::clone(scene.draw_sets().next().unwrap().loaded());
    scene.show_scene(&super::view_of(&arms().replace("at=\"-2 0 0\"", "at=\"-3 0 0\""), &loaded));
    scene.prepare(Instant::now());
    assert_eq!(memory(&scene), before);
    assert!((scene.cast().unwrap().state().things[0].transform.translation.x + 3.0).abs() < 1e-6);
}
