//! The page contains the results of the raw data, and no others.

use dragonfly_study::report::{self, Data};
use std::fs;

#[test]
fn every_table_and_chart_is_made_from_the_raw_data() {
    let study = report::folder();
    let readme = fs::read_to_string(study.join("README.md")).expect("the page");
    let data = Data::read(&study.join("results")).expect("the raw data");
    let files = report::render(&data, &readme).expect("the report");
    for (path, text) in &files {
        let kept = fs::read_to_string(study.join(path)).unwrap_or_default();
        assert!(kept == *text, "{} does not match the raw data: run the report", path.display());
    }
    // No file of an older run is left.
    for entry in fs::read_dir(study.join("results")).into_iter().flatten() {
        let name = entry.expect("a file").file_name();
        let name = name.to_str().expect("a plain name");
        let made = files.iter().any(|(path, _)| path.ends_with(name));
        assert!(made || name.ends_with(".csv"), "results/{name} belongs to no raw data");
    }
}

#[test]
fn a_number_that_was_not_measured_is_removed_from_the_page() {
    let study = report::folder();
    let readme = fs::read_to_string(study.join("README.md")).expect("the page");
    let data = Data::read(&study.join("results")).expect("the raw data");
    let files = report::render(&data, &readme).expect("the report");
    let marker = "<!-- table: design-cost -->\n";
    let invented = readme.replace(marker, &format!("{marker}| invented | 9.99 µs |\n"));
    assert_ne!(invented, readme);
    let page = files.iter().find(|(path, _)| path.ends_with("README.md")).expect("the page is made");
    assert_ne!(page.1, invented);
    let again = report::render(&data, &invented).expect("the report");
    assert!(again.contains(page), "the text between the markers is not replaced");
}

#[test]
fn every_link_of_the_page_has_a_target() {
    let study = report::folder();
    let readme = fs::read_to_string(study.join("README.md")).expect("the page");
    let targets = readme.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    for target in targets.filter(|target| !target.contains("://") && !target.starts_with('#')) {
        assert!(study.join(target).exists(), "{target} does not exist");
    }
}
