//! The examples do what they show; each checks its own results.

#[path = "../../anim/examples/reach_with_ik.rs"]
mod reach_with_ik;
#[path = "../../anim/examples/root_motion.rs"]
mod root_motion;
#[path = "../../anim/examples/same_animation_other_model.rs"]
mod same_animation_other_model;

#[test]
fn every_example_runs() {
    reach_with_ik::main();
    root_motion::main();
    same_animation_other_model::main();
}

#[test]
fn every_example_is_short_enough_to_read() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let lines = std::fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines < 60, "{}: {lines} lines", path.display());
    }
}
