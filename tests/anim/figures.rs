//! The figures of `anim/README.md` are those that were recorded.

#[path = "../../benches/anim/report/mod.rs"]
pub(crate) mod report;

use dragonfly_kit::figures::{Figure, Results, typed_figure};
use report::PAGE;
use std::fs;

fn page() -> String {
    fs::read_to_string(PAGE.path()).unwrap()
}

#[test]
fn every_table_of_the_readme_is_made_from_the_recorded_results() {
    let page = page();
    let made = PAGE.render(&PAGE.read().unwrap(), &page).unwrap();
    assert!(made == page, "run `cargo bench -p dragonfly-anim -- --report`");
}

#[test]
fn a_figure_that_was_not_measured_disappears_when_the_tables_are_made_again() {
    let page = page();
    let marker = "<!-- table: sampling -->\n";
    let invented = page.replace(marker, &format!("{marker}| invented | 0.01 · 0.02 |\n"));
    assert_ne!(invented, page);
    assert_eq!(PAGE.render(&PAGE.read().unwrap(), &invented).unwrap(), page);
}

#[test]
fn no_measured_figure_is_typed_outside_the_tables() {
    assert_eq!(typed_figure("about 8.4 ns instead"), Some("8.4 ns".to_owned()));
    // The size of raw takes is a definition.
    let page = page().replace("Raw is 40 bytes", "");
    assert_eq!(typed_figure(&page), None);
}

#[test]
fn results_that_were_written_are_read_back_unchanged() {
    let figure = Figure::new("sample/pab/walk/forward", "avx2/compressed", "median", "ns/bone", 1.25);
    let results = Results {
        run: vec![("machine".to_owned(), "a processor, 4 cores: quiet".to_owned())],
        rows: vec![Figure { others: 0.5, ..figure }],
    };
    assert_eq!(Results::parse(&results.text()).unwrap(), results);
    assert_eq!(results.value("sample/pab/walk/forward", "avx2/compressed", "median"), Some(1.25));
    assert!(Results::parse("a,b,c,d,e,f\n").is_err());
}
