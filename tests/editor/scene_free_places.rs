//! Roles that are added at a place that another one has: they are put next to it, on the ground.

use crate::scene_bench::{FOXES, looked, new_lines, scene, text};
use crate::scene_lines::{at, send};
use crate::workbench::Window;
use dragonfly::control::InputEvent;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneModel;
use dragonfly_document::bones::Choice;
use glam::{DVec3, Vec3};
use std::path::PathBuf;

/// A scene in which a role has the place of the next one.
fn occupied() -> String {
    FOXES.replace("at=\"1 0 0\"", "at=\"2 0 0\"")
}

/// Adds models, as a command or by a drop.
fn add(window: &mut Window, request: Request) {
    let effect = window.state_mut().state.execute(request);
    let Some(Effect::Change(change)) = looked(window, effect) else { panic!("no change") };
    window.state_mut().change(change);
    window.run_steps(2);
}

fn by_command() -> Request {
    Request::AddRole("/scenes/Fox.glb".into())
}

fn by_drop(count: usize) -> Request {
    Request::Dropped(vec![PathBuf::from("/scenes/Fox.glb"); count])
}

/// Returns the places of the roles, and the boxes around them.
fn roles(window: &Window) -> Vec<(Vec3, AxisBox)> {
    let read = window.state().state.read();
    let scene = read.scene().expect("a scene");
    let Some(SceneModel::Loaded(fox)) = scene.models.get("Fox.glb") else { panic!("no model") };
    let own = AxisBox { min: fox.bounds.min, max: fox.bounds.max };
    let plan = scene.plan.clone().expect("a plan");
    let mut state = plan.new_scene();
    plan.scene_at(StageTime::ZERO, &mut state);
    let things = plan.things().iter().zip(&state.things).filter(|(thing, _)| thing.kind == "role");
    things.map(|(_, state)| (state.transform.translation, own.moved(&state.transform.to_matrix()))).collect()
}

fn cuts(one: &AxisBox, other: &AxisBox) -> bool {
    one.min.cmplt(other.max).all() && one.max.cmpgt(other.min).all()
}

#[track_caller]
fn stand_apart(window: &Window, count: usize) {
    let roles = roles(window);
    assert_eq!(roles.len(), count);
    for (index, (place, around)) in roles.iter().enumerate() {
        assert_eq!(place.y, 0.0, "{place} is not on the ground");
        for (other, beside) in &roles[index + 1..] {
            assert!(!cuts(around, beside), "{place} and {other}: {around:?} and {beside:?}");
        }
    }
}

#[test]
fn roles_that_are_added_by_command_stand_next_to_the_others_and_always_at_the_same_places() {
    let script = occupied();
    let texts = [0, 1].map(|_| {
        let mut window = scene(&script).window();
        for count in 3..6 {
            add(&mut window, by_command());
            stand_apart(&window, count);
        }
        text(&window)
    });
    assert_eq!(texts[0], texts[1]);
    // The first one is as near as its size allows.
    let mut window = scene(&script).window();
    add(&mut window, by_command());
    let roles = roles(&window);
    let (place, around) = roles[2];
    let wanted = Vec3::new(2.0, 0.0, 0.0);
    assert!(place.distance(wanted) < (around.half() + roles[1].1.half()).length() + 0.2, "{place}");
}

#[test]
fn a_role_is_put_at_its_usual_place_where_nothing_stands_there() {
    let script = FOXES.replace("at=\"1 0 0\"", "at=\"40 0 0\"").replace("at=\"-1 0 0\"", "at=\"-40 0 0\"");
    let mut window = scene(&script).window();
    add(&mut window, by_command());
    let new = new_lines(&script, &text(&window));
    assert!(new.len() == 1 && new[0].contains("at=\"2 0 0\""), "{new:?}");
}

#[test]
fn models_that_are_dropped_while_the_pointer_is_elsewhere_stand_apart_in_one_step() {
    let mut window = scene(FOXES).window();
    let apart = |window: &Window| {
        let roles = roles(window);
        !cuts(&roles[0].1, &roles[1].1)
    };
    assert!(apart(&window));
    add(&mut window, by_drop(3));
    assert_eq!(window.state().steps(), (1, 1));
    stand_apart(&window, 5);
}

#[test]
fn a_model_that_is_dropped_with_the_pointer_stands_where_it_was_dropped() {
    let mut window = scene(FOXES).window();
    let wanted = DVec3::new(1.0, 0.0, 0.35);
    let pointer = at(&window, wanted);
    send(&mut window, InputEvent::MouseMove(pointer));
    add(&mut window, by_drop(1));
    let roles = roles(&window);
    assert!(roles[2].0.distance(wanted.as_vec3()) < 0.4, "{}", roles[2].0);
    assert!(cuts(&roles[1].1, &roles[2].1), "also where another role stands");
}

#[test]
fn a_role_that_is_added_out_of_sight_is_brought_into_view_and_another_one_leaves_the_view() {
    let camera = |window: &Window| window.state().state.read().camera;
    let mut window = scene(&occupied()).window();
    let before = camera(&window);
    add(&mut window, by_command());
    assert_eq!(camera(&window), before, "it is in sight");
    // Far to the side of what is shown.
    let mut window =
        scene(&FOXES.replace("at=\"1 0 0\"", "at=\"40 0 0\"").replace("at=\"-1 0 0\"", "at=\"40 0 2\""))
            .window();
    window
        .state_mut()
        .state
        .execute(Request::Scene(SceneRequest::SelectThings(vec!["anna".into()], Choice::Replace)));
    window.state_mut().state.execute(Request::Command(Id::FrameSelected));
    window.run_steps(2);
    let before = camera(&window);
    assert!(before.target.x > 30.0, "{before:?}");
    add(&mut window, by_command());
    let (place, _) = roles(&window)[2];
    let after = camera(&window);
    assert!(place.x < 10.0 && after.target.distance(place) < 2.0, "{place} {after:?}");
}
