//! Exact times, and the rules of begins and ends by example.

use super::{DUEL, listed, scene, scheduled, span};
use dragonfly_anim::stage::schedule::resolve;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::{Decimal, StageRate, StageTime, TICKS_PER_SECOND, parse_time};

fn near(found: (f64, f64), expected: (f64, f64)) {
    let close = (found.0 - expected.0).abs() < 1e-6 && (found.1 - expected.1).abs() < 1e-6;
    assert!(close, "{found:?} instead of {expected:?}");
}

#[test]
fn frames_of_the_usual_rates_and_decimals_are_exact() {
    for (frames, seconds) in
        [(24, 1), (25, 1), (30, 1), (48, 1), (60, 1), (24_000, 1001), (30_000, 1001), (60_000, 1001)]
    {
        let rate = StageRate::new(frames, seconds).unwrap();
        let frame = rate.frame(1).ticks();
        assert_eq!(
            i128::from(frame) * i128::from(frames),
            i128::from(TICKS_PER_SECOND) * i128::from(seconds)
        );
        // The sum of frames is the time of their number.
        assert_eq!(rate.frame(86_399).ticks(), frame * 86_399);
    }
    let rate = StageRate::default();
    let ticks = |text: &str| parse_time(text, rate).map(StageTime::ticks);
    let second = Some(TICKS_PER_SECOND);
    assert_eq!(
        [ticks("1"), ticks("1s"), ticks("1000ms"), ticks("24f"), ticks("0:01"), ticks("01.000")],
        [second; 6]
    );
    assert_eq!(ticks("1:05.5"), Some(TICKS_PER_SECOND * 131 / 2));
    assert_eq!(ticks("-0:00.5"), Some(-TICKS_PER_SECOND / 2));
    assert_eq!(ticks("0.00001"), Some(7056));
    // Three tenths in the longest form that programs write; more than nine decimals that carry.
    assert_eq!(ticks("0.30000000000000004"), ticks("0.3"));
    assert_eq!(ticks("-0.9999999999"), ticks("-1"));
    assert_eq!(ticks("12.1234567894999"), ticks("12.123456789"));
    for wrong in
        ["", ".", "s", "1 s", "1,5", "1e3", "--1", "1:5", "1:60", "90000", "1:2:3", "inf", "NaN", "٣"]
    {
        assert_eq!(ticks(wrong), None, "{wrong}");
    }
}

#[test]
fn decimals_are_multiplied_and_divided_with_one_rounding() {
    let decimal = |text: &str| Decimal::parse(text).unwrap();
    let time = StageTime::from_ticks(10);
    assert_eq!(time.times(decimal("0.25")).ticks(), 3);
    assert_eq!(time.times(decimal("-0.25")).ticks(), -3);
    assert_eq!(time.over(decimal("4")).ticks(), 3);
    assert_eq!(time.over(decimal("-0.1")).ticks(), 100);
    assert_eq!(time.over(decimal("0")).ticks(), 0);
    assert_eq!(StageTime::from_seconds(f64::NAN), StageTime::ZERO);
    assert_eq!(StageTime::from_seconds(f64::INFINITY).seconds(), 86_400.0);
}

#[test]
fn the_scene_of_the_reference_has_the_times_of_the_prototype() {
    near(span(DUEL, "anna-walk"), (0.0, 2.579_440));
    near(span(DUEL, "grab"), (2.579_440, 3.979_440));
    near(span(DUEL, "anna-hit"), (3.979_440, 4.729_440));
    near(span(DUEL, "ben-falls"), (4.329_440, 5.829_440));
    let (script, schedule) = scheduled(DUEL);
    let end = (0..script.actions().len()).find(|&action| script.element(action).row.name == "title").unwrap();
    near((schedule.times()[end].begin.seconds(), schedule.length().seconds()), (5.829_440, 7.829_440));
    // Shots: the first to the second, the second to the third, the third to the end of the scene.
    let shots: Vec<(f64, f64)> = (0..script.actions().len())
        .filter(|&action| script.element(action).row.name == "shot")
        .map(|action| (schedule.times()[action].begin.seconds(), schedule.times()[action].end.seconds()))
        .collect();
    for (found, expected) in
        shots.into_iter().zip([(0.0, 2.679_440), (2.679_440, 4.729_440), (4.729_440, 7.829_440)])
    {
        near(found, expected);
    }
    assert!(schedule.notes().is_empty());
}

#[test]
fn a_passive_action_lasts_as_long_as_there_is_time_and_lengthens_nothing() {
    let text = scene(
        "<par id=\"p\"><look id=\"l\" who=\"anna\" at=\"ben\" begin=\"1\"/><seq><play who=\"anna\" take=\"Slash\"/>\
         <play id=\"i\" who=\"anna\" take=\"Idle\" repeat=\"fill\"/></seq><run id=\"r\" who=\"rain\" begin=\"5\"/>\
         <title id=\"t\" text=\"x\"/></par>",
    );
    near(span(&text, "p"), (0.0, 5.0));
    near(span(&text, "l"), (1.0, 5.0));
    near(span(&text, "i"), (0.9, 5.0));
    near(span(&text, "r"), (5.0, 5.0));
    near(span(&text, "t"), (0.0, 5.0));
}

#[test]
fn an_end_that_names_a_container_around_it_is_no_cycle() {
    let text = scene(
        "<par id=\"p\"><seq><play who=\"ben\" take=\"Fall\"/><run id=\"r\" who=\"rain\" begin=\"0.5\" end=\"p.end-0.25\"/></seq>\
         <wait dur=\"4\"/></par>",
    );
    near(span(&text, "r"), (2.0, 3.75));
}

#[test]
fn a_container_with_a_duration_stops_what_is_in_it_but_references_mean_the_end_by_the_rules() {
    let text = scene(
        "<par id=\"p\" dur=\"1\"><seq><play id=\"f\" who=\"ben\" take=\"Fall\"/><play id=\"s\" who=\"ben\" take=\"Slash\"/></seq></par>\
         <title id=\"t\" text=\"x\" begin=\"f.end\" dur=\"1\"/>",
    );
    let (script, schedule) = scheduled(&text);
    let of = |id: &str| schedule.times()[script.action_called(id).unwrap()];
    assert_eq!((of("f").end.seconds(), of("f").stop.seconds()), (1.5, 1.0));
    // An action that would begin after the end of its container takes no time.
    assert_eq!((of("s").begin.seconds(), of("s").stop.seconds()), (1.5, 1.5));
    assert_eq!((of("t").begin.seconds(), of("t").stop.seconds()), (1.5, 2.5));
}

#[test]
fn points_of_a_take_follow_its_part_and_speed() {
    let point = |attributes: &str| {
        let text = scene(&format!(
            "<play id=\"g\" who=\"anna\" take=\"PickUp\" {attributes}><at name=\"touch\" time=\"0.6\"/></play>\
             <wait id=\"w\" begin=\"g.touch\" dur=\"1\"/>"
        ));
        span(&text, "w").0
    };
    assert_eq!(point(""), 0.6);
    assert_eq!(point("speed=\"2\""), 0.3);
    assert_eq!(point("from=\"0.5\" to=\"1\" speed=\"0.5\" begin=\"1\""), 1.2);
    // Backwards from 1.4 s.
    assert_eq!(point("speed=\"-1\""), 0.8);
    assert_eq!(point("speed=\"-2\" repeat=\"3\""), 0.4);
}

#[test]
fn an_end_before_its_begin_takes_no_time_and_is_noted() {
    let text = scene("<wait id=\"a\" dur=\"1\"/><wait id=\"b\" begin=\"2\" end=\"a.end\"/>");
    let (script, schedule) = scheduled(&text);
    let times = schedule.times()[script.action_called("b").unwrap()];
    assert_eq!((times.begin.seconds(), times.end.seconds(), times.stop.seconds()), (2.0, 2.0, 2.0));
    assert_eq!(
        listed(schedule.notes()),
        "scene.xml:3:51: this end is 1.000 s before the begin, so <wait> takes no time"
    );
}

#[test]
fn a_cycle_names_every_action_in_it_with_its_line() {
    let text = scene(
        "<seq>\n<wait id=\"a\" begin=\"c.begin\" dur=\"1\"/>\n<wait id=\"b\"/>\n<wait id=\"c\" begin=\"b.end+1\"/></seq>",
    );
    let script = StageScript::read(text).unwrap();
    let errors = resolve(&script, &[]).unwrap_err();
    assert_eq!(errors.len(), 1, "{}", listed(&errors));
    let message = &errors[0].message;
    for name in ["<wait id=\"a\"> (line 4)", "<wait id=\"b\"> (line 5)", "<wait id=\"c\"> (line 6)"] {
        assert!(message.contains(name), "{message}");
    }
}

#[test]
fn the_usual_cycle_is_explained() {
    let text = scene(
        "<seq><play who=\"anna\" take=\"Idle\" repeat=\"fill\"/>\n<play who=\"anna\" take=\"Slash\"/></seq>",
    );
    let script = StageScript::read(text).unwrap();
    let errors = resolve(&script, &[]).unwrap_err();
    assert_eq!(errors[0].place.line, 4);
    assert_eq!(
        errors[0].help,
        "the action before it has no length of its own: give it a `dur`, or this one a `begin`"
    );
}

#[test]
fn the_nearest_frame_of_a_time_is_exact_at_every_rate() {
    for (frames, seconds) in
        [(1, 1), (24, 1), (24_000, 1001), (30_000, 1001), (60_000, 1001), (1000, 1), (997, 13)]
    {
        let rate = StageRate::new(frames, seconds).unwrap();
        for frame in (-2_000..2_000).chain([86_399_000, -86_399_000, 7_654_321]) {
            let time = rate.frame(frame);
            if time.seconds().abs() > 86_000.0 {
                continue;
            }
            assert_eq!(rate.nearest_frame(time), frame, "{frames}/{seconds}");
            // Nearly half a frame to both sides, by the definition.
            let half = (rate.frame(1).ticks() - 2) / 2;
            for away in [half, -half] {
                assert_eq!(rate.nearest_frame(StageTime::from_ticks(time.ticks() + away)), frame);
            }
            // The same in single precision, as a clock has it.
            assert_eq!(rate.time_of(f64::from(time.seconds() as f32)), time, "{frames}/{seconds}, {frame}");
        }
        let between = StageTime::from_ticks(rate.frame(5).ticks() + rate.frame(1).ticks() / 3);
        let found = rate.time_of(between.seconds());
        assert!((found.ticks() - between.ticks()).abs() <= 1, "a time between two frames stays there");
    }
}

#[test]
fn a_number_is_the_same_with_any_number_of_zeros_at_its_end() {
    assert_eq!(Decimal::parse("1.0000000000"), Some(Decimal::ONE));
    assert_eq!(Decimal::parse("2.50000000000000"), Decimal::parse("2.5"));
    assert_eq!(Decimal::parse("0.9999999999"), Some(Decimal::ONE), "rounded to nine decimals");
    assert_eq!(Decimal::parse("-1.4999999996"), Decimal::parse("-1.5"));
    assert_eq!(StageRate::parse("24.0000000000"), StageRate::new(24, 1));
    assert_eq!(StageRate::parse("23.97600000000"), StageRate::parse("23.976"));
}
