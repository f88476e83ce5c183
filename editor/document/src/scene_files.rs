//! Files that a scene is to get: those from outside of its folder are copied into it, because a scene names only what is in its folder.
//! Everything here reads files and is called in jobs.

use super::beside::BesideStamps;
use super::copied_files::{CopiedFiles, ensure_inside, is_same};
use super::folder::{checked, open_file};
use super::needed_files::NeededFiles;
use super::source::file_name;
use super::{Cancel, Folder, make_folder, read_file};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{ExpectedFile, FileStamp, RealFiles, SaveOptions, save};
use std::path::{Component, Path, PathBuf};

/// Number of names that are tried for a copy.
const MOST_NAMES: u32 = 10_000;

/// The kind of a file that a script names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SceneFileKind {
    /// A model.
    Model,
    /// A sound.
    Sound,
}

/// A file that a script names and that is missing, or cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingFile {
    /// Its kind.
    pub kind: SceneFileKind,
    /// The text with which scripts name it: of a model of a project its id.
    pub name: String,
    /// The file, relative to the folder of the scene.
    pub file: String,
}

/// A file that a scene is to get.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFile {
    /// Its kind.
    pub kind: SceneFileKind,
    /// The file.
    pub path: PathBuf,
    /// Its name as scripts write it, relative to the folder of the scene; `None` where it is outside, or was not looked at.
    pub name: Option<String>,
    /// The files next to it that a model outside needs, relative to its folder.
    pub beside: Vec<String>,
    /// The missing file in whose place it is.
    pub replaces: Option<MissingFile>,
    /// Hash of a model in the folder of the scene; `None` for others.
    pub hash: Option<u64>,
    /// Number of files that were written to copy it into the folder of the scene.
    pub written: usize,
}

/// Files that a scene is to get.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFiles {
    /// The folder of the scene.
    pub folder: PathBuf,
    /// The files.
    pub files: Vec<SceneFile>,
}

impl SceneFileKind {
    /// Returns the folder of a scene that gets copies of files of this kind.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Model => "models",
            Self::Sound => "sound",
        }
    }
}

impl SceneFile {
    /// Returns a file of which nothing is known.
    pub fn new(kind: SceneFileKind, path: PathBuf) -> Self {
        Self { kind, path, name: None, beside: Vec::new(), replaces: None, hash: None, written: 0 }
    }
}

impl SceneFiles {
    /// Returns whether all of them are in the folder of the scene.
    pub fn are_inside(&self) -> bool {
        self.files.iter().all(|file| file.name.is_some())
    }

    /// Returns the files outside of the folder of the scene.
    pub fn outside(&self) -> impl Iterator<Item = &SceneFile> {
        self.files.iter().filter(|file| file.name.is_none())
    }

    /// Finds out which of the files are in the folder of the scene, and what the models outside need. Adds those of `others`, which are
    /// missing too, that are next to the first file under their own names and can be used.
    ///
    /// # Errors
    ///
    /// The first of the files that cannot be read, with the reason.
    pub fn look(&mut self, others: Vec<MissingFile>, cancel: &Cancel) -> Result<(), String> {
        let root = self.root()?;
        for file in &mut self.files {
            file.look(&self.folder, &root, cancel)?;
        }
        let chosen = self.files.first().map(|file| file.path.clone());
        if let Some((chosen, beside)) = chosen.as_ref().and_then(|file| Some((file, file.parent()?))) {
            for other in others {
                let path = beside.join(file_name(Path::new(&other.file)));
                // Two missing files of one name are two files.
                if path == *chosen {
                    continue;
                }
                // The one that is named already may be there and damaged.
                let is_named = root
                    .path_of(&other.file)
                    .is_ok_and(|own| path.canonicalize().is_ok_and(|path| path == own));
                if !is_named && open_file(&path).is_ok() {
                    let mut file = SceneFile::new(other.kind, path);
                    file.replaces = Some(other);
                    // A damaged one stays missing.
                    if file.look(&self.folder, &root, cancel).is_ok() {
                        self.files.push(file);
                    }
                }
            }
        }
        Ok(())
    }

    /// Copies the files outside into the folder of the scene, each with the files next to it that it needs. No file that is there is
    /// overwritten: the same file is used, and where there is another one of its name, the copy gets another name. Returns the number of files that were
    /// written.
    ///
    /// # Errors
    ///
    /// The path and the reason. Copies before it stay.
    pub fn copy(&mut self, cancel: &Cancel) -> Result<usize, String> {
        let root = self.root()?;
        let mut written = 0;
        for file in self.files.iter_mut().filter(|file| file.name.is_none()) {
            let name = file.place(&self.folder)?;
            file.written = file.copy_to(&self.folder, &name, cancel)?;
            written += file.written;
            root.path_of(&name).map_err(|error| format!("{name} {error}"))?;
            file.hash = file.hash_of(&self.folder.join(&name))?;
            file.name = Some(name);
        }
        Ok(written)
    }

    fn root(&self) -> Result<Folder, String> {
        Folder::new(&self.folder).map_err(|error| format!("{} {error}", self.folder.display()))
    }
}

impl SceneFile {
    /// Finds out whether it is in the folder of the scene, and what it needs where it is a model outside.
    fn look(&mut self, folder: &Path, root: &Folder, cancel: &Cancel) -> Result<(), String> {
        let title = file_name(&self.path);
        open_file(&self.path).map_err(|error| format!("{title} {error}"))?;
        self.name = name_inside(folder, root, &self.path);
        if self.name.is_some() {
            self.hash = self.hash_of(&self.path)?;
        } else if self.kind == SceneFileKind::Model {
            self.beside = beside(&self.path, cancel)?;
        }
        Ok(())
    }

    /// Returns the hash of a model; `None` for other kinds.
    fn hash_of(&self, path: &Path) -> Result<Option<u64>, String> {
        if self.kind != SceneFileKind::Model {
            return Ok(None);
        }
        let stamp = FileStamp::take(&RealFiles, path);
        stamp.map(|stamp| Some(stamp.hash)).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Returns the name of its copy, relative to the folder of the scene: it is free there, or that of the same file.
    fn place(&self, folder: &Path) -> Result<String, String> {
        let title = file_name(&self.path);
        let not_named = || format!("{title} cannot be named in a scene: rename it first");
        let name = self.path.file_name().and_then(|name| name.to_str()).ok_or_else(not_named)?;
        checked(name).map_err(|_| not_named())?;
        let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
        let from = Folder::of(&self.path).map_err(|error| format!("{title} {error}"))?;
        let fits = |source: &str, target: &str| {
            let target = folder.join(target);
            let same = || {
                let file = from.open(source).ok()?;
                let size = file.metadata().ok()?.len();
                Some(is_same(file, size, &target))
            };
            target.symlink_metadata().is_err() || same() == Some(true)
        };
        let fits_beside = |inside: &str| self.beside.iter().all(|own| fits(own, &format!("{inside}/{own}")));
        let inside = self.kind.folder();
        // A model names the files next to it, so that they keep their names.
        let has_room = fits_beside(inside);
        let candidate = |number: u32| {
            let number = if number == 1 { String::new() } else { format!("-{number}") };
            match has_room {
                true if extension.is_empty() => (inside.to_owned(), format!("{stem}{number}")),
                true => (inside.to_owned(), format!("{stem}{number}.{extension}")),
                false => (format!("{inside}/{stem}{number}"), name.to_owned()),
            }
        };
        let mut candidates = (1..=MOST_NAMES).map(candidate);
        let found = candidates.find_map(|(inside, own)| {
            let target = format!("{inside}/{own}");
            (fits(name, &target) && fits_beside(&inside)).then_some(target)
        });
        found.ok_or_else(|| {
            format!("{title}: {} has too many files of this name", folder.join(inside).display())
        })
    }

    /// Writes its copy, called `name` in the folder of the scene, and those of the files that it needs. Returns the number of files.
    fn copy_to(&self, folder: &Path, name: &str, cancel: &Cancel) -> Result<usize, String> {
        let title = file_name(&self.path);
        let target = &folder.join(name);
        ensure_inside(folder, target)?;
        let from = Folder::of(&self.path).map_err(|error| format!("{title} {error}"))?;
        let to = target.parent().unwrap_or(target);
        let earlier = BesideStamps::default();
        let beside = CopiedFiles::find(from, to, self.beside.iter().cloned(), &earlier, cancel)?;
        if let Some(missing) = beside.notices().next() {
            return Err(missing);
        }
        let mut written = 0;
        // Last, so that it never refers to a file that does not exist.
        beside.write(None, cancel, |_, _, _| written += 1)?;
        if cancel.is_cancelled() {
            return Err("it was cancelled".to_owned());
        }
        let bytes = read_file(&self.path, FILE_BYTES).map_err(|error| format!("{title} {error}"))?;
        if is_same(&*bytes, bytes.len() as u64, target) {
            return Ok(written);
        }
        make_folder(target)?;
        let options = SaveOptions { expected: ExpectedFile::Nothing, versions: None };
        save(&RealFiles, target, &bytes, &options).map_err(|error| error.to_string())?;
        Ok(written + 1)
    }
}

/// Returns the files next to a model that it needs.
fn beside(path: &Path, cancel: &Cancel) -> Result<Vec<String>, String> {
    let title = file_name(path);
    let bytes = read_file(path, FILE_BYTES).map_err(|error| format!("{title} {error}"))?;
    let found = NeededFiles::of_model(path, &bytes, cancel).map_err(|error| format!("{title} {error}"))?;
    match found.reasons.into_iter().next() {
        Some(reason) => Err(reason),
        None => Ok(found.names.into_iter().collect()),
    }
}

/// Returns the name of a file in a folder or below, as scripts write it; `None` where it is outside, also through links.
fn name_inside(folder: &Path, root: &Folder, path: &Path) -> Option<String> {
    let real = path.canonicalize().ok()?;
    let is_it = |name: &String| root.path_of(name).is_ok_and(|found| found == real);
    let real_folder = folder.canonicalize().ok()?;
    let names = [name_below(folder, path), name_below(&real_folder, &real)];
    names.into_iter().flatten().find(is_it)
}

/// Returns a path relative to a folder that contains it, with `/`, without looking at the disk; `None` where it is outside.
fn name_below(folder: &Path, path: &Path) -> Option<String> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (folder, path) = (absolute(folder), absolute(path));
    let parts: Option<Vec<&str>> = path.strip_prefix(&folder).ok()?.components().map(part).collect();
    parts.map(|parts| parts.join("/")).filter(|name| !name.is_empty())
}

fn part(part: Component<'_>) -> Option<&str> {
    match part {
        Component::Normal(name) => name.to_str(),
        Component::Prefix(_) | Component::RootDir | Component::CurDir | Component::ParentDir => None,
    }
}
