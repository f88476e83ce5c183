//! Saves change the rows of edited keys and nothing else.

use super::made::{ODD, import, small, stored};
use crate::takes::{
    add_key, change_key, changed_lines, edited, files_of, opened_takes, plan, pose_difference, remove_key,
    with_takes,
};
use dragonfly_anim::data::{Channel, Interpolation, Take, TakeExtras, Track};
use dragonfly_anim::format::{Conventions, EditedTake, Handedness, NoFiles, ReadOptions, SavePlan, m3d::M3D};
use glam::{Quat, Vec3};
use std::sync::Arc;

fn text(plan: &SavePlan) -> String {
    assert_eq!(plan.files.len(), 1);
    String::from_utf8(plan.files[0].bytes.clone()).unwrap()
}

#[test]
fn a_file_without_edits_keeps_every_byte() {
    let files = files_of("m3d").into_iter().map(|path| std::fs::read(path).unwrap());
    for bytes in files.chain(small().into_iter().map(|(_, bytes)| bytes)) {
        let opened = import(&bytes).unwrap().model;
        let saved = plan(&M3D, &bytes, &opened, &opened_takes(&opened));
        assert!(saved.files[0].bytes == bytes);
        assert_eq!(saved.changes.unwrap().text, "nothing changes\n");
        let file = M3D.edit("a.m3d", bytes.clone(), &NoFiles, &ReadOptions::default()).unwrap();
        assert!(file.compact(&opened).unwrap().files[0].bytes == bytes);
    }
}

#[test]
fn an_edited_key_changes_the_numbers_that_differ_in_its_row() {
    let opened = import(ODD.as_bytes()).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        change_key(&mut take.tracks[0].translation, 1, |value| value + Vec3::new(0.0, 2.0, 0.0));
    });
    let saved = plan(&M3D, ODD.as_bytes(), &opened, &takes);
    let lines = changed_lines(ODD, &text(&saved));
    assert_eq!(
        lines,
        [(
            "    T: 0.1 P: 0.25 0.5 0 S: 1 1 1 Q: 0 0.6 0 0.8".to_owned(),
            "    T: 0.1 P: 0.25 2.5 0 S: 1 1 1 Q: 0 0.6 0 0.8".to_owned()
        )]
    );
    let changes = saved.changes.unwrap();
    assert_eq!(changes.text, "take \"walk\", \"bone0\", keys: 1 key changed\n");
    assert_eq!(
        changes.json,
        "{\"changes\":[{\"added\":0,\"bone\":\"bone0\",\"changed\":1,\"path\":\"keys\",\"removed\":0,\"take\":\"walk\"}]}"
    );
}

#[test]
fn rows_are_added_and_removed_in_the_style_of_the_file_and_counted() {
    let opened = import(ODD.as_bytes()).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        let track = &mut take.tracks[0];
        add_key(&mut track.translation, 0.2, Vec3::ONE);
        for time in [0.1, 0.25] {
            let key = track.translation.times.iter().position(|&known| known == time).unwrap();
            remove_key(&mut track.translation, key);
            let key = track.scale.times.iter().position(|&known| known == time).unwrap();
            remove_key(&mut track.scale, key);
            remove_key(&mut track.rotation, key);
        }
        add_key(&mut take.tracks[1].rotation, 0.5, Quat::IDENTITY);
    });
    let saved = plan(&M3D, ODD.as_bytes(), &opened, &takes);
    let after = text(&saved);
    let added = "\n    T: 0 P: 0 0.5 0 S: 1 1 1 Q: 0 0 0 1\n    T: 0.2 P: 1 1 -1 S: 1 1 1 Q: 0 0 0 1\n  }";
    assert!(after.contains("Bone0 #Keyframes: 2") && after.contains(added), "{after}");
    assert!(after.contains("Bone1 #Keyframes: 1\n  {\n\t\tT: 0.5 P: "), "{after}");
    let again = import(after.as_bytes()).unwrap().model;
    assert!(
        pose_difference(&again, &with_takes(&opened, &takes), 0, &[0.0, 0.05, 0.1, 0.2, 0.3, 0.5]) < 1e-6
    );
    // Rows that have no effect stay as they are.
    assert!(after.ends_with(&ODD[ODD.find("AnimationClip stand").unwrap()..]));
}

#[test]
fn a_key_of_one_property_becomes_a_row_with_the_others_at_its_time() {
    let bytes = stored("RiggedSimple.m3d");
    let opened = import(&bytes).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        let rotation = &mut take.tracks[1].rotation;
        let time = 0.5 * (rotation.times[0] + rotation.times[1]);
        let value = rotation.values[0];
        add_key(rotation, time, value);
    });
    let saved = plan(&M3D, &bytes, &opened, &takes);
    assert_eq!(saved.lost, []);
    let before = String::from_utf8(bytes).unwrap();
    let after = text(&saved);
    assert_eq!(after.lines().count(), before.lines().count() + 1);
    let again = import(after.as_bytes()).unwrap().model;
    let times: Vec<f32> = (0..100).map(|step| step as f32 * 0.021).collect();
    assert!(pose_difference(&again, &with_takes(&opened, &takes), 0, &times) < 1e-5);
}

#[test]
fn takes_are_renamed_copied_made_moved_and_removed() {
    let opened = import(ODD.as_bytes()).unwrap().model;
    let [walk, stand] = [0, 1].map(|index| opened_takes(&opened)[index].clone());
    let renamed = |edited: &EditedTake, name: &str| {
        let mut edited = edited.clone();
        Arc::make_mut(&mut edited.take).name = name.to_owned();
        edited
    };
    let names = |takes: &[EditedTake]| {
        let after = text(&plan(&M3D, ODD.as_bytes(), &opened, takes));
        let again = import(after.as_bytes()).unwrap().model;
        for (index, (take, asked)) in again.animation.takes.iter().zip(takes).enumerate() {
            assert!(asked.origin.is_none() || take.tracks == asked.take.tracks, "take {index}");
        }
        let names: Vec<String> = again.animation.takes.iter().map(|take| take.name.clone()).collect();
        (names.join(" "), after)
    };
    assert_eq!(names(&[stand.clone(), walk.clone()]).0, "stand walk");
    let (found, after) = names(&[stand.clone()]);
    assert!(found == "stand" && after.contains("NumClips 1") && !after.contains("walk"));
    let (found, after) = names(&[]);
    assert!(found.is_empty() && after.contains("NumClips 0"));
    assert!(after.ends_with("----AnimationClips-\n"), "{after}");
    let copies = [walk.clone(), renamed(&walk, "run"), stand.clone(), renamed(&stand, "sit")];
    assert_eq!(names(&copies).0, "walk run stand sit");
    let new = Take { name: "new take".to_owned(), tracks: vec![Track::default(); 2], ..Take::default() };
    let made = [walk, stand, EditedTake { origin: None, take: Arc::new(new) }];
    let saved = plan(&M3D, ODD.as_bytes(), &opened, &made);
    let lost: Vec<String> = saved.lost.iter().map(ToString::to_string).collect();
    assert_eq!(lost, ["/animation/takes/2/name: the take \"new take\" is called \"new_take\""]);
    assert_eq!(saved.changes.as_ref().unwrap().text, "take \"new_take\": added\n");
    let after = text(&saved);
    assert!(after.starts_with(&ODD.replace("NumClips 2", "NumClips 3")[..ODD.trim_end().len()]));
    let again = import(after.as_bytes()).unwrap().model;
    assert_eq!(again.animation.takes.len(), 3);
    // A clip has all bones, those without keys with one in the rest pose.
    assert!(again.animation.takes[2].tracks.iter().all(|track| track.rotation.len() == 1));
    assert!(pose_difference(&again, &with_takes(&opened, &made), 2, &[0.0, 1.0]) < 1e-6);
}

#[test]
fn clips_are_added_to_files_without_and_lost_in_files_without_bones() {
    let bytes = stored("RiggedSimple.m3d");
    let opened = import(&bytes).unwrap().model;
    let empty = plan(&M3D, &bytes, &opened, &[]);
    let none = import(&empty.files[0].bytes).unwrap().model;
    assert!(none.animation.takes.is_empty());
    let without_banner = text(&empty).replace("***************AnimationClips****************\n", "");
    for file in [text(&empty), without_banner] {
        let opened_none = import(file.as_bytes()).unwrap().model;
        let take = EditedTake { origin: None, take: Arc::clone(&opened.animation.takes[0]) };
        let saved = plan(&M3D, file.as_bytes(), &opened_none, &[take]);
        let again = import(&saved.files[0].bytes).unwrap().model;
        assert!(pose_difference(&again, &opened, 0, &[0.0, 0.3, 1.0, 2.0]) < 1e-6);
    }
    let sword = stored("sword_static_dx11_lh.m3d");
    let opened_sword = import(&sword).unwrap().model;
    let take =
        EditedTake { origin: None, take: Arc::new(Take { name: "spin".to_owned(), ..Take::default() }) };
    let saved = plan(&M3D, &sword, &opened_sword, &[take]);
    assert!(saved.files[0].bytes == sword);
    assert_eq!(
        saved.to_string(),
        "nothing changes\nnot saved: /animation/takes/0: take \"spin\": a file without bones has no takes\n"
    );
}

#[test]
fn steps_and_curves_are_stored_as_lines_and_what_has_no_room_is_listed() {
    let bytes = stored("RiggedSimple.m3d");
    let opened = import(&bytes).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        let values = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|value| value * 0.5);
        take.tracks[1].translation = Channel::new([0.0, 0.5, 1.5], values, Interpolation::Step);
        let mut extras = TakeExtras::default();
        extras.set("contacts", Some("[]".into()));
        take.extras = extras;
    });
    let saved = plan(&M3D, &bytes, &opened, &takes);
    let lost: Vec<String> = saved.lost.iter().map(ToString::to_string).collect();
    assert_eq!(
        lost,
        [
            "/animation/takes/0/extras: layers, contacts and events are not stored",
            "/animation/takes/0/tracks: steps and curves are stored as straight lines between more keys"
        ]
    );
    let again = import(&saved.files[0].bytes).unwrap().model;
    let times = [0.0, 0.2, 0.49, 0.5, 1.0, 1.49, 1.5, 2.0];
    assert!(pose_difference(&again, &with_takes(&opened, &takes), 0, &times) < 1e-4);
}

#[test]
fn an_edit_of_a_file_with_chosen_axes_is_saved_in_those_of_the_file() {
    let bytes = stored("RiggedSimple.m3d");
    let conventions = Conventions {
        meters_per_unit: Some(0.5),
        handedness: Some(Handedness::Left),
        ..Conventions::default()
    };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let opened = M3D.import(&bytes, &NoFiles, &options).unwrap().model;
    let takes = edited(&opened, 0, |take| {
        change_key(&mut take.tracks[0].translation, 0, |value| value + Vec3::new(0.0, 0.0, 1.5));
    });
    let file = M3D.edit("a.m3d", bytes.clone(), &NoFiles, &options).unwrap();
    let saved = file.plan(&opened, &takes).unwrap();
    let after = text(&saved);
    let lines = changed_lines(std::str::from_utf8(&bytes).unwrap(), &after);
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].1.contains("Pos: -1.35973e-07 -4.18033 -3 Scale"), "{lines:?}");
    let again = M3D.import(after.as_bytes(), &NoFiles, &options).unwrap().model;
    assert!(pose_difference(&again, &with_takes(&opened, &takes), 0, &[0.0, 0.1, 1.0]) < 1e-6);
}
