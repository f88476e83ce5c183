//! A take is checked for defects in a job, and the reply has the defects.

use dragonfly_anim::lint::{LintRule, LintThresholds, lint_take};
use dragonfly_document::{DocumentMessage, DocumentReply, TakeCheck};
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
