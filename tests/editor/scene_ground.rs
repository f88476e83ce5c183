//! Things of a scene on the ground: snapped while they are moved, dropped, added where a file is dropped.

use crate::scene_bench::{FOXES, looked, new_lines, scene, text};
use crate::scene_lines::{at, run, send};
use crate::workbench::Window;
use dragonfly::control::{InputEvent, Key};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use dragonfly_kit::counting::count;
use dragonfly_picture::PosedScene;
use glam::DVec3;

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
    window.run_steps(2);
}

fn type_keys(window: &mut Window, keys: &[Key]) {
    for key in keys {
        send(window, InputEvent::KeyDown(*key));
        send(window, InputEvent::KeyUp(*key));
    }
}

/// Returns a scene in which ben is half a meter above the ground, and a fox that is a prop three meters.
fn floating() -> String {
    let toy = "<prop id=\"toy\" model=\"Fox.glb\" at=\"0 3 2\" scale=\"0.01\"/>";
    FOXES.replace("at=\"1 0 0\"", "at=\"1 0.5 0\"").replace("<mark ", &format!("{toy}\n    <mark "))
}

#[test]
fn a_thing_that_is_moved_stays_on_the_ground_while_it_snaps() {
    let script = floating();
    let mut window = scene(&script).window();
    run(&mut window, Id::SpaceWorld);
    select(&mut window, &["ben"]);
    let letter = Key::letter;
    // Along x by one meter.
    let typed = [letter('x'), letter('1'), Key::Enter];
    run(&mut window, Id::MoveNow);
    type_keys(&mut window, &typed);
    assert!(new_lines(&script, &text(&window))[0].contains("at=\"2 0.5 0\""));
    run(&mut window, Id::Undo);
    run(&mut window, Id::ToggleGroundSnap);
    run(&mut window, Id::MoveNow);
    type_keys(&mut window, &typed);
    let new = new_lines(&script, &text(&window));
    assert!(new.len() == 1 && new[0].contains("at=\"2 0 0\""), "{new:?}");
}

#[test]
fn what_is_dropped_to_the_ground_stands_on_it() {
    let script = floating();
    let mut window = scene(&script).window();
    select(&mut window, &["ben", "toy"]);
    run(&mut window, Id::DropToGround);
    let new = new_lines(&script, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (2, (1, 1)), "{new:?}");
    assert!(new[0].contains("at=\"1 0 0\""), "{new:?}");
    let panels = window.state().state.read();
    let mut posed = PosedScene::new(panels.scene().expect("a scene"), &[], None).expect("a plan");
    posed.pose(0.0);
    let toy = posed.plan().thing_called("toy").expect("a prop");
    assert!(posed.box_of(toy).min.y.abs() < 2e-3, "{:?}", posed.box_of(toy));
    select(&mut window, &["sun"]);
    run(&mut window, Id::DropToGround);
    let said =
        window.state().state.read().status.last().map(|message| message.text.clone()).unwrap_or_default();
    assert!(said.contains("can stand") && window.state().steps().1 == 1, "{said}");
}

/// Drops files while the pointer is over a place of the ground. Returns the places of the roles that are new.
fn dropped_at(window: &mut Window, place: DVec3, files: &[&str]) -> Vec<DVec3> {
    let pointer = at(window, place);
    send(window, InputEvent::MouseMove(pointer));
    let files = files.iter().map(|file| (*file).into()).collect();
    let effect = window.state_mut().state.execute(Request::Dropped(files));
    let change = match looked(window, effect) {
        Some(Effect::Change(change)) => change,
        other => panic!("{other:?}"),
    };
    window.state_mut().change(change);
    let place_of = |line: &String| {
        let place = line.split("at=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a place");
        let numbers: Vec<f64> = place.split(' ').map(|number| number.parse().expect("a number")).collect();
        DVec3::from_slice(&numbers)
    };
    new_lines(FOXES, &text(window)).iter().map(place_of).collect()
}

#[test]
fn a_model_that_is_dropped_stands_under_the_pointer() {
    let mut window = scene(FOXES).window();
    let wanted = DVec3::new(0.5, 0.0, 1.0);
    let places = dropped_at(&mut window, wanted, &["/scenes/Fox.glb"]);
    assert_eq!(places.len(), 1, "{places:?}");
    assert!(places[0].distance(wanted) < 0.02, "{places:?}");
}

#[test]
fn models_that_are_dropped_together_stand_side_by_side_a_meter_apart() {
    let mut window = scene(FOXES).window();
    let wanted = DVec3::new(-0.5, 0.0, 1.0);
    let files = ["/scenes/Fox.glb", "/scenes/Fox.glb", "/scenes/Fox.glb"];
    let places = dropped_at(&mut window, wanted, &files);
    assert_eq!((places.len(), window.state().steps()), (3, (1, 1)), "{places:?}");
    assert!(places[0].distance(wanted) < 0.02, "{places:?}");
    for pair in places.windows(2) {
        assert!((pair[1] - pair[0]).distance(DVec3::X) < 1e-9, "{places:?}");
    }
}

#[test]
fn only_props_that_are_moved_are_posed_to_find_the_ground() {
    let roles: String = (0..200)
        .map(|at| format!("    <role id=\"r{at}\" model=\"Fox.glb\" at=\"{at} 0 9\" scale=\"0.01\"/>\n"))
        .collect();
    let mut window = scene(&floating().replace("  </cast>\n", &format!("{roles}  </cast>\n"))).window();
    let view = window.state().state.read().scene().cloned().expect("a scene");
    let (all, _) = count(|| PosedScene::new(&view, &[], None).map(|mut posed| posed.pose(0.0)));
    let mut needed = |id: &str| {
        select(&mut window, &[id]);
        let (count, effect) = count(|| window.state_mut().state.execute(Request::Command(Id::DropToGround)));
        let Some(Effect::Change(change)) = effect else { panic!("{effect:?}") };
        window.state_mut().change(change);
        window.run_steps(2);
        count.bytes
    };
    let [role, prop] = [needed("ben"), needed("toy")];
    // To pose the fox costs about as much as to pose all of them: they share its data.
    assert!(role + all.bytes / 2 < prop, "{role} for a role, {prop} for a prop, {all:?} for all");
}
