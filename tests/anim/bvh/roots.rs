//! Several roots are below one more joint in a written file, and roots again when it is read.

use super::made::{ODD, edited, import_in_meters, plan, pose_difference, text};
use dragonfly_anim::data::{Bone, Channel, Interpolation, ModelData};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Conventions, NoFiles, ReadOptions, bvh};
use glam::Vec3;
use std::sync::Arc;

const NAME: &str = "dragonfly_common_root";

/// Returns the written file of [`ODD`], whose bones have names that every program reads, and its losses.
fn written() -> (ModelData, String, Vec<String>) {
    let model = import_in_meters(ODD.replace("Left Arm", "Left_Arm").as_bytes());
    let file = bvh::write(&model).unwrap();
    let lost = file.lost.iter().map(ToString::to_string).collect();
    (model, String::from_utf8(file.bytes).unwrap(), lost)
}

fn read_back(text: &str) -> ModelData {
    let conventions = Conventions { meters_per_unit: Some(0.01), ..Conventions::default() };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    bvh::BVH.import(text.as_bytes(), &NoFiles, &options).unwrap().model
}

fn bones(model: &ModelData) -> Vec<(&str, Option<u32>)> {
    model.animation.skeleton.bones.iter().map(|bone| (bone.name.as_str(), bone.parent)).collect()
}

#[test]
fn several_roots_are_written_below_one_joint_and_are_roots_again_when_the_file_is_read() {
    let (model, text, lost) = written();
    assert_eq!(text.lines().filter(|line| line.starts_with("ROOT")).count(), 1);
    assert!(text.contains(&format!("ROOT {NAME}\n")) && text.contains("\tJOINT Prop\n"), "{text}");
    assert_eq!(
        lost[0],
        format!(
            "/animation/skeleton/bones: the 2 root bones are below one more joint, \"{NAME}\", which is no bone when \
             Dragonfly reads the file again"
        )
    );
    let again = read_back(&text);
    // Joints without a child get a tip; all others are there, below the same ones.
    let with_parents = |model: &ModelData| -> Vec<(String, Option<String>)> {
        let bones = &model.animation.skeleton.bones;
        let parent = |bone: &Bone| bone.parent.map(|parent| bones[parent as usize].name.clone());
        bones.iter().map(|bone| (bone.name.clone(), parent(bone))).collect()
    };
    let (before, after) = (with_parents(&model), with_parents(&again));
    assert!(before.iter().all(|bone| after.contains(bone)), "{before:?} {after:?}");
    assert!(after.iter().all(|bone| before.contains(bone) || bone.0.ends_with("_end")), "{after:?}");
    let [mut ours, mut theirs] = [&model, &again].map(|model| Evaluator::new(Arc::new(model.clone())));
    for frame in 0..3 {
        let time = frame as f32 / 120.0;
        ours.pose(Some(0), time);
        theirs.pose(Some(0), time);
        for (matrix, (name, _)) in ours.to_root().iter().zip(&before) {
            let there = theirs.to_root()[again.animation.skeleton.find(name).unwrap() as usize];
            // 90 meters above the ground.
            let off = there.w_axis.truncate().distance(matrix.w_axis.truncate());
            assert!(off < 1e-4, "{name} at {time}: {off}");
        }
    }
    // Written again, the file has the same joints.
    let joints = |text: &str| text[..text.find("MOTION").unwrap()].to_owned();
    let twice = String::from_utf8(bvh::write(&again).unwrap().bytes).unwrap();
    assert_eq!(joints(&twice), joints(&text));
}

#[test]
fn one_root_is_written_as_the_root_of_the_file() {
    let one = import_in_meters(&ODD.as_bytes()[..ODD.find("ROOT Prop").unwrap()]);
    let file = bvh::write(&one).unwrap();
    assert!(!String::from_utf8(file.bytes).unwrap().contains(NAME));
    assert!(file.lost.iter().all(|lost| lost.code != bvh::check::COMMON_ROOT_ADDED));
}

#[test]
fn a_joint_of_that_name_that_moves_or_has_one_child_or_an_offset_is_a_bone() {
    let (_, text, _) = written();
    let row = text.find("Frame Time").unwrap();
    let first = text[row..].find('\n').unwrap() + row + 1;
    let moved = format!("{}1{}", &text[..first], &text[first + 1..]);
    let placed = text.replacen("OFFSET 0.000000", "OFFSET 1.000000", 1);
    let alone =
        format!("HIERARCHY\nROOT {NAME}\n{{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT a\n{{\nOFFSET 1 2 3\n}}\n}}\n");
    for (what, changed) in [("moved", &moved), ("placed", &placed), ("alone", &alone)] {
        assert_eq!(read_back(changed).animation.skeleton.bones[0].name, NAME, "{what}");
    }
}

#[test]
fn a_bone_of_that_name_gets_another_one_and_stays_a_bone() {
    let (model, ..) = written();
    let mut named = model.clone();
    Arc::make_mut(&mut named.animation.skeleton).bones[0].name = NAME.to_owned();
    let file = bvh::write(&named).unwrap();
    let renamed = format!("the bone \"{NAME}\" is called \"{NAME}_2\"");
    assert!(file.lost.iter().any(|lost| lost.text == renamed), "{:?}", file.lost);
    let again = read_back(&String::from_utf8(file.bytes).unwrap());
    assert_eq!(again.animation.skeleton.bones[0].name, format!("{NAME}_2"));
    assert_eq!(again.animation.skeleton.children(None).count(), 2);
}

#[test]
fn edits_and_new_rows_of_such_a_file_keep_the_numbers_of_the_common_joint() {
    let (_, text_before, _) = written();
    let model = import_in_meters(text_before.as_bytes());
    assert_eq!(
        plan(text_before.as_bytes(), &model, &edited(&model, |_| {})).to_string(),
        "nothing changes\n"
    );
    let longer = edited(&model, |take| {
        let channel = &mut take.tracks[0].translation;
        let times: Vec<f32> = channel.times.iter().copied().chain([4.0 / 120.0]).collect();
        let values = [channel.values.to_vec(), vec![Vec3::new(9.0, 92.0, 3.0)]].concat();
        *channel = Channel::new(times, values, Interpolation::Linear);
    });
    let grown = text(&plan(text_before.as_bytes(), &model, &longer));
    let rows: Vec<&str> = grown.lines().skip_while(|line| !line.starts_with("Frame Time")).skip(1).collect();
    assert_eq!(rows.len(), 5);
    let numbers = rows.iter().map(|row| row.split(' ').count()).collect::<Vec<_>>();
    assert_eq!(numbers, [numbers[0]; 5]);
    for row in &rows {
        assert!(row.starts_with("0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 "), "{row}");
    }
    let again = import_in_meters(grown.as_bytes());
    assert_eq!(bones(&again), bones(&model));
    let mut wanted = model;
    wanted.animation.takes = vec![Arc::clone(&longer[0].take)];
    assert!(
        pose_difference(&again, &wanted, &[0.0, 1.0 / 120.0, 2.0 / 120.0, 3.0 / 120.0, 4.0 / 120.0]) < 1e-5
    );
}
