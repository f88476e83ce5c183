//! The pictures of shots in the timeline: which are asked for and when, and where they are drawn.

use crate::scene_bench::{FOXES, scene};
use crate::workbench::{Window, Workbench, press, release};
use dragonfly::app::scene_thumbnails::ThumbnailLoader;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_picture::{Thumbnail, ThumbnailOrder};
use egui::{Rect, pos2};
use egui_kittest::kittest::Queryable;
use image::RgbaImage;

/// Returns the answer of the graphics thread.
fn drawn(bench: &Workbench, order: ThumbnailOrder) -> Thumbnail {
    let plan = bench.state.read().scene().and_then(|scene| scene.plan.clone());
    let picture = Some(RgbaImage::from_pixel(order.size[0], order.size[1], image::Rgba([200, 30, 10, 255])));
    Thumbnail { order, plan, picture }
}

fn camera(order: &Option<ThumbnailOrder>) -> &str {
    order.as_ref().map_or("none", |order| &order.camera)
}

#[test]
fn each_shot_in_sight_is_asked_for_once_and_one_after_the_other() {
    let mut bench = scene(FOXES);
    let mut loader = ThumbnailLoader::default();
    let first = loader.update(&mut bench.state).expect("an order");
    // The picture has the shape of the image: 1280 x 720.
    assert_eq!((&*first.camera, first.time, first.size), ("wide", 0.0, [142, 80]));
    assert_eq!(camera(&loader.update(&mut bench.state)), "none", "one at a time");
    let answer = drawn(&bench, first);
    assert!(loader.receive(&mut bench.state, answer.clone()));
    assert!(!loader.receive(&mut bench.state, answer), "it was not asked for again");
    let second = loader.update(&mut bench.state);
    assert_eq!((camera(&second), second.as_ref().map(|order| order.time)), ("close", Some(2.0)));
    let answer = drawn(&bench, second.expect("an order"));
    // One that could not be drawn is not asked for again.
    loader.receive(&mut bench.state, Thumbnail { picture: None, ..answer });
    assert_eq!(camera(&loader.update(&mut bench.state)), "none", "all are known");
}

#[test]
fn nothing_is_asked_for_out_of_sight_while_playing_and_of_a_plan_that_the_graphics_thread_does_not_have() {
    let mut bench = scene(FOXES);
    let mut loader = ThumbnailLoader::default();
    bench.state.execute(Request::Command(Id::PlayPause));
    assert_eq!(camera(&loader.update(&mut bench.state)), "none", "it plays");
    bench.state.execute(Request::Command(Id::PlayPause));
    let late = dragonfly::panels::keys::TimeWindow { start: 2.5, length: 0.5 };
    bench.state.execute(Request::Scene(SceneRequest::Window(Some(late))));
    let order = loader.update(&mut bench.state);
    assert_eq!(camera(&order), "close", "the first shot is over by then");
    let older = Thumbnail { plan: None, ..drawn(&bench, order.expect("an order")) };
    loader.receive(&mut bench.state, older);
    assert_eq!(camera(&loader.update(&mut bench.state)), "close", "it is asked for again");
}

/// Returns the rectangles of the pictures in the lanes.
fn pictures(window: &Window) -> Vec<Rect> {
    let canvas = window.query_by_label_contains("Lanes of the scene").expect("lanes").rect();
    let user = |mesh: &egui::Mesh| mesh.texture_id != egui::TextureId::default();
    let shapes = window.output().shapes.iter().filter_map(|shape| match &shape.shape {
        egui::Shape::Mesh(mesh) if user(mesh) => Some(mesh.calc_bounds()),
        egui::Shape::Rect(rect) => {
            rect.brush.as_ref().filter(|brush| brush.fill_texture_id != egui::TextureId::default())?;
            Some(rect.rect)
        }
        _ => None,
    });
    shapes.filter(|rect| canvas.intersects(*rect)).collect()
}

#[test]
fn a_picture_is_at_the_start_of_its_bar_and_stays_until_there_is_a_newer_one() {
    let mut window = scene(FOXES).window();
    assert_eq!(pictures(&window), []);
    let mut loader = ThumbnailLoader::default();
    let order = loader.update(&mut window.state_mut().state).expect("an order");
    let answer = drawn(window.state(), order);
    loader.receive(&mut window.state_mut().state, answer);
    window.run_steps(2);
    let found = pictures(&window);
    let [place] = found[..] else { panic!("one picture: {found:?}") };
    let canvas = window.query_by_label_contains("Lanes of the scene").expect("lanes").rect();
    assert!((place.left() - canvas.left() - 18.0).abs() < 2.0, "{place} in {canvas}");
    assert!(place.height() > 30.0 && (place.width() / place.height() - 142.0 / 80.0).abs() < 0.02, "{place}");
    // The start of the second shot is dragged: a new plan, for which the picture of the first one is asked for again.
    let shots = place.center().y;
    let window_shown = window.state().state.read().scene_editing.window();
    let x = canvas.left() + 16.0 + (canvas.width() - 32.0) * 2.0 / window_shown.length as f32;
    let grip = pos2(x + 2.0, shots);
    press(&mut window, grip);
    window.event(egui::Event::PointerMoved(grip + egui::vec2(40.0, 0.0)));
    window.run_steps(2);
    assert_eq!(camera(&loader.update(&mut window.state_mut().state)), "none", "something is dragged");
    release(&mut window, grip + egui::vec2(40.0, 0.0));
    window.run_steps(3);
    assert_eq!(pictures(&window), [place], "the old picture");
    assert_eq!(camera(&loader.update(&mut window.state_mut().state)), "wide", "asked for again");
}
