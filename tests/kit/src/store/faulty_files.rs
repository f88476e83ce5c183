//! A file system that fails at one call, or from one call on, as real disks rarely do.

use dragonfly_store::{Attribute, FileData, RealFiles, Vfs, VfsFile};
use std::ffi::OsString;
use std::fmt::{self, Debug, Formatter};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The error with which a call fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// An error of the device.
    Io,
    /// The disk is full.
    Full,
    /// The call was interrupted by a signal.
    Interrupted,
    /// Half of the bytes are transferred; only for reads and writes.
    Short,
    /// The file system is read-only.
    ReadOnly,
    /// Permission denied.
    Denied,
}

impl Fault {
    /// Every fault.
    pub const ALL: [Self; 6] =
        [Self::Io, Self::Full, Self::Interrupted, Self::Short, Self::ReadOnly, Self::Denied];

    /// Returns whether callers are expected to retry, so that no one notices the fault.
    pub fn is_harmless(self) -> bool {
        matches!(self, Self::Interrupted | Self::Short)
    }

    fn error(self) -> Option<io::Error> {
        use rustix::io::Errno;
        let number = match self {
            Self::Io => Errno::IO,
            Self::Full => Errno::NOSPC,
            Self::Interrupted => Errno::INTR,
            Self::Short => return None,
            Self::ReadOnly => Errno::ROFS,
            Self::Denied => Errno::ACCESS,
        };
        Some(number.into())
    }
}

/// An action of another program, performed before a chosen call.
struct Interference(Box<dyn Fn() + Send + Sync>);

impl Debug for Interference {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        out.write_str("somebody else")
    }
}

/// Number of calls made, and the range of calls that fail.
#[derive(Debug)]
struct Plan {
    calls: AtomicU64,
    /// Names of the calls made, in order.
    names: Mutex<Vec<&'static str>>,
    from: u64,
    to: u64,
    fault: Fault,
    meddling: Option<Interference>,
}

impl Plan {
    /// Counts a call. Returns `Ok(true)` when only half of it is to be done.
    fn call(&self, name: &'static str) -> io::Result<bool> {
        let call = self.calls.fetch_add(1, Ordering::Relaxed) + 1;
        self.names.lock().unwrap_or_else(PoisonError::into_inner).push(name);
        if !(self.from..=self.to).contains(&call) {
            return Ok(false);
        }
        if let Some(Interference(act)) = &self.meddling {
            act();
            return Ok(false);
        }
        self.fault.error().map_or(Ok(true), Err)
    }
}

/// The real file system, except for the calls that fail.
#[derive(Clone, Debug)]
pub struct FaultyFiles(Arc<Plan>);

impl FaultyFiles {
    /// Returns a file system in which call `number`, counted from 1, fails with `fault`.
    pub fn once(number: u64, fault: Fault) -> Self {
        Self::between(number, number, fault)
    }

    /// Returns a file system in which call `number` and all later calls fail with `fault`.
    pub fn from(number: u64, fault: Fault) -> Self {
        Self::between(number, u64::MAX, fault)
    }

    /// Returns a file system that runs `act` right before call `number`; no call fails.
    pub fn meddling(number: u64, act: impl Fn() + Send + Sync + 'static) -> Self {
        let meddling = Some(Interference(Box::new(act)));
        Self::planned(number, number, Fault::Io, meddling)
    }

    /// Returns a file system in which the calls `from..=to` fail with `fault`.
    pub fn between(from: u64, to: u64, fault: Fault) -> Self {
        Self::planned(from, to, fault, None)
    }

    fn planned(from: u64, to: u64, fault: Fault, meddling: Option<Interference>) -> Self {
        let (calls, names) = (AtomicU64::new(0), Mutex::default());
        Self(Arc::new(Plan { calls, names, from, to, fault, meddling }))
    }

    /// Returns the number of calls made so far.
    pub fn calls(&self) -> u64 {
        self.0.calls.load(Ordering::Relaxed)
    }

    /// Returns the names of the calls made so far, in order.
    pub fn names(&self) -> Vec<&'static str> {
        self.0.names.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn file(&self, file: io::Result<Box<dyn VfsFile>>) -> io::Result<Box<dyn VfsFile>> {
        Ok(Box::new(FaultyFile { file: file?, plan: Arc::clone(&self.0) }))
    }
}

#[derive(Debug)]
struct FaultyFile {
    file: Box<dyn VfsFile>,
    plan: Arc<Plan>,
}

impl Vfs for FaultyFiles {
    fn create_new(&self, path: &Path, private: bool) -> io::Result<Box<dyn VfsFile>> {
        self.0.call("create_new")?;
        self.file(RealFiles.create_new(path, private))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        self.0.call("open")?;
        self.file(RealFiles.open(path))
    }

    fn open_to_write(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        self.0.call("open_to_write")?;
        self.file(RealFiles.open_to_write(path))
    }

    fn metadata(&self, path: &Path) -> io::Result<FileData> {
        self.0.call("metadata")?;
        RealFiles.metadata(path)
    }

    fn read_link(&self, path: &Path) -> io::Result<PathBuf> {
        self.0.call("read_link")?;
        RealFiles.read_link(path)
    }

    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        self.0.call("resolve")?;
        RealFiles.resolve(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.0.call("rename")?;
        RealFiles.rename(from, to)
    }

    fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.0.call("rename_to_new")?;
        RealFiles.rename_to_new(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.0.call("remove")?;
        RealFiles.remove(path)
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.0.call("create_folder")?;
        RealFiles.create_folder(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.0.call("sync_folder")?;
        RealFiles.sync_folder(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        self.0.call("list")?;
        RealFiles.list(path)
    }
}

impl VfsFile for FaultyFile {
    fn metadata(&self) -> io::Result<FileData> {
        self.plan.call("metadata")?;
        self.file.metadata()
    }

    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        let whole = if self.plan.call("read_at")? { bytes.len().div_ceil(2) } else { bytes.len() };
        self.file.read_at(&mut bytes[..whole], offset)
    }

    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        match self.plan.call("write_at") {
            Ok(short) => {
                let whole = if short { bytes.len().div_ceil(2) } else { bytes.len() };
                self.file.write_at(&bytes[..whole], offset)
            }
            // A failing disk has often completed a part of the write.
            Err(error) if error.kind() != io::ErrorKind::Interrupted => {
                let _ = self.file.write_at(&bytes[..bytes.len() / 3], offset);
                Err(error)
            }
            Err(error) => Err(error),
        }
    }

    fn set_size(&self, size: u64) -> io::Result<()> {
        self.plan.call("set_size")?;
        self.file.set_size(size)
    }

    fn sync_data(&self) -> io::Result<()> {
        self.plan.call("sync_data")?;
        self.file.sync_data()
    }

    fn sync_all(&self) -> io::Result<()> {
        self.plan.call("sync_all")?;
        self.file.sync_all()
    }

    fn try_lock(&self) -> io::Result<bool> {
        self.plan.call("try_lock")?;
        self.file.try_lock()
    }

    fn unlock(&self) -> io::Result<()> {
        self.plan.call("unlock")?;
        self.file.unlock()
    }

    fn set_owner(&self, owner: Option<u32>, group: u32) -> io::Result<()> {
        self.plan.call("set_owner")?;
        self.file.set_owner(owner, group)
    }

    fn set_mode(&self, mode: u32) -> io::Result<()> {
        self.plan.call("set_mode")?;
        self.file.set_mode(mode)
    }

    fn attributes(&self) -> io::Result<Vec<Attribute>> {
        self.plan.call("attributes")?;
        self.file.attributes()
    }

    fn set_attribute(&self, name: &[u8], value: &[u8]) -> io::Result<()> {
        self.plan.call("set_attribute")?;
        self.file.set_attribute(name, value)
    }
}
