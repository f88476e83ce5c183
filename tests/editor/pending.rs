//! With auto-key off a changed pose is shown, can be undone, is kept, and is in no key.

use crate::panels::{Bench, harness_of};
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request, State};
use dragonfly_anim::data::Transform;
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{
    AddKeys, BonePose, BoneRef, CreateTake, DropPending, Edit, KeyPending, NewKey, OffsetPose, Property,
    RetimeTake, ReverseTake, RippleKeys, SetPending, SetPose, SplitTake, TakeRef,
};
use dragonfly_document::history::Edited;
use dragonfly_document::{Change, View};
use dragonfly_kit::document::fixture;
use dragonfly_kit::document::made_take::{model, pose, walk};
use dragonfly_picture::scene::Scene;
use egui_kittest::kittest::Queryable;
use glam::{Quat, Vec3};
use std::sync::Arc;

fn moved(name: &str, to: [f32; 3]) -> BonePose {
    BonePose { translation: Some(to), ..pose(name) }
}

fn pend(time: f32, poses: Vec<BonePose>) -> Edit {
    Edit::SetPending(SetPending { take: walk(), time, poses })
}

fn key(time: Option<f32>) -> Edit {
    Edit::KeyPending(KeyPending { take: walk(), time, bones: Vec::new(), shapes: false, unstep: false })
}

/// Returns the pending values as (time, bone, channel, first number).
fn waiting(model: &ModelAdapter) -> Vec<(f32, u32, Property, f32)> {
    let mut found = Vec::new();
    for at in model.slots()[0].pending() {
        for pose in &at.poses {
            for property in Property::ALL {
                found.extend(pose.get(property).map(|value| (at.time, pose.bone, property, value[0])));
            }
        }
    }
    found
}

#[test]
fn a_pending_pose_changes_no_key_and_is_stored_per_channel() {
    let mut model = model(1);
    let before = Arc::clone(&model.slots()[0].result);
    model.apply(&pend(0.3, vec![moved("hip", [1.0, 2.0, 3.0])])).unwrap();
    let turn = BonePose { rotation: Some([0.0, 2.0, 0.0, 0.0]), ..pose("hip") };
    model.apply(&pend(0.30003, vec![turn, moved("root", [4.0, 0.0, 0.0])])).unwrap();
    model.check().unwrap();
    assert!(Arc::ptr_eq(&before, &model.slots()[0].result), "no key is touched");
    let expected = [
        (0.3, 0, Property::Translation, 4.0),
        (0.3, 1, Property::Translation, 1.0),
        (0.3, 1, Property::Rotation, 0.0),
    ];
    assert_eq!(waiting(&model), expected);
    let mut shown = vec![Transform::IDENTITY; 5];
    model.slots()[0].pending_at(0.3).unwrap().put_on(&mut shown);
    assert_eq!(shown[1].translation, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(shown[1].rotation, Quat::from_xyzw(0.0, 1.0, 0.0, 0.0), "made unit");
    assert_eq!(shown[1].scale, Vec3::ONE);
    assert_eq!(model.pending_poses(), 2);
}

#[test]
fn keying_a_pending_pose_stores_exactly_the_pose_that_was_shown() {
    let mut model = model(2);
    model.apply(&pend(0.3, vec![moved("hip", [1.0, 2.0, 3.0])])).unwrap();
    model.apply(&pend(0.6, vec![moved("root", [7.0, 0.0, 0.0])])).unwrap();
    model.apply(&key(Some(0.3))).unwrap();
    model.check().unwrap();
    let mut poses = vec![Transform::IDENTITY; 5];
    sample_take(Some(&model.slots()[0].result), model.skeleton(), 0.3, &mut poses);
    assert_eq!(poses[1].translation, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(waiting(&model), [(0.6, 0, Property::Translation, 7.0)], "the other one still waits");
    model.apply(&key(None)).unwrap();
    assert_eq!(waiting(&model), []);
    sample_take(Some(&model.slots()[0].result), model.skeleton(), 0.6, &mut poses);
    assert_eq!(poses[0].translation, Vec3::new(7.0, 0.0, 0.0));
    assert!(model.apply(&key(None)).is_err(), "nothing is pending any more");
}

#[test]
fn dropping_removes_the_named_pending_poses_and_undo_restores_them() {
    let mut edited = Edited::new(model(3));
    edited.apply(pend(0.3, vec![moved("hip", [1.0; 3]), moved("root", [2.0; 3])]), None).unwrap();
    let take = walk();
    let bones = vec![BoneRef::Name("hip".to_owned())];
    edited
        .apply(Edit::DropPending(DropPending { take: take.clone(), time: None, bones, shapes: false }), None)
        .unwrap();
    assert_eq!(waiting(edited.adapter()), [(0.3, 0, Property::Translation, 2.0)]);
    edited
        .apply(
            Edit::DropPending(DropPending { take, time: Some(0.3), bones: Vec::new(), shapes: false }),
            None,
        )
        .unwrap();
    assert_eq!(waiting(edited.adapter()), []);
    edited.go_to(1);
    assert_eq!(edited.adapter().pending_poses(), 2);
    edited.go_to(3);
    assert_eq!(edited.adapter().pending_poses(), 0);
    edited.go_to(0);
    assert_eq!(edited.adapter().pending_poses(), 0);
    assert!(edited.is_saved());
}

#[test]
fn a_new_key_replaces_the_pending_pose_at_its_time() {
    let mut model = model(4);
    let turn = BonePose { rotation: Some([0.0, 0.6, 0.0, 0.8]), ..moved("hip", [1.0, 0.0, 0.0]) };
    model.apply(&pend(0.3, vec![turn])).unwrap();
    model
        .apply(&Edit::SetPose(SetPose {
            take: walk(),
            time: 0.3,
            poses: vec![moved("hip", [5.0; 3])],
            unstep: false,
        }))
        .unwrap();
    assert_eq!(waiting(&model), [(0.3, 1, Property::Rotation, 0.0)]);
    // An offset is added to the pose that is shown.
    model.apply(&pend(0.5, vec![moved("root", [1.0, 2.0, 3.0])])).unwrap();
    model
        .apply(&Edit::OffsetPose(OffsetPose {
            take: walk(),
            time: 0.5,
            poses: vec![moved("root", [1.0; 3])],
            unstep: false,
        }))
        .unwrap();
    let mut poses = vec![Transform::IDENTITY; 5];
    sample_take(Some(&model.slots()[0].result), model.skeleton(), 0.5, &mut poses);
    assert!((poses[0].translation - Vec3::new(2.0, 3.0, 4.0)).length() < 1e-5);
    model.check().unwrap();
}

#[test]
fn pending_poses_move_with_a_take_that_is_retimed_reversed_or_split() {
    let mut model = model(5);
    model.apply(&pend(0.25, vec![moved("hip", [1.0; 3])])).unwrap();
    model.apply(&pend(0.75, vec![moved("hip", [2.0; 3])])).unwrap();
    let times = |model: &ModelAdapter, take: usize| -> Vec<f32> {
        model.slots()[take].pending().iter().map(|at| at.time).collect()
    };
    model.apply(&Edit::RetimeTake(RetimeTake { take: walk(), start: Some(1.0), length: Some(2.0) })).unwrap();
    assert_eq!(times(&model, 0), [1.5, 2.5]);
    model.apply(&Edit::ReverseTake(ReverseTake { take: walk() })).unwrap();
    assert_eq!(times(&model, 0), [1.5, 2.5]);
    assert_eq!(waiting(&model)[0].3, 2.0, "the later one is the earlier one now");
    model.apply(&Edit::RippleKeys(RippleKeys { take: walk(), from: 2.0, by: 0.5 })).unwrap();
    assert_eq!(times(&model, 0), [1.5, 3.0]);
    model.apply(&Edit::SplitTake(SplitTake { take: walk(), time: 2.0, name: "end".to_owned() })).unwrap();
    assert_eq!((times(&model, 0), times(&model, 1)), (vec![1.5], vec![1.0]));
    model
        .apply(&Edit::CreateTake(CreateTake { name: "copy".to_owned(), copy: Some(walk()), at: None }))
        .unwrap();
    assert_eq!(model.pending_poses(), 2, "a copy is of the keys");
    model.check().unwrap();
}

#[test]
fn an_invalid_pose_cannot_become_pending() {
    let mut model = model(6);
    let wrong = [
        pend(f32::NAN, vec![moved("hip", [0.0; 3])]),
        pend(-1.0, vec![moved("hip", [0.0; 3])]),
        pend(0.0, vec![moved("hip", [f32::INFINITY; 3])]),
        pend(0.0, vec![BonePose { rotation: Some([0.0; 4]), ..pose("hip") }]),
        pend(0.0, vec![moved("nobody", [0.0; 3])]),
        pend(0.0, vec![pose("hip")]),
        pend(0.0, Vec::new()),
        Edit::DropPending(DropPending { take: walk(), time: None, bones: Vec::new(), shapes: false }),
        key(Some(f32::NAN)),
    ];
    for edit in wrong {
        assert!(model.apply(&edit).is_err(), "{edit:?}");
        assert_eq!(model.pending_poses(), 0);
    }
}

/// The fixture with a bone pending at 0.4 s, moved far away.
fn pending_view(far: [f32; 3]) -> (View, Edited) {
    let view = fixture::full();
    let mut edited = Edited::new(ModelAdapter::new(&view.loaded.model.animation));
    let far = BonePose { bone: BoneRef::Index(1), translation: Some(far), rotation: None, scale: None };
    edited
        .apply(Edit::SetPending(SetPending { take: TakeRef::Index(0), time: 0.4, poses: vec![far] }), None)
        .unwrap();
    (shown(&view, &edited), edited)
}

fn shown(view: &View, edited: &Edited) -> View {
    let takes = edited.adapter().results().cloned().collect();
    let slots = edited.adapter().slots().into();
    View { generation: view.generation + 1, takes, slots, ..view.clone() }
}

#[test]
fn panels_and_viewport_show_the_same_pending_pose_at_the_playhead() {
    let (view, _) = pending_view([0.0, 100.0, 0.0]);
    let mut bench = Bench::new(Some(view.clone()));
    let state = &mut bench.state;
    let mut scene = Scene::new(state.read().now);
    scene.show(&view);
    let mut place = |state: &mut State, time: f32, playing: bool| {
        state.pause();
        state.execute(Request::Seek(time));
        if playing {
            state.execute(Request::Command(Id::PlayPause));
        }
        state.execute(Request::Select(Some(1)));
        state.begin_frame(state.read().now);
        scene.playback = state.read().playback;
        scene.prepare(state.read().now);
        let panel = state.read().posed.animation().unwrap().to_root()[1].w_axis.y;
        let picture = scene.model().unwrap().to_root()[1].w_axis.y;
        assert_eq!(panel, picture, "at {time} s, playing {playing}");
        panel
    };
    assert!(place(state, 0.4, false) > 50.0);
    assert!(place(state, 0.4, true) < 50.0, "while time runs the keys are seen");
    assert!(place(state, 0.41, false) < 50.0);
    assert!(place(state, 0.40002, false) > 50.0);
}

#[test]
fn auto_key_decides_whether_a_pose_becomes_a_key() {
    let mut bench = Bench::new(Some(fixture::full()));
    let state = &mut bench.state;
    let pose = || {
        vec![BonePose { bone: BoneRef::Index(1), translation: Some([1.0; 3]), rotation: None, scale: None }]
    };
    assert!(matches!(state.read().pose_edit(pose()), Some(Edit::SetPose(SetPose { .. }))), "on at first");
    state.execute(Request::Command(Id::AutoKey));
    assert!(matches!(state.read().pose_edit(pose()), Some(Edit::SetPending(SetPending { .. }))));
    assert!(state.read().status.last().unwrap().text.contains("pending"));
    state.execute(Request::ShowTake(None));
    assert_eq!(state.read().pose_edit(pose()), None, "the rest pose is not edited");
}

#[test]
fn the_key_command_keys_the_pending_pose_at_the_playhead_or_otherwise_the_selected_bones() {
    let (view, _) = pending_view([0.0, 1.0, 0.0]);
    let mut bench = Bench::new(Some(view));
    let state = &mut bench.state;
    state.execute(Request::Select(Some(2)));
    let given = |state: &mut State, time: f32| {
        state.execute(Request::Seek(time));
        match state.execute(Request::Command(Id::Key)) {
            Some(Effect::Change(Change::Edit(edit, None))) => edit,
            other => panic!("{other:?}"),
        }
    };
    assert!(
        matches!(given(state, 0.4), Edit::KeyPending(KeyPending { time: Some(time), .. }) if (time - 0.4).abs() < 1e-6)
    );
    let edit = given(state, 0.5);
    assert!(
        matches!(&edit, Edit::AddKeys(AddKeys { bones, value: NewKey::Current, .. }) if *bones == [BoneRef::Index(2)]),
        "{edit:?}"
    );
    assert_eq!(state.read().pending_times().collect::<Vec<_>>(), [0.4]);
}

#[test]
fn the_number_of_pending_poses_is_shown_and_a_click_seeks_to_one() {
    let (view, _) = pending_view([0.0, 1.0, 0.0]);
    let mut harness = harness_of(Bench::new(Some(view)), egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(3);
    harness.get_by_label("1 pose pending").click();
    harness.run_steps(3);
    assert!((harness.state().state.read().time() - 0.4).abs() < 1e-4);
    let mut harness =
        harness_of(Bench::new(Some(fixture::full())), egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(3);
    assert!(harness.query_by_label("1 pose pending").is_none());
    let auto = harness.get_by_label("Auto-key");
    auto.click();
    harness.run_steps(2);
    assert!(!harness.state().state.read().settings.auto_key);
}
