//! A save changes the numbers of edited frames and channels, nothing else.

use super::made::{ODD, edited, files, import_in_meters, plan, pose_difference, text, turn_key};
use dragonfly_anim::data::{Channel, Interpolation, TakeExtras};
use dragonfly_anim::format::{EditedTake, NoFiles, ReadOptions, bvh::BVH};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Returns the lines that differ, as `number: old → new`.
fn changed_lines(old: &str, new: &str) -> Vec<String> {
    assert_eq!(old.lines().count(), new.lines().count());
    let lines = old.lines().zip(new.lines()).enumerate();
    lines.filter(|(_, (a, b))| a != b).map(|(line, (a, b))| format!("{}: {a} → {b}", line + 1)).collect()
}

fn degrees(x: f32, y: f32, z: f32) -> Quat {
    let [x, y, z] = [x, y, z].map(f32::to_radians);
    Quat::from_rotation_z(z) * Quat::from_rotation_x(x) * Quat::from_rotation_y(y)
}

#[test]
fn a_save_without_an_edit_keeps_every_byte_of_every_file() {
    for path in files() {
        let bytes = std::fs::read(&path).unwrap();
        let options = ReadOptions::default();
        let model = BVH.import(&bytes, &NoFiles, &options).unwrap().model;
        let file = BVH.edit("a.bvh", bytes.clone(), &NoFiles, &options).unwrap();
        // Copied columns, so that the numbers are compared rather than their addresses.
        let take = edited(&model, |take| {
            for track in &mut take.tracks {
                track.rotation.values = track.rotation.values.to_vec().into();
                track.translation.times = track.translation.times.to_vec().into();
            }
        });
        let saved = file.plan(&model, &take).unwrap();
        assert!(saved.files[0].bytes == bytes && saved.lost.is_empty(), "{}", path.display());
        assert_eq!(saved.to_string(), "nothing changes\n");
        assert!(file.compact(&model).unwrap().files[0].bytes == bytes);
    }
}

#[test]
fn one_edited_rotation_replaces_only_the_numbers_of_its_channels_in_its_row() {
    let model = import_in_meters(ODD.as_bytes());
    let take = edited(&model, |take| turn_key(&mut take.tracks[0].rotation, 1, degrees(0.0, 3.5, 0.0)));
    let saved = plan(ODD.as_bytes(), &model, &take);
    // The channels are z, x, y: a turn about y changes only the last angle.
    assert_eq!(
        changed_lines(ODD, &text(&saved)),
        ["29:  91.0 1.50 2.5   359 11.5 -21 →  91.0 1.50 2.5   359 11.5 -17.5"]
    );
    assert_eq!(saved.lost, []);
    assert_eq!(saved.to_string(), "1 number replaced\n\"mixamorig:Hips\", rotation: 1 frame\n");
    assert_eq!(
        saved.changes.unwrap().json,
        "{\"channels\":[{\"bone\":\"mixamorig:Hips\",\"frames\":1,\"path\":\"rotation\"}],\
         \"framesAppended\":0,\"framesRemoved\":0,\"numbers\":1}"
    );
}

#[test]
fn an_edited_position_replaces_one_number_with_the_decimals_of_the_old_one() {
    let model = import_in_meters(ODD.as_bytes());
    let take = edited(&model, |take| {
        let channel = &mut take.tracks[0].translation;
        let mut values = channel.values.to_vec();
        values[2].x = 2.125;
        values[0].y = 3.0;
        *channel = Channel::new(Arc::clone(&channel.times), values, Interpolation::Linear);
    });
    assert_eq!(
        changed_lines(ODD, &text(&plan(ODD.as_bytes(), &model, &take))),
        [
            "28:  90.0 1.00 2.0   0 10.5 -20  15 12 7.25 0   -30 45   1 2 3 →  \
             3.0 1.00 2.0   0 10.5 -20  15 12 7.25 0   -30 45   1 2 3",
            "32:  92.0 2.00 3.0   +5e0 12.5 -22  17 13 9.25 1   -32 47   3 4 5 →  \
             92.0 2.125 3.0   +5e0 12.5 -22  17 13 9.25 1   -32 47   3 4 5"
        ]
    );
}

#[test]
fn angles_continue_the_old_numbers_and_those_of_the_frame_before_by_less_than_half_a_turn() {
    let rows: String = (0..40).map(|frame| format!("{} 0 0\n", frame * 20)).collect();
    let head = "HIERARCHY ROOT a { OFFSET 0 1 0 CHANNELS 3 Zrotation Xrotation Yrotation }\nMOTION\nFrames: 40\nFrame Time: 0.05\n";
    let file = format!("{head}{rows}");
    let model = import_in_meters(file.as_bytes());
    // Frame after frame the addition grows from 0 to 370 degrees.
    let take = edited(&model, |take| {
        for key in 0..40 {
            turn_key(&mut take.tracks[0].rotation, key, degrees(0.0, 0.0, key as f32 * 9.5));
        }
    });
    let saved = text(&plan(file.as_bytes(), &model, &take));
    for (frame, row) in saved.lines().skip(4).enumerate() {
        let numbers: Vec<f64> = row.split(' ').map(|number| number.parse().unwrap()).collect();
        assert!((numbers[0] - frame as f64 * 29.5).abs() < 1e-3, "{row}");
        assert_eq!(&row[row.find(' ').unwrap()..], " 0 0");
    }
}

#[test]
fn a_longer_take_appends_rows_and_a_shorter_one_removes_them() {
    let model = import_in_meters(ODD.as_bytes());
    let longer = edited(&model, |take| {
        let channel = &mut take.tracks[0].translation;
        let times: Vec<f32> = channel.times.iter().copied().chain([4.0 * 0.008_333_3]).collect();
        let values = [channel.values.to_vec(), vec![Vec3::new(9.0, 92.0, 3.0)]].concat();
        *channel = Channel::new(times, values, Interpolation::Linear);
    });
    let saved = plan(ODD.as_bytes(), &model, &longer);
    let grown = text(&saved);
    let rows = "\n\n 93.0 5.50 3.0   5.00000 12.5 -22  17 13 9.25 1   -32 47   3 4 5";
    assert!(!grown.contains(rows), "x moves, y stays");
    let tail = &grown[grown.find("92.0 2.00").unwrap()..];
    assert_eq!(
        tail,
        "92.0 2.00 3.0   +5e0 12.5 -22  17 13 9.25 1   -32 47   3 4 5\n\n \
         92.0 5.50 3.0   5 12.5 -22  17 13 9.25 1   -32 47   3 4 5\n\n \
         92.0 9.00 3.0   5 12.5 -22  17 13 9.25 1   -32 47   3 4 5\n"
    );
    assert!(grown.contains("Frames : 5\n"));
    assert!(saved.to_string().ends_with("2 frames appended at the end\n"), "{saved}");
    let again = import_in_meters(grown.as_bytes());
    assert!(
        pose_difference(&again, &with_take(&model, &longer), &[0.0, 0.016_666_6, 0.025, 0.033_333_2]) < 1e-5
    );

    let shorter = edited(&again, |take| {
        for track in &mut take.tracks {
            let keys = track.translation.len().min(2);
            let channel = &mut track.translation;
            *channel = Channel::new(&channel.times[..keys], &channel.values[..keys], Interpolation::Linear);
            let keys = track.rotation.len().min(2);
            track.rotation = Channel::new(
                &track.rotation.times[..keys],
                &track.rotation.values[..keys],
                Interpolation::Linear,
            );
        }
    });
    let saved = plan(grown.as_bytes(), &again, &shorter);
    let cut = text(&saved);
    assert!(saved.to_string().ends_with("3 frames removed at the end\n"), "{saved}");
    let end = ODD.find("46   2 3 4").unwrap() + "46   2 3 4".len();
    assert_eq!(cut, ODD[..end].replace("Frames : 3", "Frames : 2") + "\n");
}

fn with_take(
    model: &dragonfly_anim::data::ModelData,
    takes: &[EditedTake],
) -> dragonfly_anim::data::ModelData {
    let mut model = model.clone();
    model.animation.takes = takes.iter().map(|take| Arc::clone(&take.take)).collect();
    model
}

#[test]
fn without_a_take_no_row_is_left_and_a_file_without_rows_gets_some() {
    let model = import_in_meters(ODD.as_bytes());
    let empty = text(&plan(ODD.as_bytes(), &model, &[]));
    assert!(empty.ends_with("Frames : 0\nFrame Time:   .0083333\n"), "{empty}");
    let opened = import_in_meters(empty.as_bytes());
    assert!(opened.animation.takes.is_empty());
    let takes = [EditedTake { origin: None, take: Arc::clone(&model.animation.takes[0]) }];
    let filled = plan(empty.as_bytes(), &opened, &takes);
    assert_eq!(filled.lost, []);
    let again = import_in_meters(text(&filled).as_bytes());
    assert!(pose_difference(&again, &model, &[0.0, 0.008_333_3, 0.016_666_6]) < 1e-5);
}

#[test]
fn what_the_file_cannot_hold_is_listed() {
    let model = import_in_meters(ODD.as_bytes());
    let mut takes = edited(&model, |take| {
        take.name = "run".to_owned();
        let mut extras = TakeExtras::default();
        extras.set("layers", Some("{}".into()));
        take.extras = extras;
        let times = Arc::clone(&take.tracks[0].rotation.times);
        let one = |value: Vec3| Channel::new(Arc::clone(&times), [value; 3], Interpolation::Linear);
        take.tracks[0].scale = one(Vec3::splat(2.0));
        take.tracks[1].translation = one(Vec3::new(10.0, 25.0, 0.0));
        take.tracks[2].translation = one(Vec3::new(31.0, 0.0, 0.0));
        take.tracks[2].rotation =
            Channel::new(Arc::clone(&times), [degrees(0.0, 40.0, 0.0); 3], Interpolation::Linear);
        take.tracks[3].rotation = take.tracks[2].rotation.clone();
        take.tracks[4].rotation = Channel::new([0.0, 0.004], [Quat::IDENTITY; 2], Interpolation::Step);
    });
    takes.push(takes[0].clone());
    let saved = plan(ODD.as_bytes(), &model, &takes);
    let lost: Vec<String> = saved.lost.iter().map(ToString::to_string).collect();
    assert_eq!(
        lost,
        [
            "/animation/takes/1: take \"run\": a BVH file has one take",
            "/animation/takes/0/name: a take of a BVH file has no name; \"run\" is not stored",
            "/animation/takes/0/extras: layers, contacts and events are not stored",
            "/animation/takes/0/tracks/0/scale: \"mixamorig:Hips\" has no channels for its scale",
            "/animation/takes/0/tracks/2/translation: \"Left Arm_2\" has no channels for its translation",
            "/animation/takes/0/tracks/3/rotation: \"Left Arm_end\" has no channels for its rotation",
            "/animation/takes/0/tracks/4/rotation: 1 key not at the time of a frame; the frames have the values of the curve",
            "/animation/takes/0/tracks/4/rotation: only the values at the frames are stored, and lines between them",
            "/animation/takes/0/tracks/1/translation: the channels of \"Left Arm\" cannot express its translation",
            "/animation/takes/0/tracks/2/rotation: the channels of \"Left Arm_2\" cannot express its rotation",
        ]
    );
}

#[test]
fn an_edit_of_a_file_with_chosen_units_and_axes_is_saved_in_those_of_the_file() {
    use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
    let conventions = Conventions {
        meters_per_unit: Some(0.0254),
        up: Some(UpAxis::Z),
        handedness: Some(Handedness::Left),
        frame_rate: Some(25.0),
    };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let model = BVH.import(ODD.as_bytes(), &NoFiles, &options).unwrap().model;
    let file = BVH.edit("a.bvh", ODD.as_bytes(), &NoFiles, &options).unwrap();
    let take = edited(&model, |take| {
        turn_key(&mut take.tracks[0].rotation, 1, degrees(10.0, 20.0, 30.0));
        let channel = &mut take.tracks[1].translation;
        let mut values = channel.values.to_vec();
        values[1].x += 0.0254;
        *channel = Channel::new(Arc::clone(&channel.times), values, Interpolation::Linear);
    });
    let saved = text(&file.plan(&model, &take).unwrap());
    let lines = changed_lines(ODD, &saved);
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(lines[1].ends_with(" 16 13.5 8.25 0.5   -31 46   2 3 4"), "{lines:?}");
    let again = BVH.import(saved.as_bytes(), &NoFiles, &options).unwrap().model;
    assert!(pose_difference(&again, &with_take(&model, &take), &[0.0, 0.04, 0.08]) < 1e-5);
}
