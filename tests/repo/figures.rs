//! The figures of `benches/editor/README.md` are those that were recorded.

#[path = "../../benches/editor/report/mod.rs"]
mod report;

use dragonfly_kit::figures::typed_figure;
use report::PAGE;
use std::fs;

fn page() -> String {
    fs::read_to_string(PAGE.path()).expect("the page")
}

#[test]
fn every_table_of_the_benches_of_the_editor_is_made_from_the_recorded_results() {
    let page = page();
    let made = PAGE.render(&PAGE.read().expect("the results"), &page).expect("all tables");
    assert!(made == page, "run `cargo bench -p dragonfly --bench drag -- --report`");
}

#[test]
fn a_figure_that_was_not_measured_disappears_when_the_tables_are_made_again() {
    let page = page();
    let marker = "<!-- table: drag -->\n";
    let invented = page.replace(marker, &format!("{marker}| invented | 0.01 ms | 0.02 ms |\n"));
    assert_ne!(invented, page);
    assert_eq!(PAGE.render(&PAGE.read().expect("the results"), &invented).expect("all tables"), page);
}

#[test]
fn no_measured_figure_of_the_editor_is_typed_outside_the_tables() {
    assert_eq!(typed_figure(&format!("{} at most 6.1 ms.", page())), Some("6.1 ms.".to_owned()));
    assert_eq!(typed_figure(&page()), None);
}

#[test]
fn every_file_of_results_names_its_machine_commit_and_command() {
    PAGE.read().expect("the results").assert_origins();
}

#[test]
fn every_file_in_the_folder_of_results_is_used_by_the_page() {
    for entry in fs::read_dir(PAGE.folder()).expect("the folder") {
        let name = entry.expect("an entry").file_name().into_string().expect("a plain name");
        let is_used = PAGE.names().iter().any(|file| format!("{file}.csv") == name);
        assert!(is_used, "{name}: no table is made of it");
    }
}
