//! Every bad file of the collection is refused with a clear error, or opens with a warning where that is allowed:
//! quickly, with little memory, on a small stack.

use crate::doors::{TestFolder, data};
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::format::{AssetError, AssetFs, ImportError, Place, ReadOptions, read};
use dragonfly_kit::counting::peak;
use std::cell::RefCell;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Limits of time and memory for every file.
const MOST_TIME: Duration = Duration::from_secs(2);
const MOST_MEMORY: u64 = 256 << 20;

/// Access to a folder that records the paths that were read.
struct RecordingFolder(TestFolder, RefCell<Vec<String>>);

impl AssetFs for RecordingFolder {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        self.1.borrow_mut().push(path.to_owned());
        self.0.read(path, limit)
    }
}

/// Reads `path` and returns what is wrong with the result; prints the message that a user would see.
fn faults_of(path: PathBuf, expected: &str) -> Vec<String> {
    let bytes = std::fs::read(&path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap().to_owned();
    let door = RecordingFolder(TestFolder(path.parent().unwrap().to_owned()), RefCell::default());
    let start = Instant::now();
    let (memory, result) = peak(|| read(&name, &bytes, &door, &ReadOptions::default()));
    let elapsed = start.elapsed();
    let mut wrong = Vec::new();
    if elapsed > MOST_TIME || memory > MOST_MEMORY {
        wrong.push(format!("took {elapsed:?} and {memory} bytes"));
    }
    for asked in door.1.borrow().iter() {
        if asked.starts_with('/') || asked.contains("..") || asked.contains(':') || asked.contains('\\') {
            wrong.push(format!("asked for {asked}"));
        }
    }
    match result {
        Ok(imported) => {
            if expected.starts_with("error") {
                wrong.push("was read, expected an error".to_owned());
            }
            let warnings: Vec<String> = imported.warnings.iter().take(3).map(ToString::to_string).collect();
            println!("{name}: read; {}", warnings.join("; "));
            wrong.extend(faults(&imported.model));
            wrong.extend(faults_of_poses(imported.model));
        }
        Err(error) => {
            println!("{name}: {error}");
            wrong.extend(faults_of_error(&error, expected));
        }
    }
    wrong
}

fn faults_of_error(error: &ImportError, expected: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    if expected == "load" {
        wrong.push(format!("expected a model: {error}"));
    }
    if expected == "error-unsupported" && !matches!(error, ImportError::Unsupported { .. }) {
        wrong.push(format!("expected the missing feature: {error}"));
    }
    if error.to_string().contains('\n') || *error.place() == Place::File {
        wrong.push(format!("no clear place: {error}"));
    }
    wrong
}

/// Reads the files of a folder with an index, and returns what is wrong, with the number of files.
fn failures(folder: &std::path::Path, is_read: impl Fn(&str) -> bool) -> (usize, Vec<String>) {
    let index = std::fs::read_to_string(folder.join("INDEX.tsv")).unwrap();
    let (mut files, mut failures) = (0, Vec::new());
    for row in index.lines().skip(1) {
        let mut columns = row.split('\t');
        let (file, _, expected) = (columns.next().unwrap(), columns.next().unwrap(), columns.next().unwrap());
        if !is_read(file) {
            continue;
        }
        files += 1;
        let (path, expected) = (folder.join(file), expected.to_owned());
        // A small stack, which a recursion as deep as a file specifies would overflow.
        let thread =
            std::thread::Builder::new().stack_size(256 << 10).spawn(move || faults_of(path, &expected));
        match thread.unwrap().join() {
            Ok(wrong) => failures.extend(wrong.into_iter().map(|wrong| format!("{file}: {wrong}"))),
            Err(_) => failures.push(format!("{file}: panicked")),
        }
    }
    (files, failures)
}

#[test]
fn every_bad_file_has_the_result_that_the_index_expects() {
    let (files, failures) = failures(&data().join("bad"), |_| true);
    println!("{files} files");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(files >= 150);
}

#[test]
fn every_bad_text_of_the_collection_of_models_has_the_result_that_its_index_expects() {
    let Some(models) = dragonfly_kit::skip::models() else { return };
    let is_read = |file: &str| file.starts_with("m3d/") || file.starts_with("x/");
    let (files, failures) = failures(&models.join("../bad"), is_read);
    println!("{files} files");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(files >= 27);
}
