//! A take is checked for defects in a job, and the reply has the defects.

use dragonfly_anim::lint::{LintRule, LintThresholds, lint_take};
use dragonfly_document::{DocumentMessage, DocumentReply, TakeCheck, TakeThresholds};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::Folder;
use std::sync::Arc;

#[test]
fn a_checked_take_has_the_defects_that_the_command_line_reports() {
    let folder = Folder::new("take-check");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let view = document.open(&fox(&folder));
    let (take, skeleton) = (Arc::clone(&view.takes[2]), Arc::clone(&view.loaded.model.animation.skeleton));
    let mut limits = LintThresholds::default();
    limits.contacts.meters_per_unit = 0.01;
    let wanted = lint_take(&take, &skeleton, 24.0, &limits).expect("a table");
    assert!(!wanted.is_empty());
    document.send(DocumentMessage::CheckTake(TakeCheck {
        take: Arc::clone(&take),
        skeleton: Arc::clone(&skeleton),
        rate: 24.0,
        meters_per_unit: 0.01,
    }));
    let checked = document.wait_for_reply(|reply| match reply {
        DocumentReply::Checked(checked) => Some(checked.clone()),
        _ => None,
    });
    assert!(Arc::ptr_eq(&checked.take, &take) && checked.findings == wanted);
    // The thresholds next to the file: everything off but the limit of a joint that may not turn.
    let off = LintRule::ALL.map(|rule| format!("\"{}\":null", rule.name()));
    let joints = r#""joints":{"b_Neck_04":{"ball":{"axis":"x","swing":0,"twist":[0,0]}}}"#;
    let rules = format!("{{{},\"joint_limit\":1,{joints}}}", off.join(","));
    std::fs::write(folder.join("Fox.check.json"), rules).expect("written");
    document.send(DocumentMessage::CheckTake(TakeCheck {
        take: Arc::clone(&take),
        skeleton: Arc::clone(&skeleton),
        rate: 24.0,
        meters_per_unit: 0.01,
    }));
    let joint = document.wait_for_reply(|reply| match reply {
        DocumentReply::Checked(checked) => Some(checked.findings.clone()),
        _ => None,
    });
    let found: Vec<(LintRule, &str)> =
        joint.iter().map(|finding| (finding.rule, &*skeleton.bones[finding.bone as usize].name)).collect();
    assert_eq!(found, [(LintRule::JointLimit, "b_Neck_04")]);
    document.send(DocumentMessage::CheckTake(TakeCheck { take, skeleton, rate: 0.0, meters_per_unit: 0.01 }));
    let refused = document.wait_for_reply(|reply| match reply {
        DocumentReply::Refused(reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(refused.contains("not a frame rate"), "{refused}");
}

/// A check of the first take of the fox.
fn fox_check(document: &mut TestDocument, folder: &Folder) -> TakeCheck {
    let view = document.open(&fox(folder));
    let (take, skeleton) = (Arc::clone(&view.takes[0]), Arc::clone(&view.loaded.model.animation.skeleton));
    TakeCheck { take, skeleton, rate: 24.0, meters_per_unit: 0.01 }
}

#[test]
fn a_joint_of_a_bone_that_the_model_does_not_have_is_reported_once_and_the_rest_is_checked() {
    let folder = Folder::new("take-check-unknown");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let check = fox_check(&mut document, &folder);
    let joint = r#"{"ball":{"axis":"x","swing":0,"twist":[0,0]}}"#;
    let rules = format!(r#"{{"joint_limit":1,"joints":{{"Nose":{joint},"b_Neck_04":{joint}}}}}"#);
    std::fs::write(folder.join("Fox.check.json"), rules).expect("written");
    for _ in 0..2 {
        document.send(DocumentMessage::CheckTake(check.clone()));
        let found = document.wait_for_reply(|reply| match reply {
            DocumentReply::Checked(checked) => Some(checked.findings.clone()),
            DocumentReply::Refused(reason) => panic!("{reason}"),
            _ => None,
        });
        assert!(found.iter().any(|finding| finding.rule == LintRule::JointLimit), "{found:?}");
    }
    let warnings = document.unread_replies();
    let count = warnings.iter().filter(|text| text.contains("Nose")).count();
    assert_eq!(count, 1, "{warnings:?}");
    assert!(
        warnings.iter().any(|text| text.contains("Warning") && text.contains("Fox.check.json")),
        "{warnings:?}"
    );
}

#[test]
fn limits_of_joints_that_no_joint_can_have_are_refused_with_the_name_of_the_joint() {
    let folder = Folder::new("take-check-limits");
    let path = folder.join("limits.json");
    let read = |joint: &str| {
        std::fs::write(&path, format!(r#"{{"joints":{{"Shin":{joint}}}}}"#)).expect("written");
        TakeThresholds::read(&path)
    };
    for (joint, wanted) in [
        (r#"{"hinge":{"axis":"x","range":[150,0]}}"#, "the range [150, 0] ends before it begins"),
        (r#"{"euler":{"y":[10,-10]}}"#, "the range [10, -10] ends before it begins"),
        (r#"{"ball":{"axis":"x","swing":10,"twist":[1,0]}}"#, "the range [1, 0] ends before it begins"),
        (r#"{"ball":{"axis":"x","swing":-5}}"#, "the swing -5 is below 0"),
        (r#"{"ball":{"axis":"x","swing":[60,-5]}}"#, "the swing -5 is below 0"),
        (r#"{"hinge":{"axis":"x","range":[0,1e40]}}"#, "a number is too large"),
        (r#"{"ball":{"axis":"x","swing":1e40}}"#, "a number is too large"),
        (r#"{"ball":{"axis":"x","swing":10,"twist":[-1e40,0]}}"#, "a number is too large"),
        (r#"{"euler":{"z":[-1e40,1e40]}}"#, "a number is too large"),
        (r#"{"hinge":{"axis":[0,0,0],"range":[0,1]}}"#, "an axis has no direction"),
        (r#"{"hinge":{"axis":[1e40,0,0],"range":[0,1]}}"#, "an axis has no direction"),
    ] {
        let reason = read(joint).expect_err(joint);
        assert!(reason.contains(&format!("the joint of \"Shin\": {wanted}")), "{joint}: {reason}");
    }
    for joint in [r#"{"hinge":{"axis":"x","range":[75,75]}}"#, r#"{"ball":{"axis":"x","swing":[0,180]}}"#] {
        assert!(read(joint).is_ok(), "{joint}");
    }
}
