//! Actions that menus add by their table, and moments of takes on bars.

use super::actors::{assets, fox, fox_script, planned};
use super::gestures::{called, changed, gesture};
use super::read;
use dragonfly_anim::stage::gesture::{add_new_action, wait_after};
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::table::{NEW_ACTIONS, NewActionRow, NewActionTarget, element};
use dragonfly_anim::stage::time::StageTime;

const PLAIN: &str = "<par>\n  <play id=\"a\" who=\"anna\" take=\"Survey\"/>\n</par>";

fn row(title: &str) -> &'static NewActionRow {
    NEW_ACTIONS.iter().find(|row| row.title == title).unwrap()
}

fn seconds(seconds: f64) -> StageTime {
    StageTime::from_seconds(seconds)
}

#[test]
fn every_action_of_the_table_can_be_added_for_each_kind_of_thing_that_does_it() {
    for row in NEW_ACTIONS {
        let kinds = element(row.element).unwrap().who;
        let doers: Vec<Option<&str>> = match kinds.is_empty() {
            true => vec![None],
            false => [
                ("role", "anna"),
                ("prop", "sword"),
                ("camera", "wide"),
                ("light", "sun"),
                ("effect", "rain"),
            ]
            .into_iter()
            .filter(|(kind, _)| kinds.contains(kind))
            .map(|(_, id)| Some(id))
            .collect(),
        };
        for who in doers {
            let target = match (row.target, who) {
                (NewActionTarget::Thing { attribute: "path", .. }, _) => Some("aisle"),
                (NewActionTarget::Thing { .. }, _) => Some("door"),
                (NewActionTarget::Property, Some("wide")) => Some("lens"),
                (NewActionTarget::Property, Some("rain")) => Some("rate"),
                (NewActionTarget::Property, _) => Some("strength"),
                (NewActionTarget::Nothing | NewActionTarget::OwnPlace, _) => None,
            };
            let lines = changed(PLAIN, |scene| add_new_action(scene, row, who, target, seconds(1.0)));
            assert_eq!(lines.len(), 1, "{} of {who:?}: {lines:?}", row.title);
            let name = format!("<{} ", row.element);
            assert!(lines[0].starts_with(&name) && lines[0].contains("begin=\"1\""), "{}", lines[0]);
        }
    }
}

#[test]
fn an_added_action_writes_what_is_there_at_that_time() {
    let line = |title: &str, who: &str, target: Option<&str>| {
        changed(PLAIN, |scene| add_new_action(scene, row(title), Some(who), target, seconds(1.0))).concat()
    };
    assert_eq!(
        line("Set", "sun", Some("strength")),
        r#"<set who="sun" property="strength" to="3" begin="1"/>"#
    );
    assert_eq!(line("Run", "rain", None), r#"<run who="rain" begin="1"/>"#);
    // To look at a figure is to look at its head, and a way to one stops before it.
    let looks = line("Look at", "anna", Some("ben"));
    assert!(looks.contains("at=\"ben.b_Head_05\"") || looks.contains("at=\"ben\""), "{looks}");
    assert!(line("Move to", "anna", Some("ben")).contains("gap=\"0.8\""));
    // Placed where it is, nothing jumps.
    let walking = "<move who=\"anna\" path=\"bend\" take=\"Walk\"/>";
    let (old, new) =
        gesture(walking, |scene| add_new_action(scene, row("Place here"), Some("anna"), None, seconds(1.0)));
    let place = |text: &str| planned(text, &assets(&fox())).placement(0, seconds(1.0)).unwrap();
    let (old, new) = (place(&old), place(&new.unwrap()));
    assert!((old.position - new.position).length() < 2e-3 && (old.facing - new.facing).abs() < 1e-3);
    let refused = |title: &str, who: Option<&str>, target: Option<&str>| {
        gesture(PLAIN, |scene| add_new_action(scene, row(title), who, target, seconds(1.0)))
            .1
            .unwrap_err()
            .to_string()
    };
    assert_eq!(refused("Look at", Some("anna"), Some("anna")), "A thing cannot do that to itself");
    assert_eq!(refused("Set", Some("sun"), Some("rate")), "\"sun\" has no property \"rate\"");
    assert!(refused("Run", Some("anna"), None).contains("\"anna\" is a role"));
}

#[test]
fn a_wait_moves_what_follows_in_a_sequence() {
    let seq = "<seq>\n  <play id=\"a\" who=\"anna\" take=\"Survey\" to=\"1\"/>\n  <play id=\"b\" who=\"anna\" take=\"Run\"/>\n</seq>";
    let (_, new) = gesture(seq, |scene| wait_after(scene, called(scene, "a")));
    let new = new.unwrap();
    let begin =
        planned(&new, &assets(&fox())).schedule().times()[read(&new).action_called("b").unwrap()].begin;
    assert_eq!(begin, seconds(2.0));
    let refusal = gesture(PLAIN, |scene| wait_after(scene, called(scene, "a"))).1.unwrap_err();
    assert_eq!(refusal.to_string(), "Only in a sequence something can wait");
}

#[test]
fn moments_of_a_take_follow_trim_loop_and_speed() {
    let times = |clip: &str, moment: f64| -> Vec<f64> {
        let text = fox_script(&format!("<play id=\"x\" who=\"anna\" take=\"Survey\" begin=\"1\" {clip}/>"));
        let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
        let lanes = SceneLanes::new(&script, &plan);
        let (_, bar) = lanes.bar_of(script.action_called("x").unwrap()).unwrap();
        bar.occurrences(seconds(moment), 100).map(StageTime::seconds).collect()
    };
    assert_eq!(times("", 0.5), [1.5]);
    assert_eq!(times("from=\"0.25\" to=\"2\"", 0.5), [1.25]);
    assert_eq!(times("from=\"0.75\"", 0.5), [0.0; 0], "it is cut off");
    assert_eq!(times("to=\"1\" repeat=\"3\"", 0.5), [1.5, 2.5, 3.5]);
    assert_eq!(times("to=\"1\" repeat=\"2.25\"", 0.5), [1.5, 2.5]);
    assert_eq!(times("speed=\"2\"", 0.5), [1.25]);
    assert_eq!(times("to=\"1\" speed=\"-0.5\" repeat=\"2\"", 0.25), [2.5, 4.5]);
    let text = fox_script(
        "<play id=\"x\" who=\"anna\" take=\"Survey\" from=\"0.5\" to=\"1.5\" speed=\"-1\" repeat=\"2\"/>",
    );
    let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
    let lanes = SceneLanes::new(&script, &plan);
    let (_, bar) = lanes.bar_of(script.action_called("x").unwrap()).unwrap();
    // From 0.5 to 1, which is played from 1 to 0.5.
    let parts: Vec<[f64; 2]> = bar
        .occurrences_of_part([seconds(0.25), seconds(1.0)], 9)
        .map(|part| part.map(StageTime::seconds))
        .collect();
    assert_eq!(parts, [[0.5, 1.0], [1.5, 2.0]]);
}
