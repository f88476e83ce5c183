//! Clips are moved, trimmed, copied and deleted: ends, the rest of a clip, and references to the one before stay.

use super::actors::{assets, at, bits, fox, planned, seconds};
use super::gestures::{called, changed, gesture, moved};
use super::read;
use dragonfly_anim::stage::gesture::{
    Followers, GestureRefusal, SequenceOrder, add_clip, delete_clip, duplicate_clip, move_clip,
    sequence_move, sequence_place, trim_end, trim_start,
};

/// Returns begin and end of the action called `id`, seconds.
fn times(text: &str, id: &str) -> [f64; 2] {
    let times = planned(text, &assets(&fox())).schedule().times()[read(text).action_called(id).expect(id)];
    [times.begin.seconds(), times.end.seconds()]
}

#[test]
fn the_end_of_a_moved_clip_moves_with_its_begin() {
    let clip = r#"<play id="x" who="anna" take="Survey" begin="1" end="3"/>"#;
    assert_eq!(
        changed(clip, |scene| moved(scene, "x", 5.0)),
        [r#"<play id="x" who="anna" take="Survey" begin="5" end="7"/>"#]
    );
    // Frames stay frames, and a clip in a seq that changes places loses its distance to the one before.
    let seq = "<seq>\n<play id=\"a\" who=\"anna\" take=\"Survey\"/>\n<play id=\"x\" who=\"anna\" take=\"Run\" begin=\"12f\" end=\"24f\"/>\n</seq>";
    let (_, new) = gesture(seq, |scene| {
        move_clip(scene, called(scene, "x"), seconds(0.0), SequenceOrder::Change, Followers::Follow)
    });
    assert_eq!(times(&new.expect("a text"), "x"), [0.0, 0.5]);
    // The next one moves along, or stays.
    let pair = "<seq>\n<play id=\"x\" who=\"anna\" take=\"Survey\" end=\"2\"/>\n<play id=\"y\" who=\"anna\" take=\"Run\"/>\n</seq>";
    for (followers, begin) in [(Followers::Follow, 2.5), (Followers::Stay, 2.0)] {
        let (_, new) = gesture(pair, |scene| {
            move_clip(scene, called(scene, "x"), seconds(0.5), SequenceOrder::Keep, followers)
        });
        let new = new.expect("a text");
        assert_eq!((times(&new, "x"), times(&new, "y")[0]), ([0.5, 2.5], begin), "{new}");
    }
}

#[test]
fn a_moved_clip_names_its_new_place_in_the_sequence_and_its_new_begin() {
    let seq = "<seq>\n<play id=\"a\" who=\"anna\" take=\"Survey\"/>\n<play id=\"b\" who=\"anna\" take=\"Walk\"/>\n<play id=\"c\" who=\"anna\" take=\"Run\"/>\n</seq>";
    for (id, to, number) in [("c", 0.0, Some(1)), ("a", 9.0, Some(3)), ("a", 0.1, None)] {
        let mut told = None;
        let (_, new) = gesture(seq, |scene| {
            let action = called(scene, id);
            told = sequence_place(scene, action, seconds(to))
                .and_then(|place| sequence_move(scene, action, place));
            move_clip(scene, action, seconds(to), SequenceOrder::Change, Followers::Follow)
        });
        let new = new.expect("a text");
        assert_eq!(told.map(|told| told.number), number, "{id} to {to}");
        let begin = told.map_or(to, |told| told.begin.seconds());
        assert!((begin - times(&new, id)[0]).abs() < 1e-6, "{begin}: {new}");
    }
}

#[test]
fn a_clip_is_not_moved_past_an_end_that_another_action_gives() {
    let two = "<play id=\"a\" who=\"ben\" take=\"Survey\"/>\n<play id=\"x\" who=\"anna\" take=\"Survey\" end=\"a.end-0.5\"/>";
    let (_, new) = gesture(two, |scene| moved(scene, "x", 2.0));
    assert!(new.expect("before that end").contains("end=\"a.end-0.5\" begin=\"2\""));
    let (_, new) = gesture(two, |scene| moved(scene, "x", 3.0));
    assert_eq!(new.expect_err("after it").to_string(), "It would have no length");
    let (_, copy) = gesture(two, |scene| duplicate_clip(scene, called(scene, "x")));
    assert_eq!(copy.expect_err("it begins there").to_string(), "It would have no length");
}

#[test]
fn a_copy_is_as_long_as_its_original() {
    let clip = r#"<play id="x" who="anna" take="Survey" begin="1" end="3"/>"#;
    assert_eq!(
        changed(clip, |scene| duplicate_clip(scene, called(scene, "x"))),
        [r#"<play id="x-2" who="anna" take="Survey" begin="3" end="5"/>"#]
    );
    let seq = format!("<wait id=\"w\" dur=\"0.5\"/>\n<seq>\n{clip}\n</seq>")
        .replace("begin=\"1\"", "begin=\"w.end\"");
    let (_, new) = gesture(&seq, |scene| duplicate_clip(scene, called(scene, "x")));
    assert_eq!(times(&new.expect("a text"), "x-2"), [3.0, 5.5]);
}

/// The second action refers to the first one as the one before.
const PREV: &str = "<par>\n<play id=\"a\" who=\"anna\" take=\"Survey\" begin=\"1\"/>\n<play id=\"b\" who=\"ben\" take=\"Walk\" begin=\"prev.begin+1\"/>\n<wait id=\"c\" dur=\"2\"/>\n</par>";

#[test]
fn no_action_gets_another_one_before_it_that_it_refers_to() {
    let wanted =
        "<play id=\"b\"> (line 4) begins or ends relative to the action before it: change that first";
    let refusal = |(_, new): (String, Result<String, GestureRefusal>)| -> String {
        new.unwrap_or_else(|refusal| refusal.to_string())
    };
    assert_eq!(refusal(gesture(PREV, |s| delete_clip(s, called(s, "a"), Followers::Follow))), wanted);
    assert_eq!(refusal(gesture(PREV, |s| duplicate_clip(s, called(s, "a")))), wanted);
    // A new action does not come between them.
    let looks =
        PREV.replace("<play id=\"b\" who=\"ben\" take=\"Walk\"", "<look id=\"b\" who=\"wide\" at=\"ben\"");
    let (old, new) = gesture(&looks, |s| add_clip(s, "anna", "Walk", seconds(9.0)));
    let new = new.expect("a text");
    assert!(new.contains("Walk") && times(&new, "b")[0] == times(&old, "b")[0], "{new}");
    // One that goes elsewhere would leave the one that refers to it with another one before it.
    let seq = PREV.replace("par>", "seq>");
    let change = |id: &'static str, to: f64| {
        let seq = seq.clone();
        refusal(gesture(&seq, move |s| {
            move_clip(s, called(s, id), seconds(to), SequenceOrder::Change, Followers::Follow)
        }))
    };
    assert_eq!(change("a", 4.5), wanted);
    // The first action of a sequence has none before it that it could refer to, whatever follows the sequence.
    let behind = "<par>\n<seq>\n<play id=\"a\" who=\"anna\" take=\"Survey\"/>\n<play id=\"b\" who=\"anna\" take=\"Walk\"/>\n</seq>\n<play id=\"c\" who=\"ben\" take=\"Walk\" begin=\"prev.end\"/>\n</par>";
    let (old, new) = gesture(behind, |s| {
        move_clip(s, called(s, "b"), seconds(0.0), SequenceOrder::Change, Followers::Follow)
    });
    let new = new.expect("a text");
    assert_eq!((times(&new, "b")[0], times(&new, "c")[0]), (0.0, times(&old, "c")[0]), "{new}");
    // Away from it, nothing is refused.
    let (_, new) = gesture(PREV, |s| delete_clip(s, called(s, "c"), Followers::Follow));
    assert_eq!(times(&new.expect("a text"), "b")[0], 2.0);
    // A copy of the one that refers begins where the original ends, without a reference.
    let (old, new) = gesture(PREV, |s| duplicate_clip(s, called(s, "b")));
    let (old, new) = (times(&old, "b"), times(&new.expect("a text"), "b-2"));
    assert!(
        (new[0] - old[1]).abs() < 1e-3 && ((new[1] - new[0]) - (old[1] - old[0])).abs() < 1e-9,
        "{new:?}"
    );
}

#[test]
fn a_trimmed_start_leaves_the_rest_to_the_bit_also_at_times_that_are_no_milliseconds() {
    for clip in [
        r#"<play id="x" who="anna" take="Survey"/>"#,
        r#"<play id="x" who="anna" take="Survey" speed="-0.5" to="2"/>"#,
    ] {
        let (old, new) = gesture(clip, |scene| trim_start(scene, called(scene, "x"), seconds(0.765_432_1)));
        let new = new.expect("a text");
        let poses = |text: &str| {
            let plan = planned(text, &assets(&fox()));
            [0.77, 1.5, 3.0].map(|time| bits(&at(&plan, time)))
        };
        assert!(poses(&old) == poses(&new), "{new}");
    }
}

#[test]
fn a_start_is_not_trimmed_where_the_rest_would_move() {
    let refusal = |clip: &str| {
        gesture(clip, |scene| trim_start(scene, called(scene, "x"), seconds(0.25)))
            .1
            .unwrap_or_else(|no| no.to_string())
    };
    assert_eq!(
        refusal(r#"<move id="x" who="anna" path="aisle" take="Walk" repeat="fill" dur="9"/>"#),
        "It repeats: trim its end, or move it"
    );
    assert_eq!(
        refusal(r#"<sound id="x" src="a.ogg"/>"#),
        "A sound plays from its start: move it, or trim its end"
    );
}

#[test]
fn a_trimmed_start_of_a_clip_that_repeats_leaves_its_end_and_begins_with_the_start_of_the_take() {
    for clip in [
        r#"<play id="x" who="anna" take="Walk" repeat="3"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="2.5" speed="-1"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="fill" dur="9"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="4" from="0.1" to="0.6" dur="1.5"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="fill" end="3"/>"#,
    ] {
        let (old, new) = gesture(clip, |scene| trim_start(scene, called(scene, "x"), seconds(0.25)));
        let new = new.expect("a text");
        let ([_, old_end], [begin, end]) = (times(&old, "x"), times(&new, "x"));
        assert!(begin == 0.25 && (end - old_end).abs() <= 1e-4, "{begin} to {end}, not {old_end}: {new}");
        // It begins as it did.
        let part = |text: &str, name: &str| text.contains(name);
        assert_eq!(part(&new, "from="), part(&old, "from="), "{new}");
        let (same, new) = gesture(clip, |scene| trim_start(scene, called(scene, "x"), seconds(0.0)));
        assert_eq!(new.expect("a text"), same);
    }
}

#[test]
fn a_clip_that_repeats_ends_where_the_pointer_is_within_a_tenth_of_a_millisecond() {
    // Slowed down, one repetition takes a minute.
    let slow = r#"<play id="x" who="anna" take="Survey" speed="0.05"/>"#;
    for to in [100.0, 123.456_789, 250.017] {
        let (_, new) =
            gesture(slow, |scene| trim_end(scene, called(scene, "x"), seconds(to), Followers::Follow));
        let new = new.expect("a text");
        assert!((times(&new, "x")[1] - to).abs() < 1e-4, "{} instead of {to}: {new}", times(&new, "x")[1]);
    }
    // The next one stays by the number that is written.
    let pair = format!("<seq>\n{slow}\n<wait id=\"y\" begin=\"200\" dur=\"1\"/>\n</seq>");
    let (old, new) =
        gesture(&pair, |scene| trim_end(scene, called(scene, "x"), seconds(100.017_3), Followers::Stay));
    let (old, new) = (times(&old, "y")[0], times(&new.expect("a text"), "y")[0]);
    assert!((0.0..0.001_1).contains(&(old - new)), "{old} {new}");
}
