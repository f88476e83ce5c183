//! Problems of the take as marks on the timeline: each state of a take is checked once, and a mark has a fix in its menu.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, FileAction, Request};
use dragonfly_document::edit::{Edit, ReduceKeys};
use dragonfly_document::{Change, DocumentMessage, TakeCheck};
use egui::PointerButton;
use egui_kittest::kittest::Queryable;

/// Returns the check that the panels ask for.
fn wanted(animator: &mut Animator) -> Option<TakeCheck> {
    match animator.harness.state_mut().state.wanted_check()? {
        Effect::File(FileAction::Send(DocumentMessage::CheckTake(check))) => Some(check),
        other => panic!("{other:?}"),
    }
}

/// Checks the take as the document does.
fn check(animator: &mut Animator) {
    let checked = wanted(animator).expect("a check").run(None).expect("findings");
    animator.harness.state_mut().state.checked(checked);
    animator.steps(3);
}

fn edit(animator: &mut Animator, line: &str) {
    let edit: Edit = serde_json::from_str(line).expect(line);
    animator.request(Request::Change(Change::Edit(edit, None)));
}

#[test]
fn each_state_of_the_take_is_checked_once_while_problems_are_marked() {
    let mut animator = Animator::with_bone(3);
    assert_eq!(wanted(&mut animator), None, "problems are not marked");
    animator.request(Request::Command(Id::ToggleProblems));
    assert!(wanted(&mut animator).is_some());
    assert_eq!(wanted(&mut animator), None, "only once");
    animator.request(Request::Command(Id::ReverseTake));
    assert!(wanted(&mut animator).is_some(), "the take is another one");
    animator.request(Request::Command(Id::ToggleProblems));
    animator.request(Request::Command(Id::ReverseTake));
    assert_eq!(wanted(&mut animator), None);
}

#[test]
fn a_mark_leads_to_the_problem_and_its_menu_fixes_it() {
    let mut animator = Animator::with_bone(3);
    // A key on each frame that its neighbors predict.
    edit(
        &mut animator,
        r#"{"edit":"resample_keys","take":0,"keys":[{"bones":[5],"properties":["rotation"]}],"rate":60}"#,
    );
    animator.request(Request::Command(Id::ToggleProblems));
    check(&mut animator);
    let findings = animator.harness.state().state.read().take_findings().to_vec();
    assert!(findings.iter().any(|finding| finding.bone == 5), "{findings:?}");
    let label = "Keys without need: ";
    let marks = animator.harness.query_all_by_label_contains(label).count();
    assert!(marks > 0, "{findings:?}");
    let at = animator.harness.query_all_by_label_contains(label).next_back().expect("a mark").rect().center();
    animator.click(at);
    let bone = animator.harness.state().state.read().selected().expect("a bone");
    animator.button(at, PointerButton::Secondary, true);
    animator.button(at, PointerButton::Secondary, false);
    animator.steps(2);
    animator.harness.get_by_label_contains("Reduce keys of").click();
    animator.steps(3);
    let Some(Edit::ReduceKeys(ReduceKeys { keys, .. })) = animator.edits().last().copied() else {
        panic!("no edit: {:?}", animator.edits().last())
    };
    assert_eq!(keys[0].bones, [dragonfly_document::edit::BoneRef::Index(bone)]);
    assert!(animator.harness.state().state.read().take_findings().is_empty(), "until it is checked again");
    check(&mut animator);
    let left = animator.harness.state().state.read().take_findings().len();
    assert!(left < findings.len(), "{left} of {}", findings.len());
}

#[test]
fn a_mark_without_a_fix_does_not_promise_one() {
    let mut animator = Animator::with_bone(3);
    // A bone that is half a meter away in one frame: no edit knows where it belongs.
    edit(
        &mut animator,
        r#"{"edit":"set","take":0,"time":1.0,"poses":[{"bone":5,"translation":[0.5,0.5,0.5]}]}"#,
    );
    animator.request(Request::Command(Id::ToggleProblems));
    check(&mut animator);
    let hint_of = |animator: &mut Animator, label: &str| {
        let mark = animator.harness.query_all_by_label_contains(label).next();
        let at = mark.unwrap_or_else(|| panic!("no {label}")).rect().center();
        animator.move_to(at);
        animator.steps(90);
        let fix = animator.harness.query_all_by_label_contains("right-click to fix it").count();
        (animator.harness.query_all_by_label_contains("Click to go there").count(), fix)
    };
    assert_eq!(hint_of(&mut animator, "Stretched bone: "), (1, 0));
}
