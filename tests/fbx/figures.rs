//! The tables of `anim/FORMATS.md` are those that were recorded.

#[path = "../../benches/formats/report/mod.rs"]
mod report;

use report::PAGE;
use std::fs;

#[test]
fn every_table_of_the_page_of_formats_is_made_from_the_recorded_results() {
    let page = fs::read_to_string(PAGE.path()).expect("the page");
    let made = PAGE.render(&PAGE.read().expect("the results"), &page).expect("all tables");
    assert!(made == page, "run `cargo bench -p dragonfly-fbx --bench formats -- --report`");
}

#[test]
fn every_file_of_results_of_formats_names_its_machine_commit_and_command() {
    PAGE.read().expect("the results").assert_origins();
}
