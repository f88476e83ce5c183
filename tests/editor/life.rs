//! The order of the steps in which the program starts and ends.

use dragonfly::app::timeline::{Step, StepTrace};

#[test]
fn starting_and_ending_the_program_have_eleven_numbered_steps() {
    let numbers: Vec<usize> = Step::ALL.iter().map(|step| step.number()).collect();
    assert_eq!(numbers, (1..=11).collect::<Vec<_>>());
}

#[test]
fn after_a_failed_start_steps_in_between_may_be_skipped() {
    let mut timeline = StepTrace::default();
    timeline.reach(Step::MainFunction);
    timeline.reach(Step::MainRuntime);
    timeline.reach(Step::MainRuntimeDestruction);
    assert_eq!(timeline.reached().len(), 3);
}

#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "GraphicsDestruction")]
fn the_window_is_not_dropped_before_the_device() {
    let mut timeline = StepTrace::default();
    timeline.reach(Step::GraphicsDestruction);
    timeline.reach(Step::EditorRuntimeDestruction);
}
