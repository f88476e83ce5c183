//! One file through everything the program does with it: read, checked, posed. The answer is what is wrong with that.

use crate::doors::MemoryFs;
use crate::soundness::{faults, faults_of_poses};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_kit::counting::peak;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Promised: stack that is enough for any file. The program has eight times as much.
pub(crate) const STACK: usize = 256 << 10;

/// Promised: memory for a file of `size` bytes.
pub(crate) fn memory_for(size: usize) -> u64 {
    (256 << 20) + 32 * size as u64
}

/// Promised: time for a file of `size` bytes.
pub(crate) fn time_for(size: usize) -> Duration {
    Duration::from_secs(1) + Duration::from_millis(100) * (size / 1_000_000) as u32
}

/// Reads `bytes` and poses the model three times; an error says how a promise was broken. `true`: it was read.
pub(crate) fn trial(name: &str, bytes: &[u8], door: &MemoryFs) -> Result<bool, String> {
    let start = Instant::now();
    let run = || {
        let (memory, result) = peak(|| read(name, bytes, door, &ReadOptions::default()));
        let elapsed = start.elapsed();
        if memory > memory_for(bytes.len()) {
            return Err(format!("took {memory} bytes of memory"));
        }
        // Twice as long as promised: the machine may be busy with other tests.
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

/// Keeps a file that broke a promise where people find it; where that is.
pub(crate) fn keep(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/fuzz-fail");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}
