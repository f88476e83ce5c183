//! The pose library: a folder of poses, one JSON file each, that users share and read.
//!
//! ```json
//! {"dragonfly": "pose", "version": 1, "name": "Fist", "tags": ["hand"],
//!  "poses": [{"bone": "hand.L", "translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]}]}
//! ```
//!
//! The text is that of a copied pose with a name and tags, so a file can also be pasted. Its `poses` are those of the edits `paste`
//! and `set`, which `dragonfly edit` and `--stdio` apply.

use crate::edit::BonePose;
use dragonfly_runtime::Job;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// Largest file that is read, bytes: enough for ten thousand bones.
const FILE_BYTES: u64 = 4 << 20;
/// Largest number of poses of a folder.
const POSES: usize = 1000;
/// Size of all poses of a folder, bytes.
const FOLDER_BYTES: u64 = 128 << 20;
/// End of the names of the files.
const ENDING: &str = ".pose.json";

/// A pose with its name and tags.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredPose {
    /// The kind of text: "pose".
    dragonfly: String,
    version: u32,
    /// Name in the library.
    #[serde(default)]
    pub name: String,
    /// Words by which it is found.
    #[serde(default)]
    pub tags: Vec<String>,
    /// Poses of bones, by name, in the spaces of their parents.
    pub poses: Vec<BonePose>,
}

impl StoredPose {
    /// Returns a pose for the library.
    pub fn new(name: String, tags: Vec<String>, poses: Vec<BonePose>) -> Self {
        Self { dragonfly: "pose".to_owned(), version: 1, name, tags, poses }
    }

    /// Returns the text of its file.
    pub fn to_text(&self) -> String {
        // Plain data of strings and finite numbers can always be serialized.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Returns the pose of a text.
    ///
    /// # Errors
    ///
    /// The reason why the text is not one of a pose.
    pub fn parse(text: &str) -> Result<Self, String> {
        let pose: Self = serde_json::from_str(text).map_err(|error| format!("this is no pose: {error}"))?;
        if pose.dragonfly != "pose" {
            return Err(format!("this is no pose but {:?}", pose.dragonfly));
        }
        if pose.version != 1 {
            return Err(format!("the pose is of version {}, made by a newer program", pose.version));
        }
        let finite = |pose: &BonePose| {
            let numbers = pose.translation.iter().flatten().chain(pose.rotation.iter().flatten());
            numbers.chain(pose.scale.iter().flatten()).all(|number| number.is_finite())
        };
        if pose.poses.is_empty() || !pose.poses.iter().all(finite) {
            return Err("the pose has no bones, or numbers that are not finite".to_owned());
        }
        Ok(pose)
    }
}

/// A pose in its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseFile {
    /// Name of the file, without the folder.
    pub file: String,
    /// Its pose.
    pub pose: StoredPose,
}

/// The poses of a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseFolder {
    /// The folder.
    pub folder: PathBuf,
    /// Its poses, by name.
    pub poses: Vec<PoseFile>,
    /// The files that could not be read, each with the reason.
    pub problems: Vec<String>,
}

/// An action with the pose library. The reply is [`crate::DocumentReply::Poses`] with the folder as it is then.
#[derive(Clone, Debug, PartialEq)]
pub enum PoseOrder {
    /// Reads a folder.
    Read(PathBuf),
    /// Writes a pose; the folder is created where it does not exist.
    Save {
        /// The folder.
        folder: PathBuf,
        /// The file that is replaced; a new one where `None`.
        file: Option<String>,
        /// The pose.
        pose: StoredPose,
    },
    /// Deletes a pose.
    Delete {
        /// The folder.
        folder: PathBuf,
        /// The file.
        file: String,
    },
}

/// The orders that wait, and the job that carries one out.
#[derive(Default)]
pub(super) struct PoseFiles {
    pub(super) waiting: VecDeque<PoseOrder>,
    pub(super) job: Option<Job>,
}

impl PoseOrder {
    /// Carries out the order.
    ///
    /// # Errors
    ///
    /// Path and reason.
    pub(crate) fn run(&self) -> Result<PoseFolder, String> {
        match self {
            Self::Read(folder) => read_folder(folder),
            Self::Save { folder, file, pose } => {
                let told = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
                std::fs::create_dir_all(folder).map_err(|error| told(&error))?;
                let path = match file {
                    Some(file) => existing(folder, file)?,
                    None => unused(folder, &pose.name).ok_or_else(|| told(&"there are too many poses"))?,
                };
                let written = dragonfly_store::replace(&path, pose.to_text().as_bytes());
                written.map_err(|error| format!("{}: {error}", path.display()))?;
                read_folder(folder)
            }
            Self::Delete { folder, file } => {
                let path = existing(folder, file)?;
                std::fs::remove_file(&path).map_err(|error| format!("{}: {error}", path.display()))?;
                read_folder(folder)
            }
        }
    }
}

/// Returns the path of a pose. A file that is no pose is not replaced or deleted.
fn existing(folder: &Path, file: &str) -> Result<PathBuf, String> {
    let path = folder.join(file);
    let is_plain = Path::new(file).file_name().is_some_and(|name| name == file);
    if !is_plain || !file.ends_with(ENDING) {
        return Err(format!("{file:?} is not the name of a pose file"));
    }
    match read_pose(&path) {
        Ok(_) => Ok(path),
        Err(reason) => Err(format!("{}: {reason}", path.display())),
    }
}

/// Returns the path of a new file for a pose with this name.
fn unused(folder: &Path, name: &str) -> Option<PathBuf> {
    let plain = |letter: char| if letter.is_alphanumeric() { letter } else { '-' };
    let plain: String = name.trim().chars().take(60).map(plain).collect();
    let plain = if plain.is_empty() { "pose".to_owned() } else { plain };
    let numbered = |number: usize| match number {
        1 => folder.join(format!("{plain}{ENDING}")),
        _ => folder.join(format!("{plain}-{number}{ENDING}")),
    };
    (1..=POSES + 1).map(numbered).find(|path| path.symlink_metadata().is_err())
}

fn read_pose(path: &Path) -> Result<(StoredPose, u64), String> {
    let bytes = crate::read_file(path, FILE_BYTES).map_err(|error| error.to_string())?;
    let size = bytes.len() as u64;
    let text = String::from_utf8(bytes).map_err(|error| error.to_string())?;
    Ok((StoredPose::parse(&text)?, size))
}

/// Reads all poses of a folder; a folder that does not exist has none.
fn read_folder(folder: &Path) -> Result<PoseFolder, String> {
    let mut found = PoseFolder { folder: folder.to_owned(), ..PoseFolder::default() };
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(found),
        Err(error) => return Err(format!("{}: {error}", folder.display())),
    };
    let name = |entry: std::fs::DirEntry| entry.file_name().into_string().ok();
    let mut files: Vec<String> =
        entries.flatten().filter_map(name).filter(|name| name.ends_with(ENDING)).collect();
    files.sort();
    let mut size = 0;
    for file in files {
        if found.poses.len() == POSES || size > FOLDER_BYTES {
            found.problems.push(format!("The folder has more than {POSES} poses, or too large ones"));
            break;
        }
        match read_pose(&folder.join(&file)) {
            Ok((pose, bytes)) => {
                size += bytes;
                found.poses.push(PoseFile { file, pose });
            }
            Err(reason) => found.problems.push(format!("{file}: {reason}")),
        }
    }
    found.poses.sort_by_key(|found| found.pose.name.to_lowercase());
    Ok(found)
}
