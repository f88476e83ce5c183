//! Random edits of a text: each changes exactly the bytes that it names, and undo of all leads back byte for byte.

use super::scenes::SCENE;
use dragonfly_anim::data::ModelData;
use dragonfly_document::adapter::{ModelAdapter, TextFiles};
use dragonfly_document::edit::{EditScript, ScriptSplice};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_kit::random::{Random, seed};

/// Returns a random edit of `text`, and the text after it, computed from the end to the start.
fn random_edit(text: &str, random: &mut Random) -> (EditScript, String) {
    let mut below = |end: usize| (random.bits() % end.max(1) as u64) as usize;
    let mut splices: Vec<ScriptSplice> = Vec::new();
    let mut from = 0;
    for _ in 0..1 + below(4) {
        let boundaries: Vec<usize> = (from..=text.len()).filter(|&at| text.is_char_boundary(at)).collect();
        let first = below(boundaries.len());
        let last = (first + below(9)).min(boundaries.len() - 1);
        let (at, end) = (boundaries[first], boundaries[last]);
        let new = ["", "é", "<wait/>", "\r\n", "0.25", " speed=\"2\""][below(6)];
        splices.push(ScriptSplice { at, old: text[at..end].to_owned(), new: new.to_owned() });
        from = end;
        if from == text.len() {
            break;
        }
    }
    let mut after = text.to_owned();
    for splice in splices.iter().rev() {
        after.replace_range(splice.at..splice.at + splice.old.len(), &splice.new);
    }
    if below(2) == 0 && splices.windows(2).all(|pair| pair[0].at < pair[1].at) {
        splices.reverse();
    }
    (EditScript { text: None, create: false, splices, label: None, also: Vec::new() }, after)
}

#[test]
fn any_sequence_of_edits_and_gestures_changes_what_it_says_and_undo_of_all_gives_the_identical_text() {
    let number = seed(90);
    let mut random = Random::new(number);
    for _ in 0..200 {
        let adapter = ModelAdapter::of(&ModelData::default()).with_texts(TextFiles::one("scene.xml", SCENE));
        let mut edited = Edited::new(adapter);
        let text = |edited: &Edited| edited.adapter().texts().main().expect("a text").to_string();
        let mut states = vec![SCENE.to_owned()];
        for step in 0..30 {
            match random.bits() % 5 {
                0 if edited.steps().1 > 0 => {
                    assert!(edited.undo());
                    assert_eq!(text(&edited), states[edited.steps().1], "seed {number}");
                    continue;
                }
                1 if edited.redo() => {
                    assert_eq!(text(&edited), states[edited.steps().1], "seed {number}");
                    continue;
                }
                _ => {}
            }
            let before = states[edited.steps().1].clone();
            let gesture = random.bits().is_multiple_of(3).then_some(Gesture(step));
            let mut wanted = None;
            // Each edit of a gesture is relative to the text before the gesture.
            for _ in 0..if gesture.is_some() { 3 } else { 1 } {
                let (edit, after) = random_edit(&before, &mut random);
                if edited.ask(edit.clone().into(), gesture).is_ok() {
                    assert_eq!(text(&edited), after, "seed {number}: {edit:?}");
                    wanted = Some(after);
                } else {
                    assert!(
                        edit.splices.iter().all(|splice| splice.old == splice.new),
                        "seed {number}: {edit:?}"
                    );
                }
            }
            if let Some(after) = wanted {
                states.truncate(edited.steps().1);
                states.push(after);
            }
        }
        assert!(edited.go_to(0) && text(&edited) == SCENE, "seed {number}");
        let all = edited.steps().0.len();
        assert!(edited.go_to(all) && text(&edited) == states[all], "seed {number}");
    }
}

#[test]
fn the_shortest_replacement_between_two_texts_leads_from_one_to_the_other_between_whole_characters() {
    let mut random = Random::new(seed(91));
    for _ in 0..2000 {
        let (_, new) = random_edit(SCENE, &mut random);
        let Some(edit) = EditScript::between(SCENE, &new, None) else {
            assert_eq!(new, SCENE);
            continue;
        };
        let texts = TextFiles::one("scene.xml", SCENE);
        let splices = edit.splices_in(&texts.list()[0]).expect("it fits");
        assert_eq!(splices.apply(SCENE), new);
        let [splice] = &edit.splices[..] else { panic!("{edit:?}") };
        let [old, new] = [&splice.old, &splice.new].map(|text| text.chars().next().zip(text.chars().last()));
        if let (Some((a, b)), Some((c, d))) = (old, new) {
            assert!(a != c && b != d, "it is not the shortest: {splice:?}");
        }
    }
}
