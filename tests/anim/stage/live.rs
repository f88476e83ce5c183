//! A script that someone writes: the last plan that worked stays.

use super::actors::{assets, fox, fox_script, seconds};
use dragonfly_anim::stage::LiveStage;
use std::sync::Arc;

#[test]
fn while_the_text_is_broken_the_last_good_plan_plays_on() {
    let assets = assets(&fox());
    let mut stage = LiveStage::default();
    assert!(!stage.update("<script", &assets) && stage.plan().is_none() && stage.errors().len() == 1);
    let good = fox_script("<play who=\"anna\" take=\"Walk\"/>");
    assert!(stage.update(good.as_str(), &assets) && stage.errors().is_empty());
    let plan = Arc::clone(stage.plan().unwrap());
    // Each prefix of a text that is being typed has an error, and the plan stays.
    for end in 1..good.len() {
        if good.is_char_boundary(end) {
            assert!(!stage.update(&good[..end], &assets));
            assert!(!stage.errors().is_empty() && Arc::ptr_eq(stage.plan().unwrap(), &plan));
        }
    }
    assert!(!stage.update(good.replace("Walk", "Wlak"), &assets));
    assert_eq!(
        stage.errors()[0].in_file("duel.xml"),
        "duel.xml:2:24: \"anna\" has no take \"Wlak\"; did you mean \"Walk\"? (takes: Survey, Walk, Run)"
    );
    assert!(stage.update(good.replace("Walk", "Run"), &assets));
    assert!(stage.plan().unwrap().length() > seconds(1.0) && !Arc::ptr_eq(stage.plan().unwrap(), &plan));
    assert_eq!(stage.script().unwrap().tree().text().len(), good.len() - 1);
}
