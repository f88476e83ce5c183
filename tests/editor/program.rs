//! The real program, run and watched with a deadline.

use dragonfly_kit::picture::complaints;
use std::ffi::OsStr;
use std::io::Read;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Longer than any command takes on a busy machine.
const LIMIT: Duration = Duration::from_secs(60);

/// Exit code and output of one run of the program.
pub(crate) struct Outcome {
    /// The exit code; `None` when a signal ended it.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
    pub(crate) took: Duration,
}

impl Outcome {
    pub(crate) fn text(&self) -> &str {
        std::str::from_utf8(&self.stdout).expect("UTF-8 on standard output")
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.text()))
    }

    #[track_caller]
    pub(crate) fn expect(self, code: i32) -> Self {
        assert_eq!(
            self.code,
            Some(code),
            "stdout: {}\nstderr: {}",
            String::from_utf8_lossy(&self.stdout),
            self.stderr
        );
        self
    }
}

/// Returns the command that runs the program with `arguments`, without a display and with default settings.
pub(crate) fn dragonfly<I: AsRef<OsStr>>(arguments: impl IntoIterator<Item = I>) -> Command {
    start(env!("CARGO_BIN_EXE_dragonfly"), arguments)
}

/// Returns the command that runs the program with injected faults; see `tests/faulty` for its switches.
pub(crate) fn dragonfly_with_faults<I: AsRef<OsStr>>(arguments: impl IntoIterator<Item = I>) -> Command {
    start(env!("CARGO_BIN_EXE_dragonfly-faults"), arguments)
}

fn start<I: AsRef<OsStr>>(program: &str, arguments: impl IntoIterator<Item = I>) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null());
    for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DRAGONFLY_LOG"] {
        command.env_remove(variable);
    }
    command
}

/// Runs `command` to its end.
#[track_caller]
pub(crate) fn outcome(command: &mut Command) -> Outcome {
    let began = Instant::now();
    let mut child =
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    // Read while it runs: a full pipe would stop it for ever.
    let stdout = drain(child.stdout.take().expect("piped"));
    let stderr = drain(child.stderr.take().expect("piped"));
    let status = wait(&mut child, LIMIT);
    let took = began.elapsed();
    let stderr = stderr.recv().expect("the reader ends");
    let stderr = String::from_utf8_lossy(&stderr).into_owned();
    complaints::none_in(&stderr, command.get_envs().map(|(name, _)| name));
    Outcome { code: status.code(), stdout: stdout.recv().expect("the reader ends"), stderr, took }
}

/// Runs the program with `arguments` to its end.
#[track_caller]
pub(crate) fn run<I: AsRef<OsStr>>(arguments: impl IntoIterator<Item = I>) -> Outcome {
    outcome(&mut dragonfly(arguments))
}

/// Waits for the end of `child`, which is killed if it does not end within `limit`.
#[track_caller]
pub(crate) fn wait(child: &mut Child, limit: Duration) -> ExitStatus {
    let deadline = Instant::now() + limit;
    loop {
        if let Some(status) = child.try_wait().expect("our own child") {
            return status;
        }
        if Instant::now() > deadline {
            println!("{}", threads(child.id()));
            let _ = child.kill();
            let _ = child.wait();
            panic!("the program did not end within {limit:?}");
        }
        std::thread::park_timeout(Duration::from_millis(5));
    }
}

/// Describes the threads of a process that does not exit: all stacks if a debugger is installed, otherwise the kernel function each
/// thread waits in.
pub(crate) fn threads(process: u32) -> String {
    let id = process.to_string();
    let debugger = Command::new("gdb").args(["-p", &id, "-batch", "-ex", "thread apply all bt 24"]).output();
    if let Ok(output) = debugger {
        return String::from_utf8_lossy(&output.stdout).into_owned();
    }
    let tasks = std::fs::read_dir(format!("/proc/{id}/task")).into_iter().flatten().flatten();
    let told = tasks.map(|task| {
        let read = |name: &str| std::fs::read_to_string(task.path().join(name)).unwrap_or_default();
        format!("{}: {}, {}", read("comm").trim(), read("wchan"), read("syscall").trim())
    });
    told.collect::<Vec<_>>().join("\n")
}

/// Reads everything in another thread, and sends it when the end is reached.
fn drain(mut from: impl Read + Send + 'static) -> Receiver<Vec<u8>> {
    let (sender, receiver) = channel();
    let read = move || {
        let mut bytes = Vec::new();
        let _ = from.read_to_end(&mut bytes);
        let _ = sender.send(bytes);
    };
    std::thread::Builder::new().name("reader".to_owned()).spawn(read).expect("a thread");
    receiver
}
