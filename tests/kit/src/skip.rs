//! Tests that cannot run here, counted.
//!
//! A test that lacks something calls [`skip`] and returns. `./test` counts the calls and prints them at the end; the
//! gate fails on them, except for the needs in `.ci/may-skip`.

use std::env;
use std::fmt::Display;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a test lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestNeed {
    /// The rights of root: to mount, and to give files away.
    Root,
    /// A Vulkan adapter.
    Adapter,
    /// Programs that judge files: node, with the packages of the glTF validator and three.js; xmllint.
    Evaluators,
    /// A folder with more models than the repository has.
    Models,
    /// Something of the file system or the kernel: loop devices, attributes, immutable files.
    FileSystem,
    /// A program: python3.
    Program,
    /// Programs that run jobs of farms: openjd, Slurm.
    Farm,
    /// A signal that the caller of the tests does not ignore.
    Signal,
}

impl TestNeed {
    /// Returns the word for the need in `.ci/may-skip`.
    fn word(self) -> &'static str {
        match self {
            Self::Root => "root",
            Self::Adapter => "adapter",
            Self::Evaluators => "evaluators",
            Self::Models => "models",
            Self::FileSystem => "file-system",
            Self::Program => "program",
            Self::Farm => "farm",
            Self::Signal => "signal",
        }
    }
}

/// Counts a test, or a part of one, that does not run, with the reason: prints a line, and appends it to the file that
/// `DRAGONFLY_SKIPS` names.
pub fn skip(need: TestNeed, reason: impl Display) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let reason = reason.to_string().replace(['\n', '\t'], " ");
    let line = format!("{}\t{test}\t{reason}\n", need.word());
    print!("not run: {line}");
    let Some(path) = env::var_os("DRAGONFLY_SKIPS") else { return };
    // One write for each line, so that lines of other test programs do not mix with it.
    let written = OpenOptions::new().create(true).append(true).open(&path);
    let written = written.and_then(|mut file| file.write_all(line.as_bytes()));
    written.unwrap_or_else(|error| panic!("{}: {error}", Path::new(&path).display()));
}

/// Returns the folder of the programs that judge files, if they can run: that named by `DRAGONFLY_EVALUATORS`, or
/// `shared/evaluators` next to the repository. Skips otherwise.
pub fn evaluators() -> Option<PathBuf> {
    let named = env::var_os("DRAGONFLY_EVALUATORS").map(PathBuf::from);
    let near = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/evaluators");
    let folder = named.unwrap_or(near);
    if !folder.join("node_modules").is_dir() {
        skip(TestNeed::Evaluators, "DRAGONFLY_EVALUATORS names no folder with the packages of node");
        return None;
    }
    if Command::new("node").arg("--version").output().is_err() {
        skip(TestNeed::Evaluators, "there is no node");
        return None;
    }
    Some(folder)
}

/// Returns the folder of models that are not part of the repository: that named by `DRAGONFLY_MODELS`, or `shared/assets`
/// next to the repository. Skips if there is none.
pub fn models() -> Option<PathBuf> {
    let named = env::var_os("DRAGONFLY_MODELS").map(PathBuf::from);
    let near = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let folder = named.unwrap_or(near);
    if !folder.is_dir() {
        skip(TestNeed::Models, "DRAGONFLY_MODELS names no folder with models");
        return None;
    }
    Some(folder)
}
