//! Compacting adds no error to a file: to the models of the repository, and to those of another folder if there is one.
//!
//! Errors are counted by the rules of `check`, and by the Khronos validator if it is installed.

use crate::doors::{TestFolder, gltf_files, model_files};
use crate::save_judges::{edited_twice, issues};
use crate::save_support::{OpenedFile, Over, same_scene, same_takes};
use dragonfly_anim::check::{Severity, check};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::gltf::save::compact;
use dragonfly_anim::format::{AssetError, AssetFs, NoFiles, OutputFile};
use dragonfly_kit::skip;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Access to a folder, with a record of the files that were read.
struct RecordedFolder {
    folder: TestFolder,
    files: RefCell<BTreeMap<String, Vec<u8>>>,
}

impl AssetFs for RecordedFolder {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        let bytes = self.folder.read(path, limit)?;
        self.files.borrow_mut().insert(path.to_owned(), bytes.clone());
        Ok(bytes)
    }
}

/// A file that was edited and saved twice: then, and after it was compacted.
struct Compacted {
    path: PathBuf,
    /// The file and those that it refers to.
    files: [Vec<OutputFile>; 2],
    errors: [BTreeMap<&'static str, usize>; 2],
}

/// Returns the number of errors of each rule.
fn errors(model: &ModelData) -> BTreeMap<&'static str, usize> {
    let mut counts = BTreeMap::new();
    for finding in check(model).iter().filter(|finding| finding.severity == Severity::Error) {
        *counts.entry(finding.rule).or_default() += 1;
    }
    counts
}

/// Edits, saves and compacts a file; `None` for one that cannot be read.
fn compacted(path: &Path) -> Option<Compacted> {
    let bytes = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    let folder = TestFolder(path.parent().unwrap().to_owned());
    let door = RecordedFolder { folder, files: RefCell::default() };
    let opened = OpenedFile::new(name, &bytes, &door).ok()?;
    // A file without appended data is not changed at all.
    let untouched = compact(&opened.source).unwrap();
    assert!(untouched.changes().is_empty(), "{}: {}", path.display(), untouched.changes());

    let [saved, twice] = edited_twice(&opened, &door);
    let mut before = files_of(door.files.take());
    before.push(OutputFile { name: name.to_owned(), bytes });
    let before = replaced(replaced(before, saved.files), twice.files);
    let after = replaced(before.clone(), compact(&twice.opened.source).unwrap().write());
    let main = &after.iter().find(|file| file.name == name).unwrap().bytes;
    let reopened = OpenedFile::new(name, main, &Over::new(&after, &NoFiles)).unwrap();
    same_scene(&twice.opened.model, &reopened.model);
    same_takes(&twice.opened.model, &twice.opened.takes(), &reopened.model);
    let errors = [errors(&twice.opened.model), errors(&reopened.model)];
    Some(Compacted { path: path.to_owned(), files: [before, after], errors })
}

fn files_of(files: BTreeMap<String, Vec<u8>>) -> Vec<OutputFile> {
    files.into_iter().map(|(name, bytes)| OutputFile { name, bytes }).collect()
}

/// Returns `files` with `later` in place of those with the same names.
fn replaced(mut files: Vec<OutputFile>, later: Vec<OutputFile>) -> Vec<OutputFile> {
    files.retain(|file| later.iter().all(|later| later.name != file.name));
    files.extend(later);
    files
}

/// Writes the files of a model before and after, each in a folder of its own, and returns the paths of the models.
fn written(model: &Compacted, folder: &Path) -> [PathBuf; 2] {
    let name = model.path.file_name().unwrap();
    let both = [folder.join("before"), folder.join("after")];
    for (folder, files) in both.iter().zip(&model.files) {
        for file in files {
            let path = folder.join(&file.name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, &file.bytes).unwrap();
        }
    }
    both.map(|folder| folder.join(name))
}

/// Returns the entries of which there are more after than before.
fn more<K: Ord + std::fmt::Debug>(before: &BTreeMap<K, usize>, after: &BTreeMap<K, usize>) -> Vec<String> {
    let is_more = |(key, count): &(&K, &usize)| *count > before.get(*key).unwrap_or(&0);
    after.iter().filter(is_more).map(|(key, count)| format!("{key:?}: {count}")).collect()
}

/// Checks that compacting adds no error to any of the files.
fn no_more_errors(paths: &[PathBuf], least: usize, folder: &str) {
    let mut refused = Vec::new();
    let mut models = Vec::new();
    for path in paths {
        match compacted(path) {
            Some(model) => models.push(model),
            None => refused.push(path.display().to_string()),
        }
    }
    println!("{} files compacted; not readable: {refused:?}", models.len());
    assert!(models.len() >= least, "only {} files; not readable: {refused:?}", models.len());
    let mut complaints = Vec::new();
    let mut complain = |model: &Compacted, more: Vec<String>| {
        complaints.extend(more.into_iter().map(|more| format!("{}: {more}", model.path.display())));
    };
    for model in &models {
        complain(model, more(&model.errors[0], &model.errors[1]));
    }
    if let Some(evaluators) = skip::evaluators() {
        let folder = std::env::temp_dir().join(format!("dragonfly-{folder}-{}", std::process::id()));
        let write = |(number, model)| written(model, &folder.join(usize::to_string(&number)));
        let files: Vec<PathBuf> = models.iter().enumerate().flat_map(write).collect();
        let counts = issues(&evaluators, &files);
        std::fs::remove_dir_all(&folder).unwrap();
        for (model, counts) in models.iter().zip(counts.chunks(2)) {
            complain(model, more(&counts[0], &counts[1]));
        }
    }
    assert!(complaints.is_empty(), "{complaints:#?}");
}

#[test]
fn compacting_a_model_of_the_repository_adds_no_error() {
    no_more_errors(&model_files(), 20, "compact-own");
}

#[test]
fn compacting_any_other_model_adds_no_error() {
    let Some(folder) = skip::models() else { return };
    no_more_errors(&gltf_files(vec![folder]), 1, "compact-others");
}
