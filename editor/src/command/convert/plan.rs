//! The files that a conversion reads, and those that it writes.

use super::super::Failure;
use dragonfly_document::{ConversionOrder, formats};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Largest depth of folders below an input.
const DEPTH: usize = 64;

/// A file to read, and the file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PlannedFile {
    pub(super) input: PathBuf,
    pub(super) output: PathBuf,
    /// Whether the output is in a folder that is created where it is missing.
    pub(super) is_in_folder: bool,
}

impl PlannedFile {
    /// Returns whether the output exists and is not older than the input. Outputs are written completely or not at all.
    pub(super) fn is_up_to_date(&self) -> bool {
        let changed = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
        matches!((changed(&self.input), changed(&self.output)), (Some(input), Some(output)) if output >= input)
    }

    /// Returns the order of this file with the choices of another one.
    pub(super) fn order(&self, choices: &ConversionOrder) -> ConversionOrder {
        ConversionOrder { input: self.input.clone(), output: self.output.clone(), ..choices.clone() }
    }
}

/// One of several equal parts of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shard {
    /// From 0.
    index: usize,
    count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let usage = || "is not a part; write for example 2/8".to_owned();
        let (index, count) = text.split_once('/').ok_or_else(usage)?;
        let (index, count): (usize, usize) =
            (index.parse().map_err(|_| usage())?, count.parse().map_err(|_| usage())?);
        if index == 0 || index > count {
            return Err(format!("part {index} of {count} does not exist; parts are counted from 1"));
        }
        Ok(Self { index: index - 1, count })
    }
}

/// Returns the files to convert, in the order of the inputs, files of folders by name.
///
/// # Errors
///
/// An input that does not exist, several inputs for one file, or two inputs for the same output.
pub(super) fn plan(
    inputs: &[PathBuf],
    output: &Path,
    to: Option<&str>,
    shard: Option<Shard>,
) -> Result<Vec<PlannedFile>, Failure> {
    let one = matches!(inputs, [input] if !input.is_dir());
    let files = if one && to.is_none() && !output.is_dir() {
        vec![PlannedFile { input: inputs[0].clone(), output: output.to_path_buf(), is_in_folder: false }]
    } else {
        into_folder(inputs, output, to)?
    };
    let mut outputs: HashMap<&Path, &Path> = HashMap::new();
    for file in &files {
        if let Some(other) = outputs.insert(&file.output, &file.input) {
            let both = format!("{} and {}", other.display(), file.input.display());
            let same = format!("both are converted to {}", file.output.display());
            return Err(Failure::input(both, same));
        }
    }
    let is_own = |index: usize| shard.is_none_or(|shard| index % shard.count == shard.index);
    Ok(files.into_iter().enumerate().filter(|(index, _)| is_own(*index)).map(|(_, file)| file).collect())
}

fn into_folder(inputs: &[PathBuf], output: &Path, to: Option<&str>) -> Result<Vec<PlannedFile>, Failure> {
    let Some(extension) = to else {
        let reason = "is a folder for several files, so --to EXT must tell the format";
        return Err(Failure::input(output.display(), reason));
    };
    if output.exists() && !output.is_dir() {
        return Err(Failure::input(output.display(), "is a file; several files need a folder"));
    }
    let mut files = Vec::new();
    for input in inputs {
        let (base, found) = if input.is_dir() {
            (input.as_path(), models_below(input)?)
        } else {
            (input.parent().unwrap_or(Path::new("")), vec![input.clone()])
        };
        for path in found {
            let below = path.strip_prefix(base).unwrap_or(&path);
            let output = output.join(below).with_extension(extension);
            files.push(PlannedFile { input: path, output, is_in_folder: true });
        }
    }
    Ok(files)
}

/// Returns all models in a folder and its folders, sorted. Links to folders are not followed.
fn models_below(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let formats = formats();
    let (mut found, mut folders) = (Vec::new(), vec![(folder.to_path_buf(), 0)]);
    while let Some((folder, depth)) = folders.pop() {
        let failed = |error: std::io::Error| Failure::input(folder.display(), error);
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let (path, kind) = (entry.path(), entry.file_type().map_err(failed)?);
            let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
            if kind.is_dir() && depth < DEPTH {
                folders.push((path, depth + 1));
            } else if !kind.is_dir() && formats.by_extension(extension).is_some() {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}
