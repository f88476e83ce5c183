//! Things attached to bones: by the pointer, by a file that is dropped, moved where they are held, detached.

use crate::scene_bench::{FOXES, looked, new_lines, scene, text};
use crate::scene_lines::{at, run, send};
use crate::workbench::Window;
use dragonfly::control::{InputEvent, Key};
use dragonfly::panels::commands::Id;
use dragonfly::panels::dropped_files::{DropPlace, DroppedModel, DroppedModels, ModelForm};
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::data::Transform;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use glam::DVec3;
use std::path::PathBuf;

/// The flank of the fox called anna at the start.
const FLANK: DVec3 = DVec3::new(-1.0, 0.45, 0.0);

fn execute(window: &mut Window, request: Request) -> Option<Effect> {
    let effect = window.state_mut().state.execute(request);
    match looked(window, effect) {
        Some(Effect::Change(change)) => {
            window.state_mut().change(change);
            window.run_steps(2);
            None
        }
        other => other,
    }
}

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
    window.run_steps(2);
}

/// Returns where the plan has a thing.
fn placed(window: &Window, id: &str, seconds: f64) -> Transform {
    let read = window.state().state.read();
    let plan = read.scene().and_then(|scene| scene.plan.clone()).expect("a plan");
    let mut state = plan.new_scene();
    plan.scene_at(StageTime::from_seconds(seconds), &mut state);
    state.things[plan.thing_called(id).expect("a thing")].transform
}

fn typed(window: &mut Window, id: Id, keys: &str) {
    run(window, Id::SpaceWorld);
    run(window, id);
    let keys = keys.chars().map(Key::letter).chain([Key::Enter]);
    for key in keys {
        send(window, InputEvent::KeyDown(key));
        send(window, InputEvent::KeyUp(key));
    }
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
}

fn drop_at(window: &mut Window, place: DVec3, file: &str) -> Option<Effect> {
    let pointer = at(window, place);
    send(window, InputEvent::MouseMove(pointer));
    execute(window, Request::Dropped(vec![PathBuf::from(file)]))
}

#[test]
fn an_object_dropped_on_a_bone_is_a_prop_that_the_bone_holds_from_the_start() {
    for form in [ModelForm::Object, ModelForm::Moving] {
        let mut window = scene(FOXES).window();
        // A model that the scene has not read is read first.
        let effect = drop_at(&mut window, FLANK, "/scenes/table.glb");
        let Some(Effect::LookAtModels(unknown)) = effect else { panic!("{effect:?}") };
        let model = |name: &str, form| DroppedModel {
            name: name.to_owned(),
            form,
            scale: 1.0,
            around: AxisBox::EMPTY,
        };
        let models = vec![model("table.glb", form), model("Fox.glb", ModelForm::Figure)];
        let (place, target) = (unknown.place, unknown.target);
        let (sounds, hashes, copied) = (Vec::new(), Vec::new(), None);
        let dropped = DroppedModels { models, place, sounds, hashes, copied, target };
        execute(&mut window, Request::DroppedModels(Box::new(dropped)));
        let new = new_lines(FOXES, &text(&window));
        assert_eq!((new.len(), window.state().steps()), (3, (1, 1)), "{new:?}");
        assert!(new.contains(&r#"<prop id="table" model="table.glb" at="0 0 0"/>"#.to_owned()), "{new:?}");
        // A figure that was dropped along with it is on the ground.
        assert!(new.iter().any(|line| line.starts_with(r#"<role id="Fox" model="Fox.glb""#)), "{new:?}");
        let attach = new.iter().find(|line| line.starts_with("<attach ")).expect("an attachment");
        assert!(attach.starts_with(r#"<attach who="table" to="anna.b_"#), "{new:?}");
        assert!(!attach.contains("begin"), "{new:?}");
        window.state_mut().change(Change::Undo);
        assert_eq!(text(&window), FOXES);
    }
}

#[test]
fn a_figure_dropped_on_a_bone_of_another_role_is_a_role_on_the_ground_below() {
    let mut window = scene(FOXES).window();
    assert_eq!(drop_at(&mut window, FLANK, "/scenes/Fox.glb"), None);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (1, (1, 1)), "{new:?}");
    assert!(new[0].starts_with(r#"<role id="Fox" model="Fox.glb" at=""#), "{new:?}");
    assert!(new[0].ends_with("scale=\"0.028\"/>"), "{new:?}");
    let things = window.state().state.read().scene_editing.things().to_vec();
    assert_eq!(things, [Box::from("Fox")]);
    let place = placed(&window, "Fox", 0.0).translation;
    assert!(place.y == 0.0 && place.distance(glam::Vec3::new(-1.0, 0.0, 0.0)) < 0.4, "{place}");
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_model_dropped_beside_bones_stands_there_as_a_figure_or_an_object() {
    let mut window = scene(FOXES).window();
    assert_eq!(drop_at(&mut window, DVec3::new(0.0, 0.0, 1.5), "/scenes/Fox.glb"), None);
    let new = new_lines(FOXES, &text(&window));
    assert!(new.len() == 1 && new[0].starts_with("<role id=\"Fox\""), "{new:?}");
    // It would be as high as a house.
    assert!(new[0].ends_with("scale=\"0.028\"/>") && said(&window, "not of human size"), "{new:?}");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    // A model that the scene has not read is read first.
    let effect = drop_at(&mut window, DVec3::new(0.0, 0.0, 1.5), "/scenes/table.glb");
    let Some(Effect::LookAtModels(unknown)) = effect else { panic!("{effect:?}") };
    assert_eq!(text(&window), FOXES);
    let DropPlace::At(place) = unknown.place.clone() else { panic!("{unknown:?}") };
    assert!(place.distance(DVec3::new(0.0, 0.0, 1.5)) < 0.02, "{place}");
    let (name, form, around) = ("table.glb".to_owned(), ModelForm::Object, AxisBox::EMPTY);
    let models = vec![DroppedModel { name, form, scale: 1.0, around }];
    let (place, target) = (unknown.place.clone(), unknown.target.clone());
    let (sounds, hashes, copied) = (Vec::new(), Vec::new(), None);
    let dropped = DroppedModels { models, place, sounds, hashes, copied, target };
    execute(&mut window, Request::DroppedModels(Box::new(dropped)));
    let new = new_lines(FOXES, &text(&window));
    assert!(new.len() == 1 && new[0].starts_with(r#"<prop id="table" model="table.glb" at="0"#), "{new:?}");
}

#[test]
fn the_selection_is_attached_to_the_bone_under_the_pointer_stays_there_and_is_detached_again() {
    let mut window = scene(FOXES).window();
    window.state_mut().state.execute(Request::Seek(0.5));
    select(&mut window, &["ben"]);
    let pointer = at(&window, FLANK);
    send(&mut window, InputEvent::MouseMove(pointer));
    run(&mut window, Id::AttachHere);
    let new = new_lines(FOXES, &text(&window));
    assert!(new.len() == 1 && new[0].starts_with(r#"<attach who="ben" to="anna.b_"#), "{new:?}");
    assert!(new[0].contains("offset=") && new[0].contains("begin=\"0.5\""), "{new:?}");
    let [before, then] = [0.25, 0.5].map(|time| placed(&window, "ben", time));
    assert!(before.translation.distance(then.translation) < 1e-3, "{before:?} {then:?}");
    assert!(before.rotation.dot(then.rotation).abs() > 0.99999, "{before:?} {then:?}");
    assert!(said(&window, "it stays where it is"));
    let attached = text(&window);
    window.state_mut().state.execute(Request::Seek(0.75));
    run(&mut window, Id::DetachHere);
    assert_eq!(new_lines(&attached, &text(&window)), [r#"<detach who="ben" begin="0.75"/>"#]);
    let [then, later] = [0.75, 0.95].map(|time| placed(&window, "ben", time).translation);
    assert_eq!(then, later);
    run(&mut window, Id::DetachHere);
    assert!(said(&window, "Nothing that is selected is held"));
}

#[test]
fn without_a_bone_under_the_pointer_the_thing_selected_last_holds_the_others() {
    let mut window = scene(FOXES).window();
    send(&mut window, InputEvent::MouseGone);
    select(&mut window, &["sun"]);
    run(&mut window, Id::AttachHere);
    assert!(said(&window, "Point at the bone or thing"));
    select(&mut window, &["sun", "close", "door"]);
    run(&mut window, Id::AttachHere);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 2, "{new:?}");
    assert!(new.iter().all(|line| line.contains("to=\"door\"")), "{new:?}");
    for id in ["sun", "close"] {
        let now = placed(&window, id, 1.0).translation;
        let wanted = if id == "sun" { glam::Vec3::ZERO } else { glam::Vec3::new(-2.0, 0.6, 2.0) };
        assert!(now.distance(wanted) < 1e-3, "{id} {now}");
    }
}

const HELD: &str = "    <attach who=\"cup\" to=\"anna.b_Head_05\" offset=\"0.1 0 0\"/>\n";

fn held() -> String {
    let cup =
        "    <prop id=\"cup\" model=\"Fox.glb\" at=\"5 0 0\" scale=\"0.002\"/>\n    <camera id=\"wide\"";
    FOXES
        .replacen("    <camera id=\"wide\"", cup, 1)
        .replace("    <shot who=\"wide\"", &format!("{HELD}    <shot who=\"wide\""))
}

#[test]
fn the_gizmo_of_a_held_thing_changes_how_it_is_held() {
    let script = held();
    let mut window = scene(&script).window();
    window.state_mut().state.execute(Request::Seek(0.5));
    select(&mut window, &["cup"]);
    let before = placed(&window, "cup", 0.5);
    typed(&mut window, Id::MoveNow, "y0.3");
    let new = new_lines(&script, &text(&window));
    assert!(
        new.len() == 1 && new[0].starts_with("<attach who=\"cup\"") && !new[0].contains("turn="),
        "{new:?}"
    );
    let after = placed(&window, "cup", 0.5);
    let by = after.translation - before.translation;
    assert!(by.distance(glam::Vec3::Y * 0.3) < 1e-3, "{by}");
    assert!(after.rotation.dot(before.rotation).abs() > 0.999999);
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), script);
    typed(&mut window, Id::RotateNow, "y90");
    let turned = placed(&window, "cup", 0.5);
    let wanted = glam::Quat::from_rotation_y(std::f32::consts::FRAC_PI_2) * before.rotation;
    assert!(turned.rotation.dot(wanted).abs() > 0.99999, "{turned:?} {wanted}");
    assert!(turned.translation.distance(before.translation) < 1e-3);
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn a_drag_of_a_thing_that_still_moves_to_its_bone_is_refused_with_what_to_do() {
    let script = held().replace("offset=\"0.1 0 0\"", "fade-in=\"2\"");
    let mut window = scene(&script).window();
    window.state_mut().state.execute(Request::Seek(1.0));
    select(&mut window, &["cup"]);
    typed(&mut window, Id::MoveNow, "y0.3");
    assert_eq!(text(&window), script);
    assert!(said(&window, "go to the end of its fade-in"));
}
