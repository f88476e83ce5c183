//! Guarded access to the files of a model.
//!
//! A model may refer to other files: buffers, images. It may also be malicious, so a name leads only to a regular file
//! inside the folder of the model. Everything else is refused immediately: a pipe never blocks, a device is never
//! read, and a link out of the folder is never followed, even if it is created while the file is opened.

use dragonfly_anim::format::{AssetError, AssetFs};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Maximum length of one part of a path: the limit of file systems.
const MAX_NAME: usize = 255;

/// Maximum length of a path inside the folder.
const MAX_PATH: usize = 4096;

/// Maximum depth below the folder.
const MAX_DEPTH: usize = 64;

/// The reason why a file was not opened.
#[derive(Debug, thiserror::Error)]
pub enum FileAccessError {
    /// The name cannot be that of a file in the folder.
    #[error("is no name of a file in the model's folder: {0}")]
    Name(&'static str),
    /// The name leads out of the folder through links.
    #[error("leads out of the model's folder")]
    Outside,
    /// A folder, pipe, device or socket.
    #[error("is {0}, not a regular file")]
    NotRegular(&'static str),
    /// The file is too large.
    #[error("holds {size} bytes, more than the {limit} that may be read")]
    TooLarge {
        /// Size of the file in bytes.
        size: u64,
        /// Maximum size in bytes.
        limit: u64,
    },
    /// The system reported an error.
    #[error("{}", reason(.0))]
    Io(#[from] io::Error),
}

/// The folder of a model, with all folders below.
#[derive(Clone, Debug)]
pub struct Folder {
    /// Without links, so that a prefix of a path is a parent folder.
    root: PathBuf,
}

impl Folder {
    /// Returns the folder of `file`.
    pub fn of(file: &Path) -> Result<Self, FileAccessError> {
        let folder = match file.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        Self::new(folder)
    }

    /// Returns this folder.
    pub fn new(folder: &Path) -> Result<Self, FileAccessError> {
        Ok(Self { root: folder.canonicalize()? })
    }

    /// Returns the path of the existing file `name`, without links.
    pub(super) fn path_of(&self, name: &str) -> Result<PathBuf, FileAccessError> {
        let resolved = self.root.join(checked(name)?).canonicalize()?;
        if resolved.starts_with(&self.root) { Ok(resolved) } else { Err(FileAccessError::Outside) }
    }

    /// Returns the names of the first `most` files in the folder `inside` that end with `.` and `extension`, in alphabetical order; an empty
    /// name means this folder itself. In a folder with more than 100 × `most` files, some are not looked at.
    pub(super) fn names_in(&self, inside: &str, extension: &str, most: usize) -> Vec<String> {
        let folder = match inside {
            "" => Ok(self.root.clone()),
            inside => self.path_of(inside),
        };
        let Ok(entries) = folder.and_then(|folder| Ok(std::fs::read_dir(folder)?)) else { return Vec::new() };
        let named = |entry: io::Result<std::fs::DirEntry>| {
            let file = entry.ok()?.file_name().into_string().ok()?;
            let is_one = Path::new(&file).extension().is_some_and(|own| own.eq_ignore_ascii_case(extension));
            let path = if inside.is_empty() { file } else { format!("{inside}/{file}") };
            (is_one && checked(&path).is_ok()).then_some(path)
        };
        let mut names: Vec<String> = entries.take(100 * most).filter_map(named).collect();
        names.sort_unstable();
        names.truncate(most);
        names
    }

    /// Returns whether there is a file called `name`, or something else of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        checked(name).is_ok_and(|name| self.root.join(name).symlink_metadata().is_ok())
    }

    /// Returns the bytes of the file `name`: a relative path with `/` between its parts, percent-decoded.
    ///
    /// Links that stay inside the folder are followed.
    pub fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileAccessError> {
        read_regular(self.open(name)?, limit)
    }

    /// Opens the file `name`, for files that are not read as a whole; otherwise as [`Self::read`].
    pub fn open(&self, name: &str) -> Result<File, FileAccessError> {
        let resolved = self.path_of(name)?;
        let inside = resolved.strip_prefix(&self.root).map_err(|_| FileAccessError::Outside)?;
        system::open_below(&self.root, inside)
    }
}

impl AssetFs for Folder {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        Self::read(self, path, limit).map_err(AssetError::from)
    }
}

impl From<FileAccessError> for AssetError {
    fn from(error: FileAccessError) -> Self {
        match error {
            FileAccessError::Io(error) if error.kind() == io::ErrorKind::NotFound => Self::Missing,
            FileAccessError::Io(error) => Self::Failed(error.to_string()),
            FileAccessError::TooLarge { size, limit } => Self::TooLarge { size, limit },
            other => Self::Refused(other.to_string()),
        }
    }
}

/// Returns the bytes of a file that the user named. Links are followed, but only to a regular file.
pub fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, FileAccessError> {
    read_regular(open_file(path)?, limit)
}

/// Opens a file that the user named, as [`read_file`] does.
pub(crate) fn open_file(path: &Path) -> Result<File, FileAccessError> {
    regular(&std::fs::metadata(path)?)?;
    system::open(path)
}

/// Splits `name` into parts that lead only downwards.
pub(crate) fn checked(name: &str) -> Result<PathBuf, FileAccessError> {
    let refuse = |reason| Err(FileAccessError::Name(reason));
    if name.is_empty() {
        return refuse("it is empty");
    }
    if name.len() > MAX_PATH {
        return refuse("it is too long");
    }
    if name.chars().any(|character| character.is_control()) {
        return refuse("it holds a control character");
    }
    if name.contains('\\') {
        return refuse("it holds a backslash");
    }
    if name.starts_with('/') {
        return refuse("it is absolute");
    }
    // A colon in the first part is a scheme (`file:`, `http:`) or a drive.
    if name.split('/').next().is_some_and(|first| first.contains(':')) {
        return refuse("it names a scheme or a drive");
    }
    let mut path = PathBuf::new();
    let mut depth = 0;
    for part in name.split('/') {
        match part {
            "." => continue,
            ".." => return refuse("it leads out of the folder"),
            "" => return refuse("a part of it is empty"),
            _ if part.len() > MAX_NAME => return refuse("a part of it is too long"),
            // Some systems ignore these characters and would open a different file.
            _ if part.ends_with('.') || part.ends_with(' ') => {
                return refuse("a part of it ends with a dot or a blank");
            }
            _ if cfg!(windows) && (part.contains(':') || is_device_name(part)) => {
                return refuse("it names a device or a stream");
            }
            _ => path.push(part),
        }
        depth += 1;
        if depth > MAX_DEPTH {
            return refuse("it is in too many nested folders");
        }
    }
    if depth == 0 { refuse("it names the folder itself") } else { Ok(path) }
}

/// Returns whether Windows reserves the name for a device, with any extension.
fn is_device_name(part: &str) -> bool {
    let stem = part.split('.').next().unwrap_or(part).trim_end().to_ascii_uppercase();
    matches!(stem.as_str(), "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$")
        || (stem.len() == 4
            && (stem.starts_with("COM") || stem.starts_with("LPT"))
            && stem.as_bytes()[3].is_ascii_digit())
}

/// Checks that a file is regular; the error names what it is instead.
fn regular(metadata: &std::fs::Metadata) -> Result<(), FileAccessError> {
    if metadata.is_file() { Ok(()) } else { Err(FileAccessError::NotRegular(system::kind(metadata))) }
}

/// Reads a whole open file if it is regular and not larger than `limit`. Memory is allocated fallibly.
fn read_regular(file: File, limit: u64) -> Result<Vec<u8>, FileAccessError> {
    // Checked again with the open file: the name may refer to another file by now.
    let metadata = file.metadata()?;
    regular(&metadata)?;
    let size = metadata.len();
    if size > limit {
        return Err(FileAccessError::TooLarge { size, limit });
    }
    let mut bytes = Vec::new();
    let wanted = usize::try_from(size).map_err(|_| FileAccessError::TooLarge { size, limit })?;
    bytes.try_reserve_exact(wanted).map_err(|_| io::Error::from(io::ErrorKind::OutOfMemory))?;
    // One byte more than allowed detects a file that grows while it is read.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    let size = bytes.len() as u64;
    if size > limit { Err(FileAccessError::TooLarge { size, limit }) } else { Ok(bytes) }
}

/// Returns the system's message without its number.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "may not be read".to_owned(),
        io::ErrorKind::OutOfMemory => "does not fit into memory".to_owned(),
        _ => format!("cannot be read: {error}"),
    }
}

#[cfg(unix)]
mod system {
    use super::FileAccessError;
    use rustix::fs::{Mode, OFlags, open as open_path, openat};
    use std::fs::File;
    use std::os::unix::fs::FileTypeExt;
    use std::path::{Component, Path};

    /// Non-blocking, so that a pipe opens immediately and can be refused; never as the controlling terminal.
    const READ: OFlags = OFlags::RDONLY.union(OFlags::NONBLOCK).union(OFlags::NOCTTY).union(OFlags::CLOEXEC);

    /// Opens a path that the user named.
    pub(super) fn open(path: &Path) -> Result<File, FileAccessError> {
        Ok(open_path(path, READ, Mode::empty()).map_err(std::io::Error::from)?.into())
    }

    /// Opens `inside`, a path without links, folder by folder. A folder that has become a link since then is refused.
    pub(super) fn open_below(root: &Path, inside: &Path) -> Result<File, FileAccessError> {
        let step = OFlags::DIRECTORY.union(OFlags::NOFOLLOW).union(OFlags::CLOEXEC);
        let mut folder = open_path(root, OFlags::DIRECTORY.union(OFlags::CLOEXEC), Mode::empty())
            .map_err(std::io::Error::from)?;
        let mut parts = inside.components().peekable();
        while let Some(part) = parts.next() {
            let Component::Normal(part) = part else { return Err(FileAccessError::Outside) };
            if parts.peek().is_some() {
                folder = openat(&folder, part, step, Mode::empty()).map_err(link)?;
                continue;
            }
            // Opening a device can have side effects, so its type is checked before.
            let status = rustix::fs::statat(&folder, part, rustix::fs::AtFlags::SYMLINK_NOFOLLOW)
                .map_err(std::io::Error::from)?;
            let kind = rustix::fs::FileType::from_raw_mode(status.st_mode);
            if kind != rustix::fs::FileType::RegularFile {
                return Err(FileAccessError::NotRegular(name_of(kind)));
            }
            let file = openat(&folder, part, READ.union(OFlags::NOFOLLOW), Mode::empty()).map_err(link)?;
            return Ok(file.into());
        }
        Err(FileAccessError::NotRegular("a folder"))
    }

    /// A new link here is an attempt to lead out of the folder.
    fn link(error: rustix::io::Errno) -> FileAccessError {
        match error {
            rustix::io::Errno::LOOP | rustix::io::Errno::NOTDIR => FileAccessError::Outside,
            other => FileAccessError::Io(other.into()),
        }
    }

    fn name_of(kind: rustix::fs::FileType) -> &'static str {
        match kind {
            rustix::fs::FileType::Directory => "a folder",
            rustix::fs::FileType::Fifo => "a pipe",
            rustix::fs::FileType::CharacterDevice | rustix::fs::FileType::BlockDevice => "a device",
            rustix::fs::FileType::Socket => "a socket",
            rustix::fs::FileType::Symlink => "a link",
            _ => "something else",
        }
    }

    /// Returns the name of a file type that is not regular.
    pub(super) fn kind(metadata: &std::fs::Metadata) -> &'static str {
        let kind = metadata.file_type();
        if kind.is_dir() {
            "a folder"
        } else if kind.is_fifo() {
            "a pipe"
        } else if kind.is_char_device() || kind.is_block_device() {
            "a device"
        } else if kind.is_socket() {
            "a socket"
        } else {
            "something else"
        }
    }
}

#[cfg(not(unix))]
mod system {
    use super::FileAccessError;
    use std::fs::File;
    use std::path::Path;

    /// Opens a path that the user named.
    pub(super) fn open(path: &Path) -> Result<File, FileAccessError> {
        Ok(File::open(path)?)
    }

    /// Opens a path that was found to be inside the folder. Without `openat` the check cannot be stricter.
    pub(super) fn open_below(root: &Path, inside: &Path) -> Result<File, FileAccessError> {
        let path = root.join(inside);
        super::regular(&std::fs::symlink_metadata(&path)?)?;
        Ok(File::open(path)?)
    }

    /// Returns the name of a file type that is not regular.
    pub(super) fn kind(metadata: &std::fs::Metadata) -> &'static str {
        if metadata.is_dir() { "a folder" } else { "something else" }
    }
}
