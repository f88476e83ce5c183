//! The file system of this machine.

use super::vfs::{Attribute, FileData, FileKind, Vfs, VfsFile};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// The real file system.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealFiles;

impl Vfs for RealFiles {
    fn create_new(&self, path: &Path, private: bool) -> io::Result<Box<dyn VfsFile>> {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create_new(true);
        if private {
            system::private(&mut options);
        }
        Ok(Box::new(options.open(path)?))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        let mut options = OpenOptions::new();
        options.read(true);
        system::nonblocking(&mut options);
        Ok(Box::new(options.open(path)?))
    }

    fn open_to_write(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        let mut options = OpenOptions::new();
        options.read(true).write(true);
        system::nonblocking(&mut options);
        Ok(Box::new(options.open(path)?))
    }

    fn metadata(&self, path: &Path) -> io::Result<FileData> {
        Ok(system::data(&fs::symlink_metadata(path)?))
    }

    fn read_link(&self, path: &Path) -> io::Result<PathBuf> {
        fs::read_link(path)
    }

    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        fs::canonicalize(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()> {
        rename_to_new::to_new(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        system::create_folder(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        system::sync_folder(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        system::list(path)
    }
}

impl VfsFile for File {
    fn metadata(&self) -> io::Result<FileData> {
        Ok(system::data(&File::metadata(self)?))
    }

    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        system::read_at(self, bytes, offset)
    }

    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        system::write_at(self, bytes, offset)
    }

    fn set_size(&self, size: u64) -> io::Result<()> {
        self.set_len(size)
    }

    fn sync_data(&self) -> io::Result<()> {
        File::sync_data(self)
    }

    fn sync_all(&self) -> io::Result<()> {
        File::sync_all(self)
    }

    fn try_lock(&self) -> io::Result<bool> {
        match File::try_lock(self) {
            Ok(()) => Ok(true),
            Err(TryLockError::WouldBlock) => Ok(false),
            Err(TryLockError::Error(error)) if system::has_no_locks(&error) => {
                Err(io::ErrorKind::Unsupported.into())
            }
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    fn unlock(&self) -> io::Result<()> {
        File::unlock(self)
    }

    fn set_owner(&self, owner: Option<u32>, group: u32) -> io::Result<()> {
        system::set_owner(self, owner, group)
    }

    fn set_mode(&self, mode: u32) -> io::Result<()> {
        system::set_mode(self, mode)
    }

    fn attributes(&self) -> io::Result<Vec<Attribute>> {
        attributes::all(self)
    }

    fn set_attribute(&self, name: &[u8], value: &[u8]) -> io::Result<()> {
        attributes::set(self, name, value)
    }
}

/// Returns the kind of a directory entry.
fn kind_of(metadata: &std::fs::Metadata) -> FileKind {
    let kind = metadata.file_type();
    match () {
        () if kind.is_file() => FileKind::File,
        () if kind.is_dir() => FileKind::Folder,
        () if kind.is_symlink() => FileKind::Link,
        () => FileKind::Other,
    }
}

#[cfg(unix)]
mod system {
    use crate::vfs::FileData;
    use rustix::fs::{Dir, OFlags};
    use rustix::io::Errno;
    use std::ffi::{OsStr, OsString};
    use std::fs::{DirBuilder, File, Metadata, OpenOptions, Permissions};
    use std::io;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::{DirBuilderExt, FileExt, MetadataExt, OpenOptionsExt, PermissionsExt, fchown};
    use std::path::Path;

    pub(super) fn private(options: &mut OpenOptions) {
        options.mode(0o600);
    }

    /// Makes opening a pipe return at once, in case another program put one in place of a file.
    pub(super) fn nonblocking(options: &mut OpenOptions) {
        let flags = OFlags::NONBLOCK.union(OFlags::NOCTTY).bits();
        options.custom_flags(i32::try_from(flags).unwrap_or(0));
    }

    pub(super) fn data(metadata: &Metadata) -> FileData {
        FileData {
            kind: super::kind_of(metadata),
            size: metadata.len(),
            modified: nanoseconds(metadata.mtime(), metadata.mtime_nsec()),
            changed: nanoseconds(metadata.ctime(), metadata.ctime_nsec()),
            device: metadata.dev(),
            inode: metadata.ino(),
            links: metadata.nlink(),
            mode: metadata.mode() & 0o7777,
            owner: metadata.uid(),
            group: metadata.gid(),
        }
    }

    fn nanoseconds(seconds: i64, nanoseconds: i64) -> i64 {
        seconds.saturating_mul(1_000_000_000).saturating_add(nanoseconds)
    }

    pub(super) fn create_folder(path: &Path) -> io::Result<()> {
        DirBuilder::new().recursive(true).mode(0o700).create(path)
    }

    /// Lists a folder without `std::fs::read_dir`, which panics where the folder cannot be closed.
    pub(super) fn list(path: &Path) -> io::Result<Vec<OsString>> {
        let mut names = Vec::new();
        for entry in Dir::read_from(File::open(path)?)? {
            let entry = entry?;
            let name = OsStr::from_bytes(entry.file_name().to_bytes());
            if name != "." && name != ".." {
                names.push(name.to_owned());
            }
        }
        Ok(names)
    }

    pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
        match File::open(path)?.sync_all() {
            // Reported by file systems that cannot sync folders.
            Err(error) if error.raw_os_error() == Some(Errno::INVAL.raw_os_error()) => Ok(()),
            other => other,
        }
    }

    /// Returns whether the error means that the file system has no locks. `BADF` is what network file systems
    /// report for files opened for reading only.
    pub(super) fn has_no_locks(error: &io::Error) -> bool {
        let kinds = [Errno::NOLCK, Errno::NOTSUP, Errno::OPNOTSUPP, Errno::NOSYS, Errno::BADF];
        kinds.iter().any(|kind| error.raw_os_error() == Some(kind.raw_os_error()))
    }

    pub(super) fn read_at(file: &File, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        file.read_at(bytes, offset)
    }

    pub(super) fn write_at(file: &File, bytes: &[u8], offset: u64) -> io::Result<usize> {
        file.write_at(bytes, offset)
    }

    pub(super) fn set_owner(file: &File, owner: Option<u32>, group: u32) -> io::Result<()> {
        fchown(file, owner, Some(group))
    }

    pub(super) fn set_mode(file: &File, mode: u32) -> io::Result<()> {
        file.set_permissions(Permissions::from_mode(mode))
    }
}

#[cfg(not(unix))]
mod system {
    use crate::vfs::FileData;
    use std::ffi::OsString;
    use std::fs::{File, Metadata, OpenOptions};
    use std::io::{self, Read, Seek, SeekFrom, Write};
    use std::path::Path;
    use std::time::{SystemTime, UNIX_EPOCH};

    pub(super) fn private(_: &mut OpenOptions) {}

    pub(super) fn nonblocking(_: &mut OpenOptions) {}

    /// Returns the metadata that this system provides: no file numbers, owners or link counts. Two files then
    /// differ only in size, times and content.
    pub(super) fn data(metadata: &Metadata) -> FileData {
        FileData {
            kind: super::kind_of(metadata),
            size: metadata.len(),
            modified: metadata.modified().map_or(0, nanoseconds),
            changed: 0,
            device: 0,
            inode: 0,
            links: 1,
            mode: if metadata.permissions().readonly() { 0o444 } else { 0o666 },
            owner: 0,
            group: 0,
        }
    }

    fn nanoseconds(time: SystemTime) -> i64 {
        time.duration_since(UNIX_EPOCH).map_or(0, |since| i64::try_from(since.as_nanos()).unwrap_or(i64::MAX))
    }

    pub(super) fn create_folder(path: &Path) -> io::Result<()> {
        std::fs::create_dir_all(path)
    }

    pub(super) fn list(path: &Path) -> io::Result<Vec<OsString>> {
        std::fs::read_dir(path)?.map(|entry| Ok(entry?.file_name())).collect()
    }

    /// Does nothing, because folders cannot be opened on this system, which journals file names itself.
    pub(super) fn sync_folder(_: &Path) -> io::Result<()> {
        Ok(())
    }

    pub(super) fn has_no_locks(error: &io::Error) -> bool {
        error.kind() == io::ErrorKind::Unsupported
    }

    pub(super) fn read_at(mut file: &File, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        file.seek(SeekFrom::Start(offset))?;
        file.read(bytes)
    }

    pub(super) fn write_at(mut file: &File, bytes: &[u8], offset: u64) -> io::Result<usize> {
        file.seek(SeekFrom::Start(offset))?;
        file.write(bytes)
    }

    pub(super) fn set_owner(_: &File, _: Option<u32>, _: u32) -> io::Result<()> {
        Ok(())
    }

    pub(super) fn set_mode(_: &File, _: u32) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
mod rename_to_new {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;
    use std::io;
    use std::path::Path;

    pub(super) fn to_new(from: &Path, to: &Path) -> io::Result<()> {
        match renameat_with(CWD, from, CWD, to, RenameFlags::NOREPLACE) {
            // Some file systems cannot check and rename in one step.
            Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => super::check_and_rename(from, to),
            other => Ok(other?),
        }
    }
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
mod rename_to_new {
    pub(super) use super::check_and_rename as to_new;
}

/// Fallback without help of the system: a file created between the check and the rename is overwritten.
fn check_and_rename(from: &Path, to: &Path) -> io::Result<()> {
    if fs::symlink_metadata(to).is_ok() {
        return Err(io::ErrorKind::AlreadyExists.into());
    }
    fs::rename(from, to)
}

/// Extended attributes, including access control lists.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
mod attributes {
    use super::{Attribute, File};
    use rustix::fs::{XattrFlags, fgetxattr, fgetxattr_query, flistxattr, flistxattr_query, fsetxattr};
    use rustix::io::Errno;
    use std::io;

    pub(super) fn all(file: &File) -> io::Result<Vec<Attribute>> {
        let mut names = vec![
            0;
            match flistxattr_query(file) {
                Err(Errno::NOTSUP) => return Ok(Vec::new()),
                size => size?,
            }
        ];
        if names.is_empty() {
            return Ok(Vec::new());
        }
        let size = flistxattr(file, &mut names[..])?;
        let names = names[..size].split(|&byte| byte == 0).filter(|name| !name.is_empty());
        names.map(|name| Ok((name.to_vec(), value(file, name)?))).collect()
    }

    fn value(file: &File, name: &[u8]) -> io::Result<Vec<u8>> {
        let mut value = vec![0; fgetxattr_query(file, name)?];
        if value.is_empty() {
            return Ok(value);
        }
        let size = fgetxattr(file, name, &mut value[..])?;
        value.truncate(size);
        Ok(value)
    }

    pub(super) fn set(file: &File, name: &[u8], value: &[u8]) -> io::Result<()> {
        Ok(fsetxattr(file, name, value, XattrFlags::empty())?)
    }
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
mod attributes {
    use super::{Attribute, File};
    use std::io;

    pub(super) fn all(_: &File) -> io::Result<Vec<Attribute>> {
        Ok(Vec::new())
    }

    pub(super) fn set(_: &File, _: &[u8], _: &[u8]) -> io::Result<()> {
        Ok(())
    }
}
