//! Titles in the image of a camera through which the window looks.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::workbench::Window;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use egui::{Rect, Shape, vec2};
use egui_kittest::kittest::Queryable;

const NAME: &str = "Title: The End";

fn seek(window: &mut Window, time: f32) {
    window.state_mut().state.execute(Request::Seek(time));
    window.run_steps(2);
}

fn titles(window: &Window) -> Vec<Rect> {
    window.query_all_by_label(NAME).map(|node| node.rect()).collect()
}

/// Returns the place of an image of 16 to 9 in a viewport.
fn image_in(viewport: Rect) -> Rect {
    let width = viewport.width().min(viewport.height() * 16.0 / 9.0);
    Rect::from_center_size(viewport.center(), vec2(width, width * 9.0 / 16.0))
}

#[test]
fn a_title_is_shown_in_the_image_of_the_camera_at_its_place_and_at_its_times() {
    let text = FOXES.replace("text=\"The End\"", "text=\"The End\" at=\"0.25 0.8\"");
    let mut window = scene(&text).window();
    seek(&mut window, 4.8);
    assert!(titles(&window).is_empty(), "the free camera has no image");
    run(&mut window, Id::LookThroughShot);
    window.run_steps(2);
    let image = image_in(window.state().state.read().viewport);
    let [title] = titles(&window)[..] else { panic!("{:?}", titles(&window)) };
    let share = (title.center() - image.min) / image.size();
    assert!((share - vec2(0.25, 0.8)).length() < 0.01, "{share}");
    // A line is 7 % of the height of the image, apart from the space between lines.
    let height = title.height() / image.height();
    assert!((0.065..0.1).contains(&height), "{height}");
    for (time, is_shown) in [(3.9, false), (4.1, true), (4.9, true), (5.1, false)] {
        seek(&mut window, time);
        assert_eq!(titles(&window).len(), usize::from(is_shown), "{time} s");
    }
}

#[test]
fn the_second_view_has_the_titles_of_the_shot() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToggleSecondView);
    seek(&mut window, 4.8);
    let second = window.state().state.read().second_view.expect("a second view");
    let [title] = titles(&window)[..] else { panic!("{:?}", titles(&window)) };
    assert!((title.center() - image_in(second).center()).length() < 1.0, "{title} {second}");
    run(&mut window, Id::LookThroughShot);
    window.run_steps(2);
    assert_eq!(titles(&window).len(), 2, "each view has its own");
}

#[test]
fn the_guides_of_the_image_are_behind_its_titles() {
    // A third of the image, where a guide is.
    let text = FOXES.replace("text=\"The End\"", "text=\"The End\" at=\"0.5 0.6667\"");
    let mut window = scene(&text).window();
    run(&mut window, Id::LookThroughShot);
    if !window.state().state.read().settings.look.image_guides {
        run(&mut window, Id::ToggleImageGuides);
    }
    seek(&mut window, 4.8);
    let [title] = titles(&window)[..] else { panic!("{:?}", titles(&window)) };
    let shapes = &window.output().shapes;
    let is_title = |shape: &Shape| matches!(shape, Shape::Text(text) if text.galley.text() == "The End");
    let last = shapes.iter().rposition(|clipped| is_title(&clipped.shape)).expect("the title");
    let crosses = |shape: &Shape| {
        matches!(shape, Shape::LineSegment { points: [from, to], .. }
            if from.y == to.y && title.y_range().contains(from.y) && from.x < title.left() && to.x > title.right())
    };
    let lines: Vec<usize> = (0..shapes.len()).filter(|&at| crosses(&shapes[at].shape)).collect();
    assert!(!lines.is_empty() && lines.iter().all(|&line| line < last), "{lines:?}, the title is {last}");
}
