//! The examples do what they say, and each fits on a page.

#[path = "../../anim/examples/attach.rs"]
mod attach;
#[path = "../../anim/examples/blend_two.rs"]
mod blend_two;
#[path = "../../anim/examples/check_a_model.rs"]
mod check_a_model;
#[path = "../../anim/examples/own_interpolation.rs"]
mod own_interpolation;
#[path = "../../anim/examples/play_a_take.rs"]
mod play_a_take;
#[path = "../../anim/examples/reach_with_ik.rs"]
mod reach_with_ik;
#[path = "../../anim/examples/root_motion.rs"]
mod root_motion;
#[path = "../../anim/examples/same_animation_other_model.rs"]
mod same_animation_other_model;
#[path = "../../anim/examples/save_and_load.rs"]
mod save_and_load;

#[test]
fn a_take_is_played() {
    play_a_take::main().unwrap();
}

#[test]
fn two_takes_are_blended() {
    blend_two::main().unwrap();
}

#[test]
fn a_staff_is_attached() {
    attach::main().unwrap();
}

#[test]
fn an_interpolation_of_ones_own_is_used() {
    own_interpolation::main();
}

#[test]
fn a_model_is_saved_and_loaded() {
    save_and_load::main().unwrap();
}

#[test]
fn a_model_is_checked() {
    check_a_model::main().unwrap();
}

#[test]
fn limbs_reach() {
    reach_with_ik::main();
}

#[test]
fn a_walk_is_parted_from_its_way() {
    root_motion::main();
}

#[test]
fn another_model_moves_alike() {
    same_animation_other_model::main();
}

#[test]
fn every_example_is_shorter_than_sixty_lines() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut examples = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let lines = std::fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines < 60, "{}: {lines} lines", path.display());
        examples += 1;
    }
    assert!(examples >= 4);
}
