//! Runs one file through all stages (reading, checks, poses) and returns what is wrong with the result.

use crate::doors::MemoryFs;
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_kit::counting::peak;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Guaranteed: stack size that is sufficient for any file. The program has eight times that.
pub(crate) const STACK: usize = 256 << 10;

/// Guaranteed: memory for a file of `size` bytes.
pub(crate) fn memory_for(size: usize) -> u64 {
    (256 << 20) + 32 * size as u64
}

/// Guaranteed: time for a file of `size` bytes.
pub(crate) fn time_for(size: usize) -> Duration {
    Duration::from_secs(1) + Duration::from_millis(100) * (size / 1_000_000) as u32
}

/// Reads `bytes` and poses the model three times. The error describes the broken guarantee; `true` means that the file
/// was read.
pub(crate) fn trial(name: &str, bytes: &[u8], door: &MemoryFs) -> Result<bool, String> {
    let start = Instant::now();
    let run = || {
        let (memory, result) = peak(|| read(name, bytes, door, &ReadOptions::default()));
        let elapsed = start.elapsed();
        if memory > memory_for(bytes.len()) {
            return Err(format!("took {memory} bytes of memory"));
        }
        // Twice the guaranteed time, because the machine may be busy with other tests.
        if elapsed > 2 * time_for(bytes.len()) {
            return Err(format!("took {elapsed:?}"));
        }
        let Ok(imported) = result else { return Ok(false) };
        let mut wrong = faults(&imported.model);
        wrong.extend(faults_of_poses(imported.model));
        if wrong.is_empty() { Ok(true) } else { Err(wrong.join(", ")) }
    };
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| Err("panicked".to_owned()))
}

/// Runs `work` on a thread with a small stack.
pub(crate) fn on_small_stack<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> std::thread::JoinHandle<T> {
    std::thread::Builder::new().stack_size(STACK).spawn(work).unwrap()
}

/// Stores a file that broke a guarantee in `target/fuzz-fail` and returns its path.
pub(crate) fn keep(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/fuzz-fail");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}
