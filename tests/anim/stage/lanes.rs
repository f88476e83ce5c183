//! The lanes of a timeline.

use super::actors::{assets, fox, fox_script, planned};
use super::read;
use dragonfly_anim::stage::lanes::SceneLanes;

fn lanes(actions: &str) -> SceneLanes {
    let text = fox_script(actions);
    SceneLanes::new(&read(&text), &planned(&text, &assets(&fox())))
}

/// Returns a line for each lane: its name, and for each bar its label, row, and times in hundredths of a second.
fn described(lanes: &SceneLanes) -> Vec<String> {
    let cents = |time: dragonfly_anim::stage::time::StageTime| (time.seconds() * 100.0).round();
    let bar = |bar: &dragonfly_anim::stage::lanes::SceneBar| {
        format!(" | {} r{} {}-{}", bar.label, bar.row, cents(bar.begin), cents(bar.end))
    };
    lanes
        .list
        .iter()
        .map(|lane| format!("{}{}", lane.name, lane.bars.iter().map(bar).collect::<String>()))
        .collect()
}

#[test]
fn every_role_has_a_lane_and_every_action_a_bar_in_it() {
    let lanes = lanes(
        "<par><shot who=\"wide\"/><shot who=\"close\" begin=\"1\" blend=\"0.5\"/>\
         <seq><play who=\"anna\" take=\"Survey\" to=\"2\"/><play who=\"anna\" take=\"Run\" begin=\"-0.5\" fade-in=\"0.5\" dur=\"1\"/></seq>\
         <look who=\"anna\" at=\"ben\" bones=\"b_Head_05\" begin=\"0.5\" dur=\"1\"/><attach who=\"sword\" to=\"anna\" begin=\"1\"/>\
         <turn who=\"anna\" to=\"ben\" begin=\"1\" dur=\"0.5\"/><wait dur=\"4\"/><title text=\"End\" begin=\"2\" dur=\"1\"/></par>",
    );
    assert_eq!(
        described(&lanes),
        [
            "Shots | wide r0 0-100 | close r0 100-400",
            "anna | Survey r0 0-200 | Look at ben r1 50-150 | Turn to ben r2 100-150 | Run r0 150-250",
            "ben",
            "sword | Attach to anna r0 100-100",
            "sun",
            "rain",
            "Titles | End r0 200-300",
        ]
    );
    assert_eq!(lanes.list[1].rows, 3);
    assert_eq!(lanes.end.seconds(), 4.0);
}

#[test]
fn a_bar_has_its_repetitions_and_the_moments_of_its_take() {
    let lanes = lanes(
        "<play id=\"a\" who=\"anna\" take=\"Survey\" from=\"1\" to=\"2\" repeat=\"2.5\" speed=\"-2\"><at name=\"x\" time=\"1.5\"/></play>\
         <play who=\"anna\" take=\"Walk\" begin=\"a.x\"/>",
    );
    let (_, bar) = lanes.bar_of(1).unwrap();
    let repetitions: Vec<f64> = bar.repetitions(10).map(|time| time.seconds()).collect();
    assert_eq!(repetitions, [0.5, 1.0]);
    // An action that refers to the moment begins there: the library's own rule.
    let (_, after) = lanes.bar_of(2).unwrap();
    assert_eq!((&*bar.marks[0].name, bar.marks[0].time), ("x", after.begin));
}

#[test]
fn a_camera_that_only_is_seen_has_no_lane_of_its_own() {
    let names =
        |actions: &str| lanes(actions).list.iter().map(|lane| lane.name.to_string()).collect::<Vec<_>>();
    assert!(!names("<shot who=\"wide\"/>").contains(&"wide".to_owned()));
    assert!(
        names("<change who=\"wide\" property=\"lens\" to=\"50\" dur=\"1\"/>").contains(&"wide".to_owned())
    );
}
