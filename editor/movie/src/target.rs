//! Destinations of a movie: a file, a file for each frame, or a stream.

use crate::error::MovieError;
use crate::files::MovieFile;
use dragonfly_store::{FileSaveError, RealFiles, Vfs};
use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Destination of a movie.
pub enum MovieTarget {
    /// A file, which is replaced when the movie is complete; for formats of a file for each frame their names, in which `####` becomes the
    /// number of the frame.
    Path {
        /// The file system.
        files: Arc<dyn Vfs>,
        /// The path.
        path: PathBuf,
    },
    /// A receiver of the bytes in order, such as the input of another program.
    Stream(Box<dyn Write + Send>),
}

impl fmt::Debug for MovieTarget {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Path { path, .. } => write!(out, "MovieTarget({})", path.display()),
            Self::Stream(_) => out.write_str("MovieTarget(stream)"),
        }
    }
}

impl MovieTarget {
    /// Creates the destination for a path of the real file system.
    pub fn path(path: impl Into<PathBuf>) -> Self {
        Self::Path { files: Arc::new(RealFiles), path: path.into() }
    }

    /// Returns the file system and the path; an error for a stream.
    pub(crate) fn into_path(self, format: &'static str) -> Result<(Arc<dyn Vfs>, PathBuf), MovieError> {
        match self {
            Self::Path { files, path } => Ok((files, path)),
            Self::Stream(_) => Err(MovieError::Settings {
                format,
                reason: "cannot be written to a stream: name a file, or choose Y4M".to_owned(),
            }),
        }
    }
}

/// A file or stream that receives bytes in order.
pub(crate) enum MovieOutput {
    File(MovieFile),
    Stream { to: Box<dyn Write + Send>, size: u64 },
}

impl MovieOutput {
    pub(crate) fn open(target: MovieTarget) -> Result<Self, MovieError> {
        Ok(match target {
            MovieTarget::Path { files, path } => Self::File(MovieFile::create(files, &path)?),
            MovieTarget::Stream(to) => Self::Stream { to, size: 0 },
        })
    }

    pub(crate) fn append(&mut self, bytes: &[u8]) -> Result<(), MovieError> {
        match self {
            Self::File(file) => Ok(file.append(bytes)?),
            Self::Stream { to, size } => {
                to.write_all(bytes).map_err(MovieError::Stream)?;
                *size += bytes.len() as u64;
                Ok(())
            }
        }
    }

    /// Removes the bytes after the first `size`, if they can still be removed.
    pub(crate) fn truncate(&mut self, size: u64) -> Result<(), FileSaveError> {
        match self {
            Self::File(file) => file.truncate(size),
            Self::Stream { .. } => Ok(()),
        }
    }

    /// Writes the bytes of a buffer.
    pub(crate) fn settle(&mut self) -> Result<(), FileSaveError> {
        match self {
            Self::File(file) => file.settle(),
            Self::Stream { .. } => Ok(()),
        }
    }

    /// Returns the number of bytes so far.
    pub(crate) fn size(&self) -> u64 {
        match self {
            Self::File(file) => file.size(),
            Self::Stream { size, .. } => *size,
        }
    }

    /// Flushes everything. Returns the path of the file and its size.
    pub(crate) fn end(self) -> Result<(Option<PathBuf>, u64), MovieError> {
        match self {
            Self::File(file) => {
                let (path, size) = file.commit()?;
                Ok((Some(path), size))
            }
            Self::Stream { mut to, size } => {
                to.flush().map_err(MovieError::Stream)?;
                Ok((None, size))
            }
        }
    }
}

/// Names of the files of frames: `shot.####.png`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SequenceName {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl SequenceName {
    /// Reads a path in whose file name the last `#` signs are the number of a frame, with at least that many digits. Without any,
    /// `.####` is put before the extension. Returns `None` for a path without a file name.
    pub fn parse(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        if let Some(last) = name.rfind('#') {
            let before = name[..last].trim_end_matches('#');
            let after = name[last + 1..].to_owned();
            return Some(Self { folder, digits: last + 1 - before.len(), before: before.to_owned(), after });
        }
        let (stem, extension) = match name.rfind('.') {
            Some(dot) if dot > 0 => name.split_at(dot),
            _ => (name, ""),
        };
        Some(Self { folder, before: format!("{stem}."), digits: 4, after: extension.to_owned() })
    }

    /// Returns the folder of the frames.
    pub fn folder(&self) -> &Path {
        match self.folder.as_os_str().is_empty() {
            true => Path::new("."),
            false => &self.folder,
        }
    }

    /// Returns whether the name of a file is that of a frame.
    pub fn is_frame(&self, name: &str) -> bool {
        let number = name.strip_prefix(&*self.before).and_then(|rest| rest.strip_suffix(&*self.after));
        number.is_some_and(|number| {
            number.len() >= self.digits.max(1) && number.bytes().all(|byte| byte.is_ascii_digit())
        })
    }

    /// Returns the path of a frame.
    pub fn frame(&self, number: u64) -> PathBuf {
        self.folder.join(format!("{}{number:0digits$}{}", self.before, self.after, digits = self.digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_a_frame_replaces_the_last_signs_of_the_file_name() {
        let name = |path: &str, number| SequenceName::parse(Path::new(path)).unwrap().frame(number);
        assert_eq!(name("out#1/f.###.png", 7), Path::new("out#1/f.007.png"));
        assert_eq!(name("a#b_##x.exr", 1234), Path::new("a#b_1234x.exr"));
        assert_eq!(name("shot.png", 12), Path::new("shot.0012.png"));
        assert_eq!(name("shot", 0), Path::new("shot.0000"));
        assert_eq!(name(".png", 0), Path::new(".png.0000"));
        assert_eq!(SequenceName::parse(Path::new("/")), None);
    }

    #[test]
    fn a_name_with_another_beginning_end_or_number_is_not_that_of_a_frame() {
        let name = SequenceName::parse(Path::new("out/f.###.png")).unwrap();
        let found = ["f.007.png", "f.12345.png", "f.07.png", "f.0a7.png", "f..png", "g.007.png", "f.007.exr"]
            .map(|file| name.is_frame(file));
        assert_eq!(found, [true, true, false, false, false, false, false]);
    }
}
