//! Paths of a scene as they are drawn, also of very many of them.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::{at, send};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent};
use dragonfly::panels::Request;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_document::bones::Choice;
use dragonfly_document::{SceneView, View};
use glam::DVec3;
use std::fmt::Write;
use std::sync::Arc;

const LINES: &str = r##"<lines version="1">
  <line id="note" points="0 0 0  1 0 0  2 0 0  3 0 0"/>
</lines>
"##;

#[test]
fn thousands_of_paths_with_those_that_follow_them_are_drawn_at_once() {
    // Actions for each path, and things for each action: together ten thousand million steps if each looks through all others.
    let (paths, moves) = (1_500, 4_500);
    let mut text = String::from("<script version=\"1\" fps=\"24\">\n  <cast>\n");
    for path in 0..paths {
        writeln!(text, "    <path id=\"p{path}\" points=\"0 0 {path}  0.02 0 {path}\"/>").expect("a text");
    }
    text += "    <role id=\"anna\" model=\"Fox.glb\" scale=\"0.01\"/>\n  </cast>\n  <seq>\n";
    for at in 0..moves {
        let path = at % paths;
        writeln!(text, "    <move who=\"anna\" path=\"p{path}\" dur=\"1.5\" feet=\"free\"/>")
            .expect("a text");
    }
    text += "  </seq>\n</script>\n";
    let mut bench = scene(&text);
    let now = bench.state.read().now;
    bench.state.begin_frame(now);
    let read = bench.state.read();
    assert!(
        read.scene().expect("a scene").errors.is_empty(),
        "{:?}",
        read.scene().map(|scene| &scene.errors)
    );
    let looks = read.scene_editing.lines().looks();
    assert_eq!(looks.len(), paths);
    // Three of a second and a half each.
    assert!(looks.iter().all(|look| look.ticks.len() == 3), "{:?}", looks[0].ticks);
    assert!(looks.iter().enumerate().all(|(path, look)| look.ticks[0][0].z == path as f32));
}

#[test]
fn a_newer_plan_and_another_selection_leave_the_drawn_lines_as_they_are() {
    let mut bench = scene(FOXES);
    let view = bench.state.read().view.cloned().expect("a view");
    let own = view.scene.as_deref().expect("a scene").clone();
    let lines = Some(Arc::new(DrawnLines::read(LINES).expect("lines")));
    let mut show = |generation: u64, lines: &Option<Arc<DrawnLines>>| {
        let plan = own.plan.as_deref().cloned().map(Arc::new);
        let scene = SceneView { lines: lines.clone(), plan, ..own.clone() };
        let now = bench.state.read().now;
        bench.state.show(View { scene: Some(Arc::new(scene)), generation, ..view.clone() });
        let select = SceneRequest::SelectThings(vec!["aisle".into()], Choice::Toggle);
        bench.state.execute(Request::Scene(select));
        bench.state.begin_frame(now);
        Arc::clone(bench.state.read().scene_editing.lines().looks())
    };
    let first = show(view.generation + 1, &lines);
    let second = show(view.generation + 2, &lines);
    assert_eq!((first.len(), second.len()), (2, 2), "a path and a line");
    assert_ne!(first[0].ink, second[0].ink, "the path was selected and is not any more");
    assert!(Arc::ptr_eq(&first[1].points, &second[1].points), "the line was not sampled again");
    let other = Some(Arc::new(DrawnLines::read(LINES.replace("3 0 0", "4 0 0")).expect("lines")));
    let third = show(view.generation + 3, &other);
    assert_eq!(third[1].points.last().map(|point| point.x), Some(4.0), "a line that was changed was");
}

#[test]
fn while_something_is_dragged_other_paths_are_kept_and_after_it_all_are_drawn_again() {
    let script = FOXES
        .replace("    <mark ", "    <path id=\"other\" points=\"-0.5 0 -0.6  0.5 0 -0.6\"/>\n    <mark ");
    let mut window = scene(&script).window();
    let looks = |window: &Window| window.state().state.read().scene_editing.lines().looks().clone();
    let select = SceneRequest::SelectThings(vec!["other".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.run_steps(2);
    let before = looks(&window);
    assert_eq!(before.len(), 2);
    assert!(before[0].dots.len() >= 3, "ben walks there");
    let [from, to] = [0.5, 0.2].map(|x| at(&window, DVec3::new(x, 0.0, -0.6)));
    send(&mut window, InputEvent::MouseMove(from));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    send(&mut window, InputEvent::MouseMove(to));
    let during = looks(&window);
    assert!(
        Arc::ptr_eq(&before[0].dots, &during[0].dots),
        "the feet on the other path were not looked for again"
    );
    assert!(
        during[1].points.last().is_some_and(|end| (end.x - 0.2).abs() < 0.02),
        "the path that is dragged"
    );
    send(&mut window, InputEvent::MouseUp(Button::Left));
    window.run_steps(2);
    let after = looks(&window);
    assert!(!Arc::ptr_eq(&before[0].dots, &after[0].dots) && before[0] == after[0]);
    assert_eq!(during[1], after[1]);
}

#[test]
fn footprints_of_a_walk_are_those_of_its_action() {
    let bench = scene(FOXES);
    let plan = bench.state.read().scene().and_then(|scene| scene.plan.clone()).expect("a plan");
    let walks: Vec<_> = plan.path_walks().collect();
    assert_eq!(walks.len(), 1, "ben walks");
    let [walk] = walks[..] else { panic!("{walks:?}") };
    assert_eq!(&*plan.things()[walk.thing].id, "ben");
    let prints = plan.footprints_of(walk);
    assert!(prints.len() >= 3 && prints == plan.footprints(walk.thing, walk.action), "{prints:?}");
    assert_eq!(plan.stride_of(walk), plan.stride_on_path(walk.thing, walk.action));
}
