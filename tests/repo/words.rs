//! What no file says.

use crate::tree::{File, files, none, one};

/// Places of one machine. Written in two pieces, so that this file does not break its own rule.
const PLACES: &[&str] =
    &[concat!("/wo", "rk/"), concat!("/ro", "ot/"), concat!("/tmp/", "bash"), concat!("/tmp/", "t-")];

fn names_no_machine(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for file in files {
        for place in PLACES.iter().filter(|place| file.text.contains(**place)) {
            complaints.push(format!("{}: names {place}, a folder of one machine", file.path));
        }
    }
    complaints
}

#[test]
fn no_file_names_a_folder_of_one_machine() {
    none(names_no_machine(&files()));
    one(names_no_machine(&[File::planted("README.md", &format!("see {}notes", PLACES[0]))]));
}
