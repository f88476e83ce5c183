//! Random edits: only rows of edited bones differ, and the saved file has the edited poses.

use super::made::{ODD, import, stored};
use crate::takes::{change_track, edited, key_times, opened_takes, plan, pose_difference, with_takes};
use dragonfly_anim::format::m3d::M3D;
use dragonfly_kit::random::{Random, seed};

/// Returns the text of a file in parts: for each clip and bone the rows of keys, and all that is around them.
fn parts(text: &str) -> (String, Vec<Vec<String>>) {
    let (mut around, mut lists) = (String::new(), Vec::new());
    let mut in_list = false;
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        // All lists of the files have one row in a line.
        let is_row = words.len() == 15 && words[0].starts_with('T');
        if is_row && !in_list {
            lists.push(Vec::new());
        }
        in_list = is_row;
        if is_row {
            lists.last_mut().unwrap().push(line.trim().to_owned());
        } else if words.get(1) == Some(&"#Keyframes:") {
            around += &format!("{} keys\n", words[0]);
        } else {
            around += line;
            around.push('\n');
        }
    }
    (around, lists)
}

#[test]
fn random_edits_change_only_their_rows_and_read_back_as_edited() {
    let first = seed(27_182);
    println!("DRAGONFLY_SEED={first}");
    let mut random = Random::new(first);
    let mut files = vec![("simple", String::from_utf8(stored("RiggedSimple.m3d")).unwrap(), 60)];
    if let Some(models) = dragonfly_kit::skip::models() {
        for name in ["greenman_dx12.m3d", "riggedfigure_dx11.m3d"] {
            files.push((name, std::fs::read_to_string(models.join("m3d").join(name)).unwrap(), 12));
        }
    }
    for (name, source, rounds) in files {
        let opened = import(source.as_bytes()).unwrap().model;
        let bones = opened.animation.skeleton.len();
        for _ in 0..rounds {
            let (take, bone) = (random.below(opened.animation.takes.len()), random.below(bones));
            let takes = edited(&opened, take, |edited| change_track(edited, bone, 0.07, &mut random));
            let saved = plan(&M3D, source.as_bytes(), &opened, &takes);
            assert_eq!(saved.lost, [], "{name}");
            let after = String::from_utf8(saved.files[0].bytes.clone()).unwrap();
            let ((around, lists), (new_around, new_lists)) = (parts(&source), parts(&after));
            assert!(around == new_around, "{name}: more than rows changed");
            assert_eq!(lists.len(), new_lists.len());
            for (list, (old, new)) in lists.iter().zip(&new_lists).enumerate() {
                assert!(old == new || list == take * bones + bone, "{name}: list {list}");
            }
            // Rows at unedited times keep their bytes.
            let (old, new) = (&lists[take * bones + bone], &new_lists[take * bones + bone]);
            let track = (&opened.animation.takes[take].tracks[bone], &takes[take].take.tracks[bone]);
            for row in old {
                let time: f32 = row.split_whitespace().nth(1).unwrap().parse().unwrap();
                let value = |track: &dragonfly_anim::data::Track| {
                    let key = track.translation.times.iter().position(|&known| known == time);
                    let turn = track.rotation.times.iter().position(|&known| known == time);
                    Some((
                        track.translation.values[key?],
                        track.rotation.values[turn?],
                        track.scale.times.contains(&time).then(|| ())?,
                    ))
                };
                let is_same = value(track.0).is_some()
                    && value(track.0) == value(track.1)
                    && track.0.scale == track.1.scale;
                assert!(!is_same || new.contains(row), "{name}: {row}");
            }
            let expected = with_takes(&opened, &takes);
            let again = import(after.as_bytes()).unwrap().model;
            let times = key_times(&takes[take].take);
            let difference = pose_difference(&again, &expected, take, &times);
            assert!(difference < 1e-4, "{name}: {difference}");
        }
    }
}

#[test]
fn saving_twice_gives_what_saving_once_gives() {
    let mut random = Random::new(seed(31_415));
    let opened = import(ODD.as_bytes()).unwrap().model;
    for _ in 0..100 {
        let takes = edited(&opened, 0, |take| change_track(take, 0, 0.05, &mut random));
        let once = plan(&M3D, ODD.as_bytes(), &opened, &takes).files[0].bytes.clone();
        let reopened = import(&once).unwrap().model;
        let twice = plan(&M3D, &once, &reopened, &opened_takes(&reopened)).files[0].bytes.clone();
        assert!(once == twice);
    }
}
