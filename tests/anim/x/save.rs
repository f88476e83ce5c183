//! Saves of texts change edited keys and nothing else; files that are no text are not changed.

use super::made::{import, pendulum, small, stored, with_header};
use crate::takes::{
    add_key, change_key, changed_lines, edited, files_of, opened_takes, plan, pose_difference, remove_key,
    with_takes,
};
use dragonfly_anim::data::{Channel, Interpolation, ModelData, Take, TakeExtras, Track};
use dragonfly_anim::format::{Conventions, EditedTake, Handedness, NoFiles, ReadOptions, SavePlan, x::X};
use glam::{Quat, Vec3};
use std::sync::Arc;

fn text(plan: &SavePlan) -> String {
    assert_eq!(plan.files.len(), 1);
    String::from_utf8(plan.files[0].bytes.clone()).unwrap()
}

fn opened() -> (String, ModelData) {
    let text = pendulum();
    let model = import(text.as_bytes()).unwrap().model;
    (text, model)
}

#[test]
fn a_file_without_edits_keeps_every_byte() {
    let files = files_of("x").into_iter().map(|path| std::fs::read(path).unwrap());
    for bytes in files.chain(small().into_iter().map(|(_, bytes)| bytes)) {
        let opened = import(&bytes).unwrap().model;
        let saved = plan(&X, &bytes, &opened, &opened_takes(&opened));
        assert!(saved.files[0].bytes == bytes);
        assert_eq!((saved.lost.len(), saved.changes.unwrap().text.as_str()), (0, "nothing changes\n"));
        let file = X.edit("a.x", bytes.clone(), &NoFiles, &ReadOptions::default()).unwrap();
        assert!(file.compact(&opened).unwrap().files[0].bytes == bytes);
    }
}

#[test]
fn an_edited_key_changes_the_numbers_that_differ_in_its_row() {
    let (source, opened) = opened();
    let takes = edited(&opened, 0, |take| {
        change_key(&mut take.tracks[2].translation, 1, |value| value + Vec3::new(0.5, 0.0, 0.0));
        change_key(&mut take.tracks[1].rotation, 2, |_| Quat::from_xyzw(0.0, 0.6, 0.0, 0.8));
    });
    let saved = plan(&X, source.as_bytes(), &opened, &takes);
    let lines = changed_lines(&source, &text(&saved));
    let expected = [
        ("   12;4;0.939693,0.000000,0.000000,0.342020;;,", "   12;4;0.8,0.000000,0.6,0.0;;,"),
        ("   12;3;0.000000,-2.500000,0.500000;;,", "   12;3;0.5,-2.500000,0.500000;;,"),
    ];
    assert_eq!(lines, expected.map(|(before, after)| (before.to_owned(), after.to_owned())));
    assert_eq!(
        saved.changes.unwrap().text,
        "take \"Swing\", \"Arm\", rotation: 1 key changed\ntake \"Swing\", \"Weight\", translation: 1 key changed\n"
    );
}

#[test]
fn a_moved_key_of_a_list_of_matrices_changes_its_last_row_only() {
    let (source, opened) = opened();
    let takes = edited(&opened, 1, |take| {
        change_key(&mut take.tracks[0].translation, 2, |value| value + Vec3::new(0.0, 1.0, 0.0));
    });
    let saved = plan(&X, source.as_bytes(), &opened, &takes);
    let lines = changed_lines(&source, &text(&saved));
    assert_eq!(lines.len(), 1);
    let numbers = |line: &str| {
        line.trim_end_matches([';', ',']).split([';', ',']).map(str::to_owned).collect::<Vec<_>>()
    };
    let (before, after) = (numbers(&lines[0].0), numbers(&lines[0].1));
    let changed: Vec<usize> = (0..18).filter(|&slot| before[slot] != after[slot]).collect();
    assert_eq!(changed, [15]);
    assert_eq!(after[15], "1.666667");
    // A turned key changes its linear part and nothing else.
    let takes = edited(&opened, 1, |take| {
        change_key(&mut take.tracks[0].rotation, 2, |value| value * Quat::from_xyzw(0.0, 0.6, 0.0, 0.8));
    });
    let saved = plan(&X, source.as_bytes(), &opened, &takes);
    let lines = changed_lines(&source, &text(&saved));
    let (before, after) = (numbers(&lines[0].0), numbers(&lines[0].1));
    assert!(before[..2] == after[..2] && before[14..] == after[14..], "{lines:?}");
    let again = import(text(&saved).as_bytes()).unwrap().model;
    assert!(
        pose_difference(&again, &with_takes(&opened, &takes), 1, &[0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]) < 1e-5
    );
}

#[test]
fn keys_are_added_and_removed_in_the_style_of_the_file_and_counted() {
    let (source, opened) = opened();
    let takes = edited(&opened, 0, |take| {
        let track = &mut take.tracks[2];
        add_key(&mut track.translation, 0.25, Vec3::new(1.0, 2.0, 3.0));
        remove_key(&mut track.scale, 0);
        track.rotation = Channel::default();
        add_key(&mut take.tracks[1].scale, 0.5, Vec3::splat(2.0));
        add_key(&mut take.tracks[0].rotation, 0.0, Quat::IDENTITY);
    });
    let saved = plan(&X, source.as_bytes(), &opened, &takes);
    assert_eq!(saved.lost, []);
    let after = text(&saved);
    assert!(
        after.contains(
            "   2;\n   4;\n   0;3;0.000000,-2.000000,0.000000;;,\n   6;3;1.0,2.0,-3.0;;,\n   12;3;"
        ),
        "{after}"
    );
    assert!(after.contains("   1;\n   1;\n   24;3;1.000000,0.500000,1.500000;;;\n"), "{after}");
    assert!(!after.contains("   3;4;"), "{after}");
    assert!(after.contains("AnimationKey {\n   1;\n   1;\n   12;3;2.0,2.0,2.0;;;\n  }"), "{after}");
    assert!(
        after.contains(
            " Animation {\n  { World }\n  AnimationKey {\n   0;\n   1;\n   0;4;1.0,0.0,0.0,0.0;;;\n  }\n }"
        ),
        "{after}"
    );
    let again = import(after.as_bytes()).unwrap().model;
    let times = [0.0, 0.1, 0.25, 0.5, 0.7, 1.0];
    assert!(pose_difference(&again, &with_takes(&opened, &takes), 0, &times) < 1e-5);
    // The text after the set is the same.
    assert!(after.ends_with(&source[source.find("AnimationSet Turn").unwrap()..]));
}

#[test]
fn takes_are_renamed_copied_made_moved_and_removed() {
    let (source, opened) = opened();
    let [swing, turn] = [0, 1].map(|index| opened_takes(&opened)[index].clone());
    let renamed = |edited: &EditedTake, name: &str| {
        let mut edited = edited.clone();
        Arc::make_mut(&mut edited.take).name = name.to_owned();
        edited
    };
    let names = |takes: &[EditedTake]| {
        let after = text(&plan(&X, source.as_bytes(), &opened, takes));
        let again = import(after.as_bytes()).unwrap().model;
        for (take, asked) in again.animation.takes.iter().zip(takes) {
            assert!(take.tracks == asked.take.tracks, "{}", take.name);
        }
        let names: Vec<String> = again.animation.takes.iter().map(|take| take.name.clone()).collect();
        (names.join(" "), after)
    };
    assert_eq!(names(&[turn.clone(), swing.clone()]).0, "Turn Swing");
    let (found, after) = names(std::slice::from_ref(&turn));
    assert!(found == "Turn" && !after.contains("Swing"));
    let (found, after) = names(&[]);
    assert!(found.is_empty() && !after.contains("AnimationSet"));
    assert!(source.starts_with(after.trim_end()));
    let copies = [swing.clone(), renamed(&swing, "Run"), turn.clone(), renamed(&turn, "Spin")];
    assert_eq!(names(&copies).0, "Swing Run Turn Spin");
    let mut new = Take { name: "new take".to_owned(), ..Take::default() };
    new.tracks = (0..3).map(|bone| Track { bone, ..Track::default() }).collect();
    new.tracks[1].rotation = swing.take.tracks[1].rotation.clone();
    let made = [swing, turn, EditedTake { origin: None, take: Arc::new(new) }];
    let saved = plan(&X, source.as_bytes(), &opened, &made);
    let lost: Vec<String> = saved.lost.iter().map(ToString::to_string).collect();
    assert_eq!(lost, ["/animation/takes/2/name: the take \"new take\" is called \"new_take\""]);
    let after = text(&saved);
    assert!(after.starts_with(source.trim_end()));
    let again = import(after.as_bytes()).unwrap().model;
    assert!(again.animation.takes[2].tracks == made[2].take.tracks);
    // A file without any set.
    let cube = stored("test_cube_text.x");
    let opened_cube = import(&cube).unwrap().model;
    let mut spin = Take { name: "spin".to_owned(), ..Take::default() };
    spin.tracks = (0..2).map(|bone| Track { bone, ..Track::default() }).collect();
    spin.tracks[1].rotation = Channel::new(
        [0.0, 1.0],
        [Quat::IDENTITY, Quat::from_xyzw(0.0, 0.6, 0.0, 0.8)],
        Interpolation::Linear,
    );
    let saved = plan(&X, &cube, &opened_cube, &[EditedTake { origin: None, take: Arc::new(spin.clone()) }]);
    let again = import(&saved.files[0].bytes).unwrap().model;
    assert!(again.animation.takes[0].tracks == spin.tracks && again.animation.takes[0].name == "spin");
}

#[test]
fn a_set_without_a_name_gets_one_and_what_has_no_room_is_listed() {
    let source = String::from_utf8(with_header(
        "Frame a { Frame { } }\nAnimTicksPerSecond { 10; }\nAnimationSet {\n Animation { {a} AnimationKey { 2; 1; 0;3;1,2,3;;; } }\n}\n",
    ))
    .unwrap();
    let opened = import(source.as_bytes()).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        take.name = "walk".to_owned();
        let mut extras = TakeExtras::default();
        extras.set("contacts", Some("[]".into()));
        take.extras = extras;
        add_key(&mut take.tracks[0].translation, 0.55, Vec3::ZERO);
        add_key(&mut take.tracks[1].translation, 0.5, Vec3::ZERO);
        take.tracks[0].scale = Channel::new([0.0, 1.0], [Vec3::ONE, Vec3::splat(2.0)], Interpolation::Step);
    });
    let saved = plan(&X, source.as_bytes(), &opened, &takes);
    let lost: Vec<String> = saved.lost.iter().map(ToString::to_string).collect();
    assert_eq!(
        lost,
        [
            "/animation/takes/0/extras: layers, contacts and events are not stored",
            "/animation/takes/0/tracks: keys are moved to the nearest of 10 ticks per second",
            "/animation/takes/0/tracks: steps and curves are stored as straight lines between more keys",
            "/animation/takes/0/tracks/1: the frame of \"frame\" has no name of its own that keys can refer to",
        ]
    );
    let after = text(&saved);
    assert!(after.contains("AnimationSet walk {"), "{after}");
    assert!(after.contains("2; 2; 0;3;1,2,3;;,"), "{after}");
}

#[test]
fn files_that_are_no_text_are_not_edited_and_another_format_is_proposed() {
    for (name, kind) in
        [("pendulum_bin.x", "binary"), ("pendulum_tzip.x", "compressed"), ("pendulum_bzip.x", "compressed")]
    {
        let bytes = stored(name);
        let opened = import(&bytes).unwrap().model;
        let file = X.edit(name, bytes, &NoFiles, &ReadOptions::default()).unwrap();
        for takes in [
            edited(&opened, 0, |take| take.name = "other".to_owned()),
            opened_takes(&opened)[..1].to_vec(),
            edited(&opened, 0, |take| remove_key(&mut take.tracks[2].scale, 0)),
        ] {
            let error = file.plan(&opened, &takes).unwrap_err();
            assert_eq!(
                error.to_string(),
                format!("a {kind} .x file cannot be edited; save the model as .glb")
            );
        }
    }
}

#[test]
fn an_edit_of_a_file_with_chosen_axes_and_rate_is_saved_in_those_of_the_file() {
    let source = pendulum();
    let conventions = Conventions {
        meters_per_unit: Some(0.01),
        handedness: Some(Handedness::Right),
        frame_rate: Some(12.0),
        ..Conventions::default()
    };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let opened = X.import(source.as_bytes(), &NoFiles, &options).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        change_key(&mut take.tracks[2].translation, 1, |value| value + Vec3::new(0.0, 0.0, 0.01));
        add_key(&mut take.tracks[2].scale, 1.0, Vec3::ONE);
    });
    let saved = X.edit("a.x", source.as_bytes(), &NoFiles, &options).unwrap().plan(&opened, &takes).unwrap();
    let after = text(&saved);
    assert!(after.contains("   12;3;0.000000,-2.500000,1.5;;,"), "{after}");
    assert!(after.contains("   12;3;1.0,1.0,1.0;;,\n   24;3;"), "{after}");
    let again = X.import(after.as_bytes(), &NoFiles, &options).unwrap().model;
    assert!(pose_difference(&again, &with_takes(&opened, &takes), 0, &[0.0, 0.5, 1.0, 2.0]) < 1e-5);
}

#[test]
fn a_jump_takes_one_tick_and_no_tick_has_two_keys() {
    let (source, opened) = opened();
    let takes = edited(&opened, 0, |take| {
        let values = [Vec3::ZERO, Vec3::X, Vec3::Y];
        take.tracks[2].translation = Channel::new([0.0, 0.5, 0.75], values, Interpolation::Step);
        add_key(&mut take.tracks[1].rotation, 0.51, Quat::IDENTITY);
    });
    let saved = plan(&X, source.as_bytes(), &opened, &takes);
    let again = import(&saved.files[0].bytes).unwrap();
    assert!(again.warnings.iter().all(|warning| warning.code != "TIMES_NOT_ASCENDING"));
    let tick = 1.0 / 24.0;
    let take = &again.model.animation.takes[0];
    let times: Vec<i32> =
        take.tracks[2].translation.times.iter().map(|time| (time / tick).round() as i32).collect();
    assert_eq!(times, [0, 11, 12, 17, 18]);
    assert_eq!(take.tracks[2].translation.values[1], Vec3::ZERO);
    assert_eq!(take.tracks[1].rotation.len(), 4);
}
