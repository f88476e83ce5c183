//! The examples about storing and checking do what they say.

#[path = "../../anim/examples/check_a_model.rs"]
mod check_a_model;
#[path = "../../anim/examples/save_and_load.rs"]
mod save_and_load;

#[test]
fn a_model_is_saved_and_loaded() {
    save_and_load::main().unwrap();
}

#[test]
fn a_model_is_checked() {
    check_a_model::main().unwrap();
}
