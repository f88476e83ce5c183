//! The examples have the documented results, and each fits on a page.

#[path = "../../anim/examples/attach.rs"]
mod attach;
#[path = "../../anim/examples/blend_two.rs"]
mod blend_two;
#[path = "../../anim/examples/check_a_model.rs"]
mod check_a_model;
#[allow(dead_code, reason = "its main reads the command line, which is that of the test here")]
#[path = "../../anim/examples/compress.rs"]
mod compress;
#[allow(dead_code, reason = "its main reads the command line, which is that of the test here")]
#[path = "../../anim/examples/explain_a_bone.rs"]
mod explain_a_bone;
#[path = "../../anim/examples/own_interpolation.rs"]
mod own_interpolation;
#[path = "../../anim/examples/play_a_take.rs"]
mod play_a_take;
#[path = "../../anim/examples/reach_with_ik.rs"]
mod reach_with_ik;
#[allow(dead_code, reason = "its main reads the command line, which is that of the test here")]
#[path = "../../anim/examples/reduce_keys.rs"]
mod reduce_keys;
#[path = "../../anim/examples/root_motion.rs"]
mod root_motion;
#[path = "../../anim/examples/same_animation_other_model.rs"]
mod same_animation_other_model;
#[path = "../../anim/examples/save_and_load.rs"]
mod save_and_load;
#[path = "../../anim/examples/stage.rs"]
mod stage;

#[test]
fn a_take_is_played() {
    play_a_take::main().unwrap();
}

#[test]
fn two_takes_are_blended() {
    blend_two::main().unwrap();
}

#[test]
fn a_staff_is_attached_to_a_bone() {
    attach::main().unwrap();
}

#[test]
fn a_custom_interpolation_is_used() {
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
fn limbs_and_chains_reach_their_targets() {
    reach_with_ik::main();
}

#[test]
fn the_root_motion_of_a_walk_is_extracted() {
    root_motion::main();
}

#[test]
fn a_take_is_retargeted_to_another_model() {
    same_animation_other_model::main();
}

#[test]
fn a_script_is_staged() {
    stage::main();
}

#[test]
fn a_bone_is_explained() {
    explain_a_bone::show(explain_a_bone::FOX, "b_Head_05", 0.35).unwrap();
    assert!(explain_a_bone::show(explain_a_bone::FOX, "nobody", 0.35).is_err());
}

#[test]
fn takes_are_compressed() {
    compress::show(compress::FOX).unwrap();
}

#[test]
fn keys_are_reduced() {
    reduce_keys::show(reduce_keys::FOX, 10.0).unwrap();
}

#[test]
fn every_example_is_short_and_run_by_a_test() {
    let crate_root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |folder: &str| {
        let entries = std::fs::read_dir(crate_root.join(folder)).unwrap();
        entries
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|end| end == "rs"))
    };
    let tests: String = read("../tests/anim").map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let mut examples = 0;
    for path in read("examples") {
        let lines = std::fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines < 60, "{}: {lines} lines", path.display());
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(tests.contains(&format!("anim/examples/{name}\"]")), "no test runs {name}");
        examples += 1;
    }
    assert!(examples >= 10, "{examples}");
}
