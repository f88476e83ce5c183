//! Random edits: only numbers of edited frames and joints differ, and the saved file has the edited poses.

use super::made::{ODD, edited, import_in_meters, plan, pose_difference, text};
use crate::doors::data;
use dragonfly_anim::data::{Channel, Interpolation, ModelData, Take};
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::collections::HashSet;
use std::sync::Arc;

/// Returns the names of the columns of each bone in a row, from the text of the file.
fn columns(text: &str, bones: usize) -> Vec<Vec<String>> {
    let (mut columns, mut stack, mut next) = (vec![Vec::new(); bones], Vec::new(), 0);
    let words: Vec<&str> = text[..text.find("MOTION").unwrap()].split_whitespace().collect();
    for (index, word) in words.iter().enumerate() {
        match *word {
            "{" => {
                stack.push(next);
                next += 1;
            }
            "}" => _ = stack.pop(),
            "CHANNELS" => {
                let count: usize = words[index + 1].parse().unwrap();
                columns[*stack.last().unwrap()] =
                    words[index + 2..][..count].iter().map(|name| name.to_ascii_lowercase()).collect();
            }
            _ => {}
        }
    }
    columns
}

/// Edited keys: pairs of a bone and a frame.
type Edited = HashSet<(usize, usize)>;

/// Changes some keys of a take, and returns which.
fn change(take: &mut Take, random: &mut Random, columns: &[Vec<String>]) -> Edited {
    let count_of = |bone: usize, kind: &str| -> usize {
        ["x", "y", "z"].iter().filter(|axis| columns[bone].contains(&format!("{axis}{kind}"))).count()
    };
    let mut edits = Edited::new();
    for _ in 0..=random.below(6) {
        let bone = random.below(columns.len());
        let frames = take.tracks[0].rotation.len();
        let (first, track) = (random.below(frames), &mut take.tracks[bone]);
        // A joint with fewer angles cannot be turned freely.
        if count_of(bone, "rotation") < 3 {
            continue;
        }
        let count = 1 + random.below(5).min(frames - first - 1);
        let mut rotations = track.rotation.values.to_vec();
        let mut translations = track.translation.values.to_vec();
        for frame in first..first + count {
            let axis = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.3).normalize();
            rotations[frame] =
                (rotations[frame] * Quat::from_axis_angle(axis, random.between(-3.0, 3.0))).normalize();
            if count_of(bone, "position") == 3 {
                translations[frame] += Vec3::new(random.between(-9.0, 9.0), 0.0, random.between(-1.0, 1.0));
            }
            edits.insert((bone, frame));
        }
        let times = Arc::clone(&track.rotation.times);
        track.rotation = Channel::new(Arc::clone(&times), rotations, Interpolation::Linear);
        if !translations.is_empty() {
            track.translation = Channel::new(times, translations, Interpolation::Linear);
        }
    }
    edits
}

/// Returns the text between the numbers of the motion, and the numbers.
fn split(text: &str) -> (Vec<&str>, Vec<&str>) {
    let at = text.find("MOTION").unwrap();
    let mut parts = text[at..].split_inclusive(|character: char| !character.is_whitespace());
    let head = parts.by_ref().next().map_or(0, str::len);
    let rest = &text[at + head..];
    let numbers: Vec<&str> = rest.split_whitespace().collect();
    let blanks = rest.split(|character: char| !character.is_whitespace()).filter(|blank| !blank.is_empty());
    (std::iter::once(&text[..at]).chain(blanks).collect(), numbers)
}

fn check(name: &str, source: &str, random: &mut Random) {
    let opened = import_in_meters(source.as_bytes());
    let columns = columns(source, opened.animation.skeleton.len());
    let mut edits = Edited::new();
    let takes = edited(&opened, |take| edits = change(take, random, &columns));
    let plan = plan(source.as_bytes(), &opened, &takes);
    assert_eq!(plan.lost, [], "{name}");
    let saved = text(&plan);

    let ((blanks, numbers), (new_blanks, new_numbers)) = (split(source), split(&saved));
    assert!(blanks == new_blanks, "{name}: a blank changed");
    let width: usize = columns.iter().map(Vec::len).sum();
    let bone_of: Vec<usize> =
        columns.iter().enumerate().flat_map(|(bone, columns)| vec![bone; columns.len()]).collect();
    // The words of the head come first.
    let head = numbers.len() - opened.animation.takes[0].tracks[0].rotation.len() * width;
    for (index, (old, new)) in numbers.iter().zip(&new_numbers).enumerate() {
        if old != new {
            let (frame, column) = ((index - head) / width, (index - head) % width);
            assert!(edits.contains(&(bone_of[column], frame)), "{name}: {old} → {new} in frame {frame}");
            let (from, to): (f64, f64) = (old.parse().unwrap(), new.parse().unwrap());
            assert!((from - to).abs() <= 720.0, "{name}: {old} → {new}");
        }
    }

    let mut expected: ModelData = opened.clone();
    expected.animation.takes[0] = Arc::clone(&takes[0].take);
    let again = import_in_meters(saved.as_bytes());
    let times = &again.animation.takes[0].tracks[0].rotation.times;
    let difference = pose_difference(&again, &expected, times);
    assert!(difference < 1e-4, "{name}: {difference}");
}

#[test]
fn random_edits_change_only_their_numbers_and_read_back_as_edited() {
    let first = seed(41_777);
    println!("DRAGONFLY_SEED={first}");
    let mut random = Random::new(first);
    let stored = ["rotation_first_root", "full_precision_frame_time", "pybvh_test2", "pybvh_example"];
    let stored =
        stored.map(|name| (name, std::fs::read_to_string(data().join(format!("bvh/{name}.bvh"))).unwrap()));
    for (name, source) in stored.iter().map(|(name, text)| (*name, text.as_str())).chain([("odd", ODD)]) {
        for _ in 0..if source.len() < 2000 { 150 } else { 25 } {
            check(name, source, &mut random);
        }
    }
}
