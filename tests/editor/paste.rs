//! Poses copied, pasted, mirrored, through the clipboard as text.

use crate::panels::{Bench, harness_of};
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Bone, Skeleton, Transform};
use dragonfly_document::Change;
use dragonfly_document::bones::{MirrorGuess, MirrorPairs};
use dragonfly_document::edit::{
    BonePose, BoneRef, Edit, PastePose, Property, ResetPose, ResetTo, SetPending, SetPose,
};
use dragonfly_document::posing::clipboard::{from_text, to_text};
use dragonfly_document::posing::mirror::Mirror;
use dragonfly_kit::document::fixture;
use dragonfly_kit::document::made_take::{model, pose, walk};
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Quat, Vec3};

/// Creates a body with two sides: joint positions are symmetric, bone axes are random.
fn body(random: &mut Random) -> Skeleton {
    let places = [
        ("hips", None, [0.0, 1.0, 0.0]),
        ("chest", Some(0), [0.0, 1.5, 0.1]),
        ("arm.L", Some(1), [0.3, 1.5, 0.0]),
        ("arm.R", Some(1), [-0.3, 1.5, 0.0]),
        ("hand.L", Some(2), [0.6, 1.2, 0.2]),
        ("hand.R", Some(3), [-0.6, 1.2, 0.2]),
    ];
    let mut to_root: Vec<Mat4> = Vec::new();
    let bones = places
        .into_iter()
        .map(|(name, parent, place)| {
            let turn = Quat::from_scaled_axis(any(random) * 2.0);
            let own = Mat4::from_rotation_translation(turn, place.into());
            let local = parent.map_or(own, |parent: u32| to_root[parent as usize].inverse() * own);
            to_root.push(own);
            let (_, rotation, translation) = local.to_scale_rotation_translation();
            Bone {
                name: name.to_owned(),
                parent,
                rest: Transform { translation, rotation, scale: Vec3::ONE },
                rest_matrix: None,
                offset: own.inverse(),
                node: None,
            }
        })
        .collect();
    Skeleton { bones }
}

fn any(random: &mut Random) -> Vec3 {
    Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0))
}

#[test]
fn a_mirrored_pose_puts_every_bone_on_the_other_side_whatever_its_axes() {
    let first = seed(31);
    for number in first..first + 50 {
        let mut random = Random::new(number);
        let skeleton = body(&mut random);
        let mirror = Mirror::of(&skeleton);
        assert!((mirror.plane.normal - Vec3::X).length() < 1e-6 && mirror.plane.distance.abs() < 1e-5);
        let poses: Vec<Transform> = skeleton
            .bones
            .iter()
            .map(|bone| Transform {
                translation: bone.rest.translation + any(&mut random) * 0.1,
                rotation: (Quat::from_scaled_axis(any(&mut random)) * bone.rest.rotation).normalize(),
                scale: Vec3::ONE,
            })
            .collect();
        let mut mirrored = vec![Transform::IDENTITY; poses.len()];
        for (bone, pose) in poses.iter().enumerate() {
            let bone = bone as u32;
            mirrored[mirror.target(bone).unwrap() as usize] = Transform {
                translation: mirror.translation(bone, pose.translation).unwrap(),
                rotation: mirror.rotation(bone, pose.rotation).unwrap(),
                scale: mirror.scale(bone, pose.scale).unwrap(),
            };
        }
        let (mut there, mut here) = (vec![Mat4::IDENTITY; 6], vec![Mat4::IDENTITY; 6]);
        to_root(&skeleton, &poses, &mut here);
        to_root(&skeleton, &mirrored, &mut there);
        for bone in 0..6 {
            let wanted = here[bone].w_axis.truncate() * Vec3::new(-1.0, 1.0, 1.0);
            let got = there[mirror.target(bone as u32).unwrap() as usize].w_axis.truncate();
            assert!((wanted - got).length() < 1e-4, "seed {number}, bone {bone}: {wanted} {got}");
        }
        let twice = mirror.rotation(3, mirror.rotation(2, poses[2].rotation).unwrap()).unwrap();
        assert!(twice.dot(poses[2].rotation).abs() > 1.0 - 1e-5, "seed {number}");
    }
}

/// An arm whose bones are counted from the shoulder on one side and from the hand on the other.
#[test]
fn bones_numbered_in_opposite_order_on_the_two_sides_are_paired_by_position() {
    let places = [
        ("torso", None, [0.0, 1.0, 0.0]),
        ("leg_L_1", Some(0), [0.1, 0.6, 0.0]),
        ("leg_R_1", Some(0), [-0.1, 0.6, 0.0]),
        ("leg_L_2", Some(1), [0.1, 0.3, 0.1]),
        ("leg_R_2", Some(2), [-0.1, 0.3, 0.1]),
        ("leg_L_3", Some(3), [0.1, 0.0, 0.0]),
        ("leg_R_3", Some(4), [-0.1, 0.0, 0.0]),
        ("arm_L__4_", Some(0), [0.1, 1.1, 0.0]),
        ("arm_R", Some(0), [-0.1, 1.1, 0.0]),
        ("arm_L__3_", Some(7), [0.4, 1.0, 0.0]),
        ("arm_R__2_", Some(8), [-0.4, 1.0, 0.0]),
        ("arm_L__2_", Some(9), [0.6, 0.9, 0.1]),
        ("arm_R__3_", Some(10), [-0.6, 0.9, 0.1]),
    ];
    let mut skeleton = Skeleton::default();
    for (name, parent, place) in places {
        let place = Vec3::from(place);
        let from = parent.map_or(Vec3::ZERO, |parent: u32| Vec3::from(places[parent as usize].2));
        skeleton.bones.push(Bone {
            name: name.to_owned(),
            parent,
            rest: Transform { translation: place - from, ..Transform::IDENTITY },
            rest_matrix: None,
            offset: Mat4::from_translation(-place),
            node: None,
        });
    }
    let pairs = MirrorPairs::of(&skeleton);
    for (left, right) in [(7, 8), (9, 10), (11, 12), (1, 2), (5, 6)] {
        assert_eq!(pairs.partner(left), Some(right), "{pairs:?}");
        assert_eq!(pairs.partner(right), Some(left));
    }
    let guess = |left| pairs.pairs.iter().find(|pair| pair.left == left).unwrap().guess;
    assert_eq!((guess(1), guess(9)), (MirrorGuess::Name, MirrorGuess::Place));
    assert_eq!(pairs.pairs.len() * 2 + pairs.unpaired.len(), skeleton.len());
}

#[test]
fn pasting_applies_known_bones_and_skips_unknown_ones() {
    let mut model = model(1);
    let paste = |poses: Vec<BonePose>, mirrored, pending| {
        Edit::PastePose(PastePose {
            take: walk(),
            time: 0.3,
            poses,
            mirrored,
            pending,
            unstep: false,
            over: None,
            falloff: None,
        })
    };
    let moved = |name: &str| BonePose { translation: Some([1.0, 2.0, 3.0]), ..pose(name) };
    model.apply(&paste(vec![moved("tail of another model"), moved("hand.L")], false, false)).unwrap();
    model.check().unwrap();
    let slot = &model.slots()[0];
    let key = slot.key_at(2, Property::Translation, 0.3).unwrap();
    assert_eq!(slot.result.tracks[2].translation.value(key).unwrap(), Vec3::new(1.0, 2.0, 3.0));
    assert!(model.apply(&paste(vec![moved("tail of another model")], false, false)).is_err());
    // A bone that has no keys and is already in the pasted pose gets no keys.
    let still = BonePose { rotation: Some([0.0, 0.0, 0.0, 1.0]), ..pose("still") };
    assert!(model.apply(&paste(vec![still], false, false)).is_err());
    let keys = model.slots()[0].result.keys();
    model.apply(&paste(vec![moved("hand.L")], true, true)).unwrap();
    assert_eq!(model.slots()[0].result.keys(), keys, "pending poses are no keys");
    assert_eq!(model.slots()[0].pending()[0].poses[0].bone, 3, "the other hand");
}

#[test]
fn clipboard_text_that_is_no_pose_is_refused() {
    let poses = vec![BonePose { translation: Some([0.1, 2.0, -3.5]), ..pose("hand.L") }];
    assert_eq!(from_text(&to_text(&poses)), Some(poses.clone()));
    assert_eq!(from_text(&format!("  {}\n", to_text(&poses))), Some(poses));
    for text in [
        "",
        "hello",
        "{}",
        "[]",
        "{\"dragonfly\":\"pose\",\"version\":2,\"poses\":[]}",
        "{\"dragonfly\":\"pose\",\"version\":1,\"poses\":[]}",
    ] {
        assert_eq!(from_text(text), None, "{text}");
    }
}

#[test]
fn a_copied_pose_is_text_that_can_be_pasted_mirrored_and_other_text_is_refused() {
    let mut bench = Bench::new(Some(fixture::full()));
    let state = &mut bench.state;
    state.execute(Request::Select(Some(1)));
    let Some(Effect::Copy(text)) = state.execute(Request::Command(Id::CopyPose)) else { panic!("no text") };
    let copied = from_text(&text).unwrap();
    assert_eq!(copied.len(), 1);
    assert!(matches!(copied[0].bone, BoneRef::Name(_)), "a name means the same in another model");
    state.execute(Request::Seek(0.5));
    let pasted = state.execute(Request::PastePose { text, mirrored: true });
    let Some(Effect::Change(Change::Edit(
        Edit::PastePose(PastePose { poses, mirrored: true, pending: false, .. }),
        None,
    ))) = pasted
    else {
        panic!("{pasted:?}")
    };
    assert_eq!(poses, copied);
    assert_eq!(state.execute(Request::PastePose { text: "shopping list".to_owned(), mirrored: false }), None);
    assert!(state.read().status.last().unwrap().text.contains("no pose"));
    state.execute(Request::Select(None));
    let Some(Effect::Copy(text)) = state.execute(Request::Command(Id::CopyPose)) else { panic!("no text") };
    let bones = state.read().loaded().unwrap().model.animation.skeleton.len();
    assert_eq!(from_text(&text).unwrap().len(), bones, "of all bones where none is selected");
}

#[test]
fn copy_and_paste_events_of_the_window_system_run_the_pose_commands() {
    let mut bench = Bench::new(Some(fixture::full()));
    bench.state.execute(Request::Select(Some(1)));
    let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(2);
    harness.event(egui::Event::Copy);
    harness.run_steps(2);
    assert!(matches!(harness.state().effects.as_slice(), [Effect::Copy(_)]), "{:?}", harness.state().effects);
    harness.event(egui::Event::Paste("text".to_owned()));
    harness.run_steps(2);
    assert_eq!(harness.state().effects.last(), Some(&Effect::PastePose { mirrored: false }));
    harness.key_press_modifiers(egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::V);
    harness.run_steps(2);
    assert_eq!(harness.state().effects.last(), Some(&Effect::PastePose { mirrored: true }));
}

#[test]
fn a_pose_is_reset_to_the_original_or_to_the_rest_pose_keyed_or_pending() {
    let mut bench = Bench::new(Some(fixture::full()));
    let state = &mut bench.state;
    state.execute(Request::Select(Some(1)));
    state.execute(Request::Seek(0.0));
    let edit = |effect: Option<Effect>| match effect {
        Some(Effect::Change(Change::Edit(edit, None))) => edit,
        other => panic!("{other:?}"),
    };
    let rest = edit(state.execute(Request::Command(Id::RestRotation)));
    let Edit::SetPose(SetPose { poses, .. }) = rest else { panic!("{rest:?}") };
    assert!(poses[0].rotation.is_some() && poses[0].translation.is_none());
    let keyed = {
        let slot = state.read().slot().unwrap();
        Property::ALL.into_iter().any(|property| slot.key_at(1, property, state.read().time()).is_some())
    };
    let original = edit(state.execute(Request::Command(Id::ResetPose)));
    assert_eq!(
        keyed,
        matches!(original, Edit::ResetPose(ResetPose { to: ResetTo::Original, .. })),
        "{original:?}"
    );
    state.settings_mut().auto_key = false;
    let original = edit(state.execute(Request::Command(Id::ResetPose)));
    assert!(matches!(original, Edit::SetPending(SetPending { .. })));
}
