//! `cargo run --release -p dragonfly-study --bin report`: makes the tables and charts of the study from its raw data.
//!
//! With a folder of raw data as its argument, for example of a short run, it writes into `report` in that folder and does
//! not change the study.

use dragonfly_study::report;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let study = report::folder();
    let (results, folder) = match std::env::args_os().nth(1) {
        Some(results) => (PathBuf::from(&results), PathBuf::from(&results).join("report")),
        None => (study.join("results"), study),
    };
    match report::update(&results, &folder) {
        Ok(changed) => {
            for path in &changed {
                println!("{}", path.display());
            }
            println!("{} files changed", changed.len());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
