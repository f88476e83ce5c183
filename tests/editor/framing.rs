//! Where the eye goes to see the model.

use crate::program::data;
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Request, Settings, State};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_document::{Cancel, Source, View, load_model};
use dragonfly_picture::gizmo::GizmoView;
use glam::{Vec2, Vec3};
use std::sync::Arc;
use std::time::Instant;

#[test]
fn all_is_framed_as_it_stands_now() {
    let source = Source::File(data("gltf/Fox.glb"));
    let mut loaded = load_model(&source, &mut |_| {}, &Cancel::default()).expect("Fox opens");
    // It runs far from where it stands.
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
    assert_eq!(seen.len(), places.len(), "all of the running fox is before the eye");
    let outside = seen.iter().filter(|at| at.min_element() < 0.0 || at.cmpgt(size).any()).count();
    assert_eq!(outside, 0, "of {} vertices", places.len());
}
