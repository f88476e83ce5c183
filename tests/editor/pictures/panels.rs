//! Every panel alone at its usual size, the menu bar and the status line.

use super::series::{self, Crop, PictureCase};
use super::states::Fullness::{self, Crowded, Empty, Typical};
use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::commands::Id;
use dragonfly::panels::compared::CompareWith;
use dragonfly::panels::keys::KeysRequest;
use dragonfly::panels::open_model::Loading;
use dragonfly::panels::selection_sets::SetAction;
use dragonfly::panels::window_status::DeviceStatus;
use dragonfly::panels::{self, Effect, FileAction, PanelSubject, Request, style};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, Property, SetEvents, SetPose, TakeEvent, TakeRef};
use dragonfly_document::{
    Change, DocumentMessage, LoadStage, PoseFile, PoseFolder, Progress, StoredPose, View,
};
use egui::{Key, vec2};
use egui_kittest::kittest::Queryable;

/// The panels with their usual size in points, each with the test that draws it.
macro_rules! panels {
    ($($id:literal, [$width:literal, $height:literal], $test:ident;)*) => {
        /// Id and size of each panel.
        const SIZES: &[(&str, [f32; 2])] = &[$(($id, [$width, $height])),*];

        $(#[test]
        fn $test() {
            series::compare(panel($id, [$width, $height]));
        })*
    };
}

panels! {
    "hierarchy", [250.0, 330.0], the_skeleton_panel_looks_as_stored;
    "takes", [250.0, 250.0], the_takes_panel_looks_as_stored;
    "layers", [250.0, 250.0], the_layers_panel_looks_as_stored;
    "viewport", [720.0, 400.0], the_viewport_panel_looks_as_stored;
    "properties", [300.0, 520.0], the_properties_panel_looks_as_stored;
    "history", [300.0, 250.0], the_history_panel_looks_as_stored;
    "timeline", [720.0, 220.0], the_timeline_panel_looks_as_stored;
    "curves", [520.0, 220.0], the_curves_panel_looks_as_stored;
    "poses", [520.0, 220.0], the_poses_panel_looks_as_stored;
    "shapes", [520.0, 220.0], the_shape_keys_panel_looks_as_stored;
    "inbetween", [520.0, 220.0], the_inbetween_panel_looks_as_stored;
    "differences", [520.0, 220.0], the_differences_panel_looks_as_stored;
    "outliner", [250.0, 420.0], the_scene_panel_looks_as_stored;
    "scene_timeline", [1000.0, 240.0], the_scene_timeline_looks_as_stored;
    "scene_attributes", [210.0, 130.0], the_attributes_panel_looks_as_stored;
    "script", [1000.0, 320.0], the_script_panel_looks_as_stored;
    "shots", [250.0, 120.0], the_list_of_shots_looks_as_stored;
}

/// Returns whether a panel is shown for scenes.
fn of_scene(id: &str) -> bool {
    panels::all().iter().any(|panel| panel.id() == id && panel.subject() == PanelSubject::Scene)
}

/// Returns a window in which all panels but one are hidden.
pub(super) fn only(id: &str, fullness: Fullness) -> Workbench {
    let mut bench = if of_scene(id) { fullness.scene() } else { fullness.bench() };
    for other in panels::all().iter().filter(|other| other.id() != id) {
        bench.desk.toggle_panel(other.id());
    }
    bench
}

/// Returns a panel without the others, in every state.
fn panel(id: &'static str, [width, height]: [f32; 2]) -> Vec<PictureCase> {
    let case = |fullness: Fullness| PictureCase {
        name: format!("panels/{id}-{}", fullness.word()),
        size: vec2(width, height + style::BAR + series::STATUS),
        crop: Crop::Middle,
        bench: Box::new(move || only(id, fullness)),
        act: Box::new(|_| {}),
        // Two points a pixel differ in nothing that depends on how full a panel is. Panels of scenes have no widgets of their own.
        twice: matches!(fullness, Typical) && !of_scene(id),
    };
    Fullness::ALL.map(case).into()
}

/// Returns panels in states that need more than a model: something is typed, renamed, hidden, loaded or broken.
fn more() -> Vec<PictureCase> {
    let case = |name: &str, id: &str, fullness, act: fn(&mut Window)| {
        let (id, size) = SIZES.iter().find(|(other, _)| *other == id).expect("a panel");
        let mut cases = panel(id, *size);
        let place = Fullness::ALL.iter().position(|other| *other == fullness).expect("a state");
        PictureCase {
            name: format!("panels/{name}"),
            act: Box::new(act),
            twice: false,
            ..cases.swap_remove(place)
        }
    };
    vec![
        case("hierarchy-hidden", "hierarchy", Typical, |window| {
            window.state_mut().state.execute(Request::Hide { bones: vec![2, 3], hide: true });
        }),
        case("hierarchy-nothing-found", "hierarchy", Typical, |window| {
            type_into(window, "Find a bone", "no such bone", Key::F12);
        }),
        case("takes-rename", "takes", Typical, |window| type_into(window, "hover", "", Key::F2)),
        case("takes-refused-name", "takes", Typical, |window| {
            type_into(window, "hover", "", Key::F2);
            type_into(window, "Name of the take", " ", Key::Enter);
        }),
        case("layers-three", "layers", Typical, |window| {
            for line in [
                r#"{"edit":"add_layer","take":0,"name":"Head up"}"#,
                r#"{"edit":"add_layer","take":0,"name":"Arms from another take, with a long name","kind":"override"}"#,
                r#"{"edit":"add_layer","take":0,"name":"Breath"}"#,
                r#"{"edit":"set_layer","take":{"take":0,"layer":0},"weight":0.4}"#,
                r#"{"edit":"set_layer","take":{"take":0,"layer":1},"muted":true}"#,
                r#"{"edit":"set_layer","take":{"take":0,"layer":2},"solo":true}"#,
            ] {
                let edit = serde_json::from_str(line).expect(line);
                window.state_mut().change(Change::Edit(edit, None));
            }
            let chosen = window.state().state.read().layers()[0].keys.id;
            window.state_mut().state.execute(Request::ChooseLayer(Some(chosen)));
        }),
        case("timeline-weight", "timeline", Typical, |window| {
            for line in [
                r#"{"edit":"add_layer","take":0,"name":"Head up"}"#,
                r#"{"edit":"set_layer_weights","take":{"take":0,"layer":0},"keys":[{"time":0.2,"weight":0},{"time":0.4,"weight":1},{"time":0.7,"weight":1.5},{"time":0.9,"weight":0.2},{"time":1.5,"weight":1.5}]}"#,
            ] {
                let edit = serde_json::from_str(line).expect(line);
                window.state_mut().change(Change::Edit(edit, None));
            }
            let chosen = window.state().state.read().layers()[0].keys.id;
            window.state_mut().state.execute(Request::ChooseLayer(Some(chosen)));
        }),
        case("hierarchy-sets", "hierarchy", Typical, |window| {
            let state = &mut window.state_mut().state;
            for (set, (bones, name)) in
                [(vec![2, 3], "Neck"), (vec![4], "Head"), (vec![5, 6, 7], "Left wing with its feathers")]
                    .into_iter()
                    .enumerate()
            {
                state.execute(Request::SelectBones(bones, Choice::Replace));
                state.execute(Request::Command(Id::SaveSelectionSet));
                state.execute(Request::Sets(SetAction::Rename(set, name.to_owned())));
            }
        }),
        case("shapes-face", "shapes", Typical, |window| {
            let names = [
                "jawOpen",
                "eyeBlinkLeft",
                "eyeBlinkRight",
                "eyeLookUpLeft",
                "browInnerUp",
                "browDownLeft",
                "mouthSmileLeft",
                "mouthSmileRight",
                "mouthFunnel",
                "cheekPuff",
                "noseSneerLeft",
                "tongueOut",
                "happy",
                "aa",
                "a shape key with a very long name",
            ];
            window.state_mut().state.show(crate::shape_keys::with_names(&names));
            window.state_mut().state.pause();
            window.state_mut().state.execute(Request::Seek(1.2));
        }),
        case("poses-three", "poses", Typical, |window| {
            let state = &mut window.state_mut().state;
            state.set_usual_pose_folder(Some("/home/ada/poses".into()));
            let pose = |name: &str, tags: &[&str], bones: &[(u32, f32)]| {
                let turned = |&(bone, angle): &(u32, f32)| {
                    let rotation = Some(glam::Quat::from_rotation_z(angle).to_array());
                    BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None }
                };
                let tags = tags.iter().map(|tag| (*tag).to_owned()).collect();
                let pose = StoredPose::new(name.to_owned(), tags, bones.iter().map(turned).collect());
                PoseFile { file: format!("{name}.pose.json"), pose }
            };
            let poses = vec![
                pose("Look up", &["head"], &[(4, 0.5)]),
                pose("Neck bent to the side", &["neck", "calm"], &[(2, 0.5), (3, 0.5), (4, 0.3)]),
                pose("Rest", &[], &[(0, 0.0), (1, 0.0)]),
            ];
            let problems = vec!["Crow.pose.json: this is no pose".to_owned()];
            state.poses_read(PoseFolder { folder: "/home/ada/poses".into(), poses, problems });
            window.run_steps(3);
            window.get_by_label("Neck bent to the side").click();
        }),
        case("viewport-loading", "viewport", Empty, |window| {
            let progress = Progress { stage: LoadStage::Decoding, done: 0.6 };
            window.state_mut().state.set_loading(Some(Loading { title: "Fox.glb".to_owned(), progress }));
        }),
        case("viewport-paused", "viewport", Typical, |window| {
            let reason = "the device was lost three times within a minute".to_owned();
            window.state_mut().state.window_mut().set_device(DeviceStatus::Paused { reason });
        }),
        case("properties-model", "properties", Typical, |window| {
            window.state_mut().state.execute(Request::Select(None));
        }),
        case("properties-refused", "properties", Typical, |window| {
            type_into(window, "Rotation result Y", "12..5", Key::Enter);
        }),
        case("properties-expression", "properties", Typical, |window| {
            type_into(window, "Rotation result Y", "45/2 + pi/8 rad", Key::F12);
        }),
        case("properties-quaternion", "properties", Typical, |window| {
            window.get_by_label("Show the quaternion").click();
        }),
        case("timeline-rest-pose", "timeline", Typical, |window| {
            window.state_mut().state.execute(Request::ShowTake(None));
        }),
        case("timeline-marks", "timeline", Typical, |window| {
            for id in [Id::AddMarker, Id::SelectAllKeys, Id::RangeFromHere] {
                window.state_mut().state.execute(Request::Command(id));
            }
        }),
        case("timeline-contacts", "timeline", Typical, |window| {
            for line in [
                r#"{"edit":"set_contacts","take":0,"contacts":[{"bone":4,"from":0.05,"to":0.35},{"bone":4,"from":0.6,"to":0.9},{"bone":7,"from":0.3,"to":0.7}]}"#,
                r#"{"edit":"resample_keys","take":0,"keys":[{"bones":[4]}],"rate":120}"#,
            ] {
                let edit = serde_json::from_str(line).expect(line);
                window.state_mut().change(Change::Edit(edit, None));
            }
            let state = &mut window.state_mut().state;
            state.execute(Request::Command(Id::AddMarker));
            state.execute(Request::Command(Id::ToggleProblems));
            if let Some(Effect::File(FileAction::Send(DocumentMessage::CheckTake(check)))) =
                state.wanted_check()
            {
                state.checked(check.run(None).expect("findings"));
            }
        }),
        case("timeline-whole-take", "timeline", Typical, |window| {
            window.state_mut().state.execute(Request::Command(Id::EditWholeTake));
        }),
        case("timeline-falloff", "timeline", Typical, |window| {
            let state = &mut window.state_mut().state;
            let channels = std::sync::Arc::from([(4, Property::Rotation)]);
            let (shapes, stretch, choice) = (false, [0.75, 1.05], Choice::Replace);
            state.execute(Request::Timeline(KeysRequest::Select { channels, shapes, stretch, choice }));
            for id in [Id::EditSelectedKeys, Id::ToggleFalloff] {
                state.execute(Request::Command(id));
            }
        }),
        case("timeline-events", "timeline", Typical, |window| {
            let event = |time: f32, name: &str, payload: Option<serde_json::Value>| TakeEvent {
                time,
                name: name.to_owned(),
                payload,
            };
            let step = Some(serde_json::json!({ "foot": "left" }));
            let events = vec![event(0.25, "step", step), event(1.1, "breath", None)];
            let edit = SetEvents { take: TakeRef::Index(0), events };
            window.state_mut().change(Change::Edit(edit.into(), None));
        }),
        case("differences-moved", "differences", Typical, |window| {
            window.state_mut().state.execute(Request::CompareWith(CompareWith::Opened));
            let turn = glam::Quat::from_rotation_z(0.4).to_array();
            let (bone, rotation) = (BoneRef::Index(2), Some(turn));
            let pose = BonePose { bone, translation: None, rotation, scale: None };
            let (take, time) = (TakeRef::Index(0), 0.25);
            let edit = Edit::SetPose(SetPose { take, time, poses: vec![pose], unstep: true });
            window.state_mut().change(Change::Edit(edit, None));
        }),
        case("inbetween-keys", "inbetween", Typical, |window| {
            window.state_mut().state.execute(Request::Command(Id::SelectAllKeys));
        }),
        case("inbetween-rest-pose", "inbetween", Typical, |window| {
            window.state_mut().state.execute(Request::ShowTake(None));
        }),
        case("curves-rest-pose", "curves", Typical, |window| {
            window.state_mut().state.execute(Request::ShowTake(None));
        }),
        case("curves-no-bone", "curves", Typical, |window| {
            window.state_mut().state.execute(Request::Select(None));
        }),
    ]
}

#[test]
fn the_panels_in_special_states_look_as_stored() {
    series::compare(more());
}

/// Returns the menu bar and the status line in every state, in a window of usual width.
fn bars() -> Vec<PictureCase> {
    let bars = [("menu-bar", Crop::Bar), ("status-line", Crop::Line)];
    let case = |(name, crop), fullness: Fullness| PictureCase {
        name: format!("panels/{name}-{}", fullness.word()),
        size: vec2(960.0, 200.0),
        crop,
        bench: Box::new(move || fullness.bench()),
        act: Box::new(|_| {}),
        twice: true,
    };
    let mut cases: Vec<PictureCase> =
        bars.into_iter().flat_map(|bar| Fullness::ALL.map(|fullness| case(bar, fullness))).collect();
    // No journal could be made, for whatever is open.
    for (fullness, name) in
        [(Typical, "status-line-not-recorded"), (Crowded, "status-line-crowded-not-recorded")]
    {
        let unrecorded = move || {
            let mut bench = fullness.bench();
            let view = bench.state.read().view.cloned().expect("a model is open");
            let generation = view.generation + 1;
            bench.state.show(View { is_unrecorded: true, generation, ..view });
            bench
        };
        let line = case(("status-line", Crop::Line), fullness);
        cases.push(PictureCase { name: format!("panels/{name}"), bench: Box::new(unrecorded), ..line });
    }
    cases
}

#[test]
fn the_menu_bar_and_the_status_line_look_as_stored() {
    series::compare(bars());
}

#[test]
fn every_panel_has_pictures() {
    for panel in panels::all() {
        let known = SIZES.iter().any(|(id, _)| *id == panel.id());
        assert!(known, "the panel {:?} has no pictures: add its size to the list in this file", panel.id());
    }
}

/// Returns all cases of this file.
pub(super) fn cases() -> Vec<PictureCase> {
    SIZES.iter().flat_map(|(id, size)| panel(id, *size)).chain(bars()).chain(more()).collect()
}
