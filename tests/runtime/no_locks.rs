//! R8: the runtime has a single kind of lock, which cannot be held, so no two can be taken in the wrong order.

use std::fs;
use std::path::Path;

/// Names that would bring a lock, or a wait for one, into the runtime.
const LOCKS: &[&str] = &[
    "Mutex",
    "RwLock",
    "Condvar",
    "OnceLock",
    "LazyLock",
    "OnceCell",
    "Barrier",
    "mpsc",
    "static mut",
    ".recv(",
    "recv_timeout",
    "recv_deadline",
    "thread::sleep",
    "thread::scope",
    "parking_lot",
];

/// Returns the lines of the runtime that name a lock, outside comments, as `file: line`.
fn locks_in(source: &str, file: &str) -> Vec<String> {
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    let found = code.filter(|line| LOCKS.iter().any(|lock| line.contains(lock)));
    found.map(|line| format!("{file}: {}", line.trim())).collect()
}

/// The only file that may name a lock. It hands out a closure's argument, never a guard.
const LOCK_FILE: &str = "sync.rs";

/// The only file that may wait for a channel: a thread that ends waits for its jobs, and a caller may wait for
/// the answer of a job. Both waits have a deadline.
const JOB_FILE: &str = "job.rs";

#[test]
fn the_runtime_has_a_single_lock_and_never_returns_a_guard_of_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = 0;
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        files += 1;
        let source = fs::read_to_string(path).unwrap();
        if name == LOCK_FILE {
            assert_eq!(source.matches(".lock()").count(), 2, "{name}: one lock, and its stand-in");
            assert!(!source.contains("Guard"), "{name}: a guard would let the lock be held");
        } else if name == JOB_FILE {
            assert_eq!(source.matches(".recv_deadline(").count(), 2, "{name}: waits somewhere else too");
            found.extend(locks_in(&source.replace(".recv_deadline(", ""), &name));
        } else {
            found.extend(locks_in(&source, &name));
        }
    }
    assert!(files > 10, "looked in the wrong folder");
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn a_planted_lock_is_found() {
    let planted = "// a Mutex in a comment\nlet shared = Arc::new(Mutex::new(0));\n";
    assert_eq!(locks_in(planted, "x.rs"), ["x.rs: let shared = Arc::new(Mutex::new(0));"]);
}

#[test]
fn nothing_in_the_runtime_is_unsafe() {
    let lib = include_str!("../../runtime/src/lib.rs");
    assert!(lib.contains("#![forbid(unsafe_code)]"));
}
