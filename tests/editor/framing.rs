//! Placement of the camera when the model is framed.

use dragonfly::panels::commands::Id;
use dragonfly::panels::{Request, Settings, State};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_document::{Cancel, Source, View, load_model};
use dragonfly_kit::folder::data;
use dragonfly_kit::picture::images::{difference, settings};
use dragonfly_kit::picture::studio;
use dragonfly_picture::PictureSettings;
use dragonfly_picture::gizmo::GizmoView;
use glam::{Vec2, Vec3};
use std::sync::Arc;
use std::time::Instant;

#[test]
fn framing_uses_the_current_pose() {
    let source = Source::File(data("gltf/Fox.glb"));
    let mut loaded = load_model(&source, &mut |_| {}, &Cancel::default()).expect("Fox opens");
    // The take moves the model far away from its rest position.
    let take = Arc::make_mut(&mut Arc::make_mut(&mut loaded.model).animation.takes[2]);
    let hip = take.tracks.iter_mut().find(|track| !track.translation.is_empty()).expect("the hip moves");
    hip.translation.values = hip.translation.values.iter().map(|place| *place + Vec3::splat(300.0)).collect();
    let mut state = State::new(Settings::default(), Instant::now());
    let size = Vec2::new(780.0, 430.0);
    state.execute(Request::Viewport(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(size.x, size.y))));
    let mut evaluator = Evaluator::new(Arc::clone(&loaded.model));
    state.show(View::opened(1, Arc::new(loaded)));
    state.pause();
    state.execute(Request::ShowTake(Some(2)));
    state.execute(Request::Seek(0.1));
    state.execute(Request::Command(Id::ViewRight));
    state.execute(Request::Command(Id::FrameAll));
    evaluator.pose(Some(2), 0.1);
    let view = GizmoView::new(&state.read().camera, size);
    let places = evaluator.all_positions();
    let seen: Vec<Vec2> =
        places.iter().filter_map(|place| view.to_screen(place.as_dvec3())).map(|at| at.as_vec2()).collect();
    assert_eq!(seen.len(), places.len(), "all of the running fox is in front of the camera");
    let outside = seen.iter().filter(|at| at.min_element() < 0.0 || at.cmpgt(size).any()).count();
    assert_eq!(outside, 0, "of {} vertices", places.len());
}

#[test]
fn a_skeleton_without_meshes_is_shown_and_framed() {
    let source = Source::File(data("gltf/Fox_skeleton.glb"));
    let loaded = Arc::new(load_model(&source, &mut |_| {}, &Cancel::default()).unwrap());
    let (animation, warnings) = (&loaded.model.animation, &loaded.warnings);
    assert_eq!((animation.skeleton.bones.len(), animation.takes.len()), (25, 3));
    assert!(loaded.model.instances.is_empty() && warnings.is_empty(), "{warnings:?}");

    // The editor shows the bones, although its settings do not ask for them.
    let mut state = State::new(Settings::default(), Instant::now());
    assert!(!state.read().settings.look.skeleton && !state.read().shows_skeleton());
    state.show(View::opened(1, Arc::clone(&loaded)));
    assert!(state.read().shows_skeleton());

    let Some(mut studio) = studio::studio() else { return };
    let mut with = |skeleton| {
        let settings = PictureSettings { skeleton, grid: false, ..settings() };
        studio.render(&loaded, &settings).unwrap()
    };
    let (bones, empty) = (with(true), with(false));
    let seen = difference(&bones, &empty);
    assert!(seen > 500, "only {seen} pixels show a bone");
    // The model is framed: the bones cover much of the image and do not touch its edges.
    let columns: Vec<u32> =
        (0..160).filter(|&x| (0..120).any(|y| bones.get_pixel(x, y) != empty.get_pixel(x, y))).collect();
    let (first, last) = (columns[0], columns[columns.len() - 1]);
    assert!(first > 2 && last < 157, "columns {first} to {last}");
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn a_skeleton_with_far_cameras_is_framed_without_them() {
    let source = Source::File(data("gltf/Fox_skeleton.glb"));
    let mut loaded = load_model(&source, &mut |_| {}, &Cancel::default()).expect("the skeleton opens");
    let animation = &mut Arc::make_mut(&mut loaded.model).animation;
    let skeleton = Arc::make_mut(&mut animation.skeleton);
    let own = skeleton.len();
    let mut camera = skeleton.bones[0].clone();
    (camera.name, camera.parent, camera.rest.translation) =
        ("Camera01".to_owned(), None, Vec3::splat(5000.0));
    skeleton.bones.push(camera);
    loaded.bounds.max = Vec3::splat(5000.0);
    let mut state = State::new(Settings::default(), Instant::now());
    let size = Vec2::new(780.0, 430.0);
    state.execute(Request::Viewport(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(size.x, size.y))));
    let mut moving = dragonfly_anim::animation::Animation::of(&loaded.model);
    state.show(View::opened(1, Arc::new(loaded)));
    let view = GizmoView::new(&state.read().camera, size);
    let places = moving.to_root_bone_poses(state.read().playback.take, 0.0)[..own].to_vec();
    let seen = places.iter().filter_map(|place| view.to_screen(place.w_axis.truncate().as_dvec3()));
    let seen: Vec<Vec2> = seen.map(|at| at.as_vec2()).collect();
    let inside = seen.iter().filter(|at| at.min_element() > 0.0 && at.cmplt(size).all()).count();
    assert_eq!(inside, own, "all bones of the figure");
    let [top, bottom] = seen.iter().fold([f32::MAX, f32::MIN], |[a, b], at| [a.min(at.y), b.max(at.y)]);
    assert!(bottom - top > 0.4 * size.y, "{top} to {bottom}");
}
