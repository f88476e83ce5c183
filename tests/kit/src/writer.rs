//! A separate process that works as fast as it can and reports what is done, to be killed or to have its power cut.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Time after which the process ends by itself: longer than it takes to start on a busy machine.
pub const LIMIT: Duration = Duration::from_secs(30);

/// The running process.
pub struct Writer {
    child: Child,
    lines: Receiver<String>,
    early: Vec<String>,
}

/// Returns nanoseconds since 1970 of the wall clock, which two programs share.
pub fn nanoseconds(time: SystemTime) -> u128 {
    time.duration_since(UNIX_EPOCH).expect("after 1970").as_nanos()
}

/// Everything the process reported as done.
#[derive(Debug, Default)]
pub struct WriterReport {
    /// Number of edits that counted as done.
    pub edits: u32,
    /// Number of edits reported as synced to the disk.
    pub synced: u32,
    /// Number of edits in the file that was saved last.
    pub saved: u32,
    /// Number of edits reported as synced after the end of the accepted period.
    pub late: u32,
    /// Time at which each edit was done: number and [`nanoseconds`].
    pub times: Vec<(u32, u128)>,
    /// The error that the process reported.
    pub complaint: Option<String>,
}

/// The state of the disk after the process was stopped.
#[derive(Debug)]
pub struct Found {
    /// Number of edits found in the journal.
    pub edits: u32,
    /// Number of edits found in the saved file.
    pub saved: u32,
}

fn program() -> std::path::PathBuf {
    std::env::current_exe().expect("a running test has a file")
}

impl Writer {
    /// Starts a test of this executable in a new process, which reports its work. `environment` selects what it does.
    pub fn of(test: &str, environment: &[(&str, &OsStr)]) -> Self {
        Self::run_test(Command::new(program()).envs(environment.iter().copied()), test)
    }

    fn run_test(command: &mut Command, test: &str) -> Self {
        let mut child = command
            .args([test, "--exact", "--nocapture", "--test-threads=1"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the test's own file can be started");
        let out = BufReader::new(child.stdout.take().expect("piped"));
        let (sender, lines) = channel();
        let read = move || {
            for line in out.lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        };
        std::thread::Builder::new().name("reader".to_owned()).spawn(read).expect("a thread");
        Self { child, lines, early: Vec::new() }
    }

    /// Waits until the first edit is done.
    #[track_caller]
    pub fn working(&mut self) {
        let done = |line: &str| ["e ", "s ", "x "].iter().any(|kind| line.starts_with(kind));
        while !self.early.last().is_some_and(|line| done(line)) {
            self.early.push(self.lines.recv_timeout(LIMIT).expect("it works"));
        }
    }

    /// Returns the process id.
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Kills the process and returns everything that it reported.
    pub fn kill(self) -> WriterReport {
        self.kill_and_read_until(u128::MAX)
    }

    /// Waits until the process has been killed by the caller. Returns everything that it reported.
    pub fn ended(self) -> WriterReport {
        self.end_and_read_until(u128::MAX)
    }

    /// Kills the process and returns what it reported as done before `end`, in [`nanoseconds`].
    pub fn kill_and_read_until(mut self, end: u128) -> WriterReport {
        self.child.kill().expect("it runs");
        self.end_and_read_until(end)
    }

    fn end_and_read_until(mut self, end: u128) -> WriterReport {
        self.child.wait().expect("it ends");
        let mut said = WriterReport::default();
        // Lines that are still in the pipe were written before the kill.
        for line in self.early.drain(..).chain(self.lines.iter()) {
            let Some((rest, time)) = line.rsplit_once(' ') else { continue };
            let Some((kind, rest)) = rest.split_once(' ') else { continue };
            if kind == "x" {
                said.complaint = Some(rest.to_owned());
            }
            let (Ok(number), Ok(time)) = (rest.parse(), time.parse()) else { continue };
            if time >= end {
                if kind == "y" || kind == "s" {
                    said.late = number;
                }
                continue;
            }
            match kind {
                "e" => {
                    said.edits = number;
                    said.times.push((number, time));
                }
                "y" => said.synced = number,
                "s" => said.saved = number,
                _ => {}
            }
        }
        said
    }
}
