//! Random edits: only keys of edited bones differ, and the saved file has the edited poses.

use super::made::{import, pendulum};
use crate::takes::{change_track, edited, key_times, plan, pose_difference, with_takes};
use dragonfly_anim::format::x::X;
use dragonfly_kit::random::{Random, seed};

/// Returns the lines of a text outside of one block: the object of a take that animates a frame.
fn outside<'a>(text: &'a str, set: &str, frame: &str) -> Vec<&'a str> {
    let start = text.find(&format!("AnimationSet {set} ")).unwrap();
    let end = text[start + 1..].find("\nAnimationSet").map_or(text.len(), |end| start + 1 + end);
    let own = &text[start..end];
    let reference = [format!("{{ {frame} }}"), format!("{{{frame}}}")];
    let Some(at) = reference.iter().find_map(|reference| own.find(reference.as_str())) else {
        return text.lines().collect();
    };
    let first = own[..at].rfind("Animation ").unwrap();
    let last = own[at..].find("\n Animation ").map_or(own.len(), |next| at + next);
    text[..start + first].lines().chain(text[start + last..].lines()).collect()
}

#[test]
fn random_edits_change_only_their_keys_and_read_back_as_edited() {
    let first = seed(16_180);
    println!("DRAGONFLY_SEED={first}");
    let mut random = Random::new(first);
    let mut files = vec![("pendulum.x", pendulum(), 150)];
    if let Some(models) = dragonfly_kit::skip::models() {
        for name in ["tiny.x", "Testwuson.X"] {
            let bytes = std::fs::read(models.join("x").join(name)).unwrap();
            files.push((name, bytes.into_iter().map(char::from).filter(char::is_ascii).collect(), 8));
        }
    }
    for (name, source, rounds) in files {
        let opened = import(source.as_bytes()).unwrap().model;
        let skeleton = &opened.animation.skeleton;
        for _ in 0..rounds {
            let take = random.below(opened.animation.takes.len());
            let bone = random.below(skeleton.len());
            let frame = skeleton.bones[bone].name.as_str();
            if !source.contains(&format!("Frame {frame} {{")) {
                continue;
            }
            let takes = edited(&opened, take, |edited| change_track(edited, bone, 1.0 / 24.0, &mut random));
            let saved = plan(&X, source.as_bytes(), &opened, &takes);
            assert_eq!(saved.lost, [], "{name}");
            let after = String::from_utf8(saved.files[0].bytes.clone()).unwrap();
            let set = &opened.animation.takes[take].name;
            if opened.animation.takes[take].tracks[bone].is_empty() {
                // A new object is added, and nothing else.
                assert!(after.len() > source.len() || takes[take].take == opened.animation.takes[take]);
            } else {
                let (old, new) = (outside(&source, set, frame), outside(&after, set, frame));
                assert!(old == new, "{name}: more than the keys of {frame} changed");
            }
            let expected = with_takes(&opened, &takes);
            let again = import(after.as_bytes()).unwrap().model;
            let times = key_times(&takes[take].take);
            let difference = pose_difference(&again, &expected, take, &times);
            assert!(difference < 1e-4, "{name}, {set}, {frame}: {difference}");
        }
    }
}
