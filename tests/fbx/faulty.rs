//! The parser's process with planted faults, for tests. A file that starts with `FAULT` and a word misbehaves inside the cage;
//! any other file is parsed.

#![forbid(unsafe_code)]

use std::io::Write;
use std::process::{Command, ExitCode};

/// Exit code after attempts to escape that were all refused.
const REFUSED: u8 = 40;

/// Exit code after an attempt that succeeded.
const ESCAPED: u8 = 41;

fn main() -> ExitCode {
    // Inside the cage it cannot be asked for.
    #[cfg(unix)]
    let parent = std::os::unix::process::parent_id();
    #[cfg(not(unix))]
    let parent = 0;
    dragonfly_fbx::child::serve_with(|bytes, missing| {
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(1000)]).into_owned();
        let (word, argument) =
            text.strip_prefix("FAULT ")?.trim().split_once(' ').unwrap_or((text[6..].trim(), ""));
        Some(if word == "cage" { judge_cage(missing) } else { fail(word, argument, parent) })
    })
}

fn fail(word: &str, argument: &str, parent: u32) -> ExitCode {
    match word {
        "abort" => std::process::abort(),
        "panic" => panic!("a planted panic"),
        "overflow" => ExitCode::from(deeper(1) as u8),
        "hang" => loop {
            std::hint::spin_loop();
        },
        "memory" => {
            let mut all: Vec<Vec<u8>> = Vec::new();
            loop {
                all.push(vec![1; 16 << 20]);
            }
        }
        "flood" => {
            let block = vec![7; 1 << 20];
            while std::io::stdout().write_all(&block).is_ok() {}
            ExitCode::SUCCESS
        }
        "garbage" => {
            let _ = std::io::stdout().write_all(b"this is no answer");
            let _ = std::io::stdout().flush();
            ExitCode::SUCCESS
        }
        "silent" => ExitCode::SUCCESS,
        "open" => judge(std::fs::File::open(argument)),
        "list" => judge(std::fs::read_dir(argument)),
        "write" => judge(std::fs::write(argument, b"x")),
        "delete" => judge(std::fs::remove_file(argument)),
        "connect" => judge(std::net::TcpStream::connect(argument)),
        "listen" => judge(std::net::TcpListener::bind("127.0.0.1:0")),
        "spawn" => judge(Command::new("/bin/true").spawn()),
        "thread" => judge(std::thread::Builder::new().spawn(|| ())),
        #[cfg(unix)]
        "kill" => {
            let parent = rustix::process::Pid::from_raw(parent as i32).expect("a process");
            judge(rustix::process::kill_process(parent, rustix::process::Signal::WINCH))
        }
        #[cfg(unix)]
        "limit" => {
            use rustix::process::{Resource, Rlimit, setrlimit};
            judge(setrlimit(Resource::Nofile, Rlimit { current: Some(64), maximum: Some(64) }))
        }
        other => panic!("{other}, started by {parent}: an unknown fault"),
    }
}

/// Returns the exit code for the protections that are missing: an old kernel may lack Landlock, and nothing else.
fn judge_cage(missing: &[String]) -> ExitCode {
    let is_old = |reason: &String| reason.contains("not in this kernel") || reason.contains("a part only");
    judge(if missing.iter().all(is_old) { Err(()) } else { Ok(()) })
}

/// Returns the exit code for the result of an attempt.
fn judge<T, E>(result: Result<T, E>) -> ExitCode {
    ExitCode::from(if result.is_ok() { ESCAPED } else { REFUSED })
}

/// Calls itself until the stack ends.
fn deeper(depth: u64) -> u64 {
    let block = std::hint::black_box([depth; 512]);
    if depth == u64::MAX { 0 } else { deeper(depth + 1) + block[(depth % 512) as usize] }
}
