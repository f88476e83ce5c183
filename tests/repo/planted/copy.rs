//! A copy of the project in which things are planted, and the commands that run there.

use super::list::{FORGOTTEN, PLANTS, Plant, TESTS};
use crate::tree::{files, root};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The files of a copy by their paths.
type Files = BTreeMap<String, Vec<u8>>;

/// Inserts `text` into a file after the first occurrence of `anchor`; at the end, or as a new file, where that is empty.
fn insert(files: &mut Files, path: &str, anchor: &str, text: &str) {
    let bytes = files.entry(path.to_owned()).or_default();
    let mut content = String::from_utf8(std::mem::take(bytes)).expect("text");
    let found = if anchor.is_empty() { Some(content.len()) } else { content.find(anchor) };
    let at = found.unwrap_or_else(|| panic!("{path} does not contain {anchor}"));
    let end = if anchor.is_empty() { at } else { at + anchor.len() };
    content.insert_str(end, text);
    *bytes = content.into_bytes();
}

/// Declares the module of a new file in `list`, before the modules that are declared there.
fn declare(files: &mut Files, list: &str, module: &str) {
    let text = String::from_utf8(files[list].clone()).expect("text");
    let first = text.lines().find(|line| line.starts_with("mod ") || line.starts_with("pub mod "));
    let first = first.unwrap_or_else(|| panic!("{list} declares no module"));
    let line = format!("{module}\n{first}");
    files.insert(list.to_owned(), text.replacen(first, &line, 1).into_bytes());
}

fn plant(files: &mut Files, plant: &Plant) {
    if let Some((path, content)) = plant.file {
        files.insert(path.to_owned(), content.as_bytes().to_vec());
        // Another crate sets the data of a pass or an overlay, so its module is public.
        let public = content.contains("impl Appearance for ");
        declare(files, plant.list, if public { "pub mod planted;" } else { "mod planted;" });
    }
    insert(files, plant.list, &format!("{}\n", plant.place[1]), &format!("{}\n", plant.entry));
    for (path, anchor, text) in plant.also {
        insert(files, path, anchor, text);
    }
}

/// A copy of the project inside the folder of its target.
pub(crate) struct ProjectCopy {
    folder: PathBuf,
    target: PathBuf,
}

impl ProjectCopy {
    /// Makes the copy with all plants, or updates the one of an earlier run: files that did not change keep their time.
    pub(crate) fn planted() -> Self {
        let program = std::env::current_exe().expect("a running test has an executable");
        let target = program.ancestors().nth(3).expect("tests are built into target/PROFILE/deps").to_owned();
        let folder = target.join("planted/copy");
        let mut copied = Files::new();
        for file in files() {
            copied.insert(file.path.clone(), fs::read(root().join(&file.path)).expect("a file"));
        }
        PLANTS.iter().for_each(|one| plant(&mut copied, one));
        for (path, content, list) in TESTS {
            copied.insert((*path).to_owned(), content.as_bytes().to_vec());
            declare(&mut copied, list, "mod planted;");
        }
        let panel = PLANTS.iter().find_map(|plant| plant.file.filter(|_| plant.thing == "panel"));
        let (_, panel) = panel.expect("a panel is planted");
        let forgotten = panel.replace("Planted", "Forgotten").replace("planted", "forgotten");
        copied.insert(FORGOTTEN.0.to_owned(), forgotten.into_bytes());
        declare(&mut copied, FORGOTTEN.1, "mod forgotten;");
        remove_others(&folder, &folder, &copied);
        for (path, content) in &copied {
            let path = folder.join(path);
            if fs::read(&path).ok().as_ref() != Some(content) {
                fs::create_dir_all(path.parent().expect("inside the copy")).expect("a folder");
                fs::write(&path, content).expect("a file of the copy");
            }
        }
        Self { folder, target }
    }

    /// Runs tests in the copy. The builds of external packages are shared with the project; those of its own programs
    /// are not.
    pub(crate) fn test(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO"))
            .args(["test", "--workspace", "--offline", "--locked"])
            .args(arguments)
            .current_dir(&self.folder)
            .env("CARGO_BUILD_BUILD_DIR", &self.target)
            .env("CARGO_TARGET_DIR", self.target.join("planted/out"))
            .env("CARGO_INCREMENTAL", "0")
            .env("CARGO_PROFILE_DEV_OPT_LEVEL", "0")
            .env("CARGO_PROFILE_DEV_DEBUG", "0")
            .env("CARGO_TERM_COLOR", "never")
            .output()
            .expect("cargo")
    }
}

fn remove_others(root: &Path, folder: &Path, kept: &Files) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            remove_others(root, &path, kept);
        } else if let Ok(inside) = path.strip_prefix(root)
            && !kept.contains_key(&inside.to_string_lossy().replace('\\', "/"))
        {
            fs::remove_file(&path).expect("a file of the copy");
        }
    }
}
