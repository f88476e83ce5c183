//! Reading files of every kind.

use super::made::{ODD, files, import, import_in_meters};
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{
    ConventionSource, Conventions, Found, NoFiles, ReadOptions, UpAxis, bvh::BVH, read,
};
use glam::{EulerRot, Quat, Vec3};
use std::sync::Arc;

#[test]
fn names_channels_offsets_and_rows_of_an_odd_file_are_read() {
    let imported = BVH.import(ODD.as_bytes(), &NoFiles, &super::made::in_meters()).unwrap();
    let bones = &imported.model.animation.skeleton.bones;
    let listed: Vec<_> = bones.iter().map(|bone| (bone.name.as_str(), bone.parent)).collect();
    assert_eq!(
        listed,
        [
            ("mixamorig:Hips", None),
            ("Left Arm", Some(0)),
            ("Left Arm_2", Some(1)),
            ("Left Arm_end", Some(1)),
            ("Prop", None)
        ]
    );
    assert_eq!(bones[2].rest.translation, Vec3::new(30.0, 0.0, 0.0));
    assert_eq!(bones[3].offset.w_axis.truncate(), -Vec3::new(15.0, 114.0, 0.0));
    let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        ["line 9 column 5: another joint has the same name; this one is called \"Left Arm_2\""]
    );
    let take = &imported.model.animation.takes[0];
    assert_eq!(take.tracks[0].translation.values[2], Vec3::new(2.0, 92.0, 3.0), "replaces the offset");
    let arm = &take.tracks[1];
    assert_eq!(arm.translation.values[1], Vec3::new(12.5, 20.0, 0.0), "replaces one axis of the offset");
    let [y, z, x] = [16.0_f32, 8.25, 0.5].map(f32::to_radians);
    let expected = Quat::from_rotation_y(y) * Quat::from_rotation_z(z) * Quat::from_rotation_x(x);
    assert!(arm.rotation.values[1].dot(expected).abs() > 0.999_999_9);
    assert!(take.tracks[3].is_empty() && take.tracks[4].translation.is_empty());
    let prop = Quat::from_rotation_x(7_f32.to_radians()) * Quat::from_rotation_y(5_f32.to_radians());
    assert!(take.tracks[4].rotation.values[2].dot(prop).abs() > 0.999_999_9, "an axis twice");
    let hips = &take.tracks[0].rotation;
    assert!(hips.values.windows(2).all(|pair| pair[0].dot(pair[1]) > 0.9), "one hemisphere");
    let euler =
        Quat::from_euler(EulerRot::ZXY, 359_f32.to_radians(), 11.5_f32.to_radians(), -21_f32.to_radians());
    assert!(hips.values[1].dot(euler).abs() > 0.999_999_9);
    let shared = take.tracks.iter().flat_map(|track| [&track.rotation.times, &track.translation.times]);
    assert!(shared.filter(|times| !times.is_empty()).all(|times| Arc::ptr_eq(times, &hips.times)));
    assert_eq!(*hips.times, [0.0, 0.008_333_3, 0.016_666_6]);
    assert_eq!(faults(&imported.model), [""; 0]);
    assert_eq!(faults_of_poses(imported.model), [""; 0]);
}

#[test]
fn line_ends_of_every_kind_and_none_read_the_same() {
    let expected = import(ODD.as_bytes()).unwrap().model;
    for end in ["\r\n", "\r", " \t\n\n"] {
        let model = import(ODD.replace('\n', end).as_bytes()).unwrap().model;
        assert!(model == expected, "{end:?}");
    }
    let marked = [b"\xef\xbb\xbf\n".as_slice(), ODD.as_bytes()].concat();
    assert!((BVH.sniff)(&marked) && import(&marked).unwrap().model == expected);
    for head in ["Frames: 3", "FRAMES:3", "frames 3"] {
        assert!(import(ODD.replace("Frames : 3", head).as_bytes()).unwrap().model == expected, "{head}");
    }
}

#[test]
fn whole_frames_are_kept_when_numbers_are_missing_and_surplus_text_is_ignored() {
    let with = |from: &str, to: &str| {
        let imported = import(ODD.replacen(from, to, 1).as_bytes()).unwrap();
        let take = imported.model.animation.takes.first().map_or(0, |take| take.tracks[0].rotation.len());
        let warning = imported.warnings.last().unwrap().to_string();
        (take, warning)
    };
    let (frames, warning) = with("47   3 4 5", "");
    assert_eq!((frames, warning.as_str()), (2, "line 26 column 10: 3 frames are announced, 2 are complete"));
    let (frames, warning) = with("Frames : 3", "Frames : 4000000000");
    assert_eq!(
        (frames, warning.as_str()),
        (3, "line 26 column 10: 4000000000 frames are announced, 3 are complete")
    );
    let (frames, warning) = with("Frames : 3", "Frames: 2");
    let text = "line 32 column 2: \"92.0\" and the text after it are ignored: the motion has ended";
    assert_eq!((frames, warning.as_str()), (2, text));
    let (frames, _) = with("Frames : 3", "Frames: 0");
    assert_eq!(frames, 0);
    let cut = &ODD[..ODD.find("MOTION").unwrap()];
    let imported = import(cut.as_bytes()).unwrap();
    assert!(imported.model.animation.takes.is_empty() && imported.model.animation.skeleton.len() == 5);
    assert_eq!(imported.warnings.last().unwrap().code, "MOTION_MISSING");
}

#[test]
fn impossible_frame_times_become_a_thirtieth_of_a_second() {
    for time in ["0", "-1", "nan", "inf", "1e-20", "1e300"] {
        let imported = import(ODD.replace(".0083333", time).as_bytes()).unwrap();
        assert_eq!(imported.warnings.last().unwrap().code, "FRAME_TIME_INVALID", "{time}");
        let take = &imported.model.animation.takes[0];
        assert!((take.length - 2.0 / 30.0).abs() < 1e-6, "{time}");
    }
    let error = import(ODD.replace(".0083333", "80000").as_bytes()).unwrap_err();
    assert_eq!(error.to_string(), "file: seconds: 160000, at most 86400");
    let error = import(ODD.replace(".0083333", "soon").as_bytes()).unwrap_err();
    assert_eq!(error.to_string(), "line 27 column 15: \"soon\" where the frame time was expected");
}

#[test]
fn frame_rates_are_snapped_to_usual_ones_and_times_are_not() {
    let rate = |time: &str| {
        let imported = import(ODD.replace(".0083333", time).as_bytes()).unwrap();
        (imported.conversion.frame_rate.unwrap(), imported.model.animation.takes[0].length)
    };
    assert_eq!(rate(".0083333"), (Found::in_file(120.0), 0.016_666_6));
    assert_eq!(rate("0.0333333").0, Found::in_file(30.0));
    assert_eq!(rate("0.033366").0, Found::in_file(29.97));
    assert_eq!(rate("0.0417083750417").0, Found::in_file(23.976));
    assert_eq!(rate("0.04").0, Found::in_file(25.0));
    assert_eq!(rate("0.0285714").0, Found::in_file(1.0 / 0.028_571_4));
    let conventions = Conventions { frame_rate: Some(50.0), ..Conventions::default() };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let imported = BVH.import(ODD.as_bytes(), &NoFiles, &options).unwrap();
    let rate = imported.conversion.frame_rate.unwrap();
    assert_eq!((rate.value, rate.source), (50.0, ConventionSource::User));
    assert_eq!(imported.model.animation.takes[0].length, 0.04);
}

#[test]
fn a_human_is_as_tall_as_a_human_although_the_file_has_no_unit() {
    for path in files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let imported =
            read(&name, &std::fs::read(&path).unwrap(), &NoFiles, &ReadOptions::default()).unwrap();
        assert_eq!(imported.conversion.meters_per_unit.source, ConventionSource::Guess);
        assert_eq!(imported.conversion.up, Found::by_format(UpAxis::Y));
        let model = Arc::new(imported.model);
        assert!(model.animation.skeleton.bones.iter().all(|bone| bone.rest.scale == Vec3::ONE));
        let mut evaluator = Evaluator::new(Arc::clone(&model));
        let end = model.animation.takes[0].end();
        // The tallest pose of several: a figure may crouch at first.
        let height = (0..8).map(|part| {
            evaluator.pose(Some(0), end * part as f32 / 8.0);
            let joints = || evaluator.to_root().iter().map(|matrix| matrix.w_axis.truncate());
            let extent = joints().fold(Vec3::MIN, Vec3::max) - joints().fold(Vec3::MAX, Vec3::min);
            // Some files have z up, against the convention.
            extent.y.max(extent.z)
        });
        let height = height.fold(0.0, f32::max);
        println!("{name}: {height:.2} m, {}", imported.conversion);
        let is_on_its_back = ["fair1_dab.bvh", "pybvh_example.bvh"].contains(&name.as_str());
        assert_eq!(
            imported.warnings.iter().any(|warning| warning.code == "UP_DOUBTFUL"),
            is_on_its_back,
            "{name}"
        );
        // The other files are no humans.
        if model.animation.skeleton.len() > 20 {
            assert!((1.45..2.1).contains(&height), "{name}: {height}");
        }
    }
}

#[test]
fn units_and_axes_that_the_user_chooses_are_converted() {
    let conventions =
        Conventions { meters_per_unit: Some(0.5), up: Some(UpAxis::Z), ..Conventions::default() };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let chosen = BVH.import(ODD.as_bytes(), &NoFiles, &options).unwrap().model;
    let plain = import_in_meters(ODD.as_bytes());
    let track = |model: &dragonfly_anim::data::ModelData| model.animation.takes[0].tracks[0].clone();
    let (chosen, plain) = (track(&chosen), track(&plain));
    let Vec3 { x, y, z } = plain.translation.values[1];
    assert_eq!(chosen.translation.values[1], Vec3::new(x, z, -y) * 0.5);
    let [x, y, z, w] = plain.rotation.values[1].to_array();
    assert_eq!(chosen.rotation.values[1], Quat::from_xyzw(x, z, -y, w));
}

#[test]
fn errors_name_line_column_and_reason() {
    for (from, to, error) in [
        ("HIERARCHY", "HIER", "line 1 column 1: \"HIER\" where \"HIERARCHY\" was expected"),
        (
            "Yposition",
            "Wposition",
            "line 5 column 14: \"Wposition\" is no channel, such as Xposition or Zrotation",
        ),
        (
            "CHANNELS 6",
            "CHANNELS 7",
            "line 5 column 12: 7 is too large for the number of channels, at most 6",
        ),
        (
            "OFFSET 10 20",
            "OFFSET 10 2O",
            "line 7 column 15: \"2O\" is no number where an offset was expected",
        ),
        ("0 94 0", "0 1e13 0", "line 4 column 12: the offset is too large"),
        ("-31", "-3,1", "line 30 column 21: \"-3,1\" is no number where a number of the motion was expected"),
        ("-31", "nan", "line 30 column 21: \"nan\" is not finite where a number of the motion was expected"),
        (
            "Frames : 3",
            "Frames : -3",
            "line 26 column 10: \"-3\" is no whole number where the number of frames was expected",
        ),
        ("ROOT Prop", "JOINT Prop", "line 20 column 1: \"JOINT\" where \"MOTION\" or \"ROOT\" was expected"),
        ("\nROOT Prop", "}\nROOT Prop", "line 19 column 2: \"}\" where \"MOTION\" or \"ROOT\" was expected"),
        ("ROOT Prop\n{", "ROOT Prop", "line 21 column 3: \"OFFSET\" where \"{\" was expected"),
        ("91.0", "1e30", "line 29 column 2: the position is too large"),
        ("359", "1e30", ""),
    ] {
        let text = ODD.replacen(from, to, 1);
        assert_ne!(text, ODD);
        let found = import(text.as_bytes()).err().map(|error| error.to_string()).unwrap_or_default();
        assert_eq!(found, error);
    }
}
