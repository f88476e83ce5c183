//! Runs the child: starts it, feeds it, waits for its answer, ends it.

use crate::answer::{broken, read_answer};
use crate::child::{ARGUMENTS, CPU_SECONDS};
use crate::request::ParseRequest;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::CANCEL_EVERY;
use dragonfly_runtime::Job;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Longest time that a child may take, on a machine that is busy with other things. Its time on the processor is limited to
/// [`CPU_SECONDS`].
const DEADLINE: Duration = Duration::from_secs(90);

/// Time between two looks at the cancel flag.
const POLL: Duration = Duration::from_millis(5);

/// Time between two looks at a child that is about to end.
const ENDING: Duration = Duration::from_micros(200);

/// Bytes that are read from the child at once.
const CHUNK: usize = 1 << 16;

/// Starts a program as the parser of FBX files.
#[derive(Clone, Debug)]
pub struct FbxParser {
    program: PathBuf,
    deadline: Duration,
}

/// Why the answer of a child ended.
enum AnswerEnd {
    /// The child closed its output.
    Complete(Vec<u8>),
    /// The answer is longer than it may be.
    Flood,
    Failed(io::Error),
}

/// A child that does not outlive its owner.
struct KilledChild(Child);

impl Drop for KilledChild {
    fn drop(&mut self) {
        // Fails only if the child has ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl FbxParser {
    /// Returns a parser that starts `program`, which must call [`child::serve`](crate::child::serve).
    pub fn new(program: impl Into<PathBuf>) -> Self {
        Self { program: program.into(), deadline: DEADLINE }
    }

    /// Returns a parser that starts the running program.
    pub fn this_program() -> Result<Self, ImportError> {
        // The program that runs, also after its file was replaced.
        #[cfg(target_os = "linux")]
        let program = Ok::<_, io::Error>(PathBuf::from("/proc/self/exe"));
        #[cfg(not(target_os = "linux"))]
        let program = std::env::current_exe();
        program.map(Self::new).map_err(|error| broken(format!("the parser cannot be started: {error}")))
    }

    /// Sets the longest time that a child may take.
    pub fn with_deadline(self, deadline: Duration) -> Self {
        Self { deadline, ..self }
    }

    /// Parses the bytes of a file in a child process and returns the model.
    ///
    /// Blocks until the child has ended, at most until the deadline; polls the cancel flag of the import. A child that
    /// crashes, hangs, floods its output or sends anything but an answer is an error of the file.
    pub fn read(&self, bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
        context.charge(&Place::File, bytes.len() as u64)?;
        let memory = context.remaining_memory();
        let request = ParseRequest::new(memory, context.conventions());
        let answer = self.run(request, bytes, memory / 2, context)?;
        context.progress(0.8)?;
        context.charge(&Place::File, answer.len() as u64)?;
        read_answer(&answer, context)
    }

    /// Returns the output of a child.
    fn run(
        &self,
        request: ParseRequest,
        bytes: &[u8],
        limit: u64,
        context: &ImportContext<'_>,
    ) -> Result<Vec<u8>, ImportError> {
        let failed = |error: io::Error| broken(format!("the parser cannot be started: {error}"));
        let until = Instant::now() + self.deadline;
        let mut child = KilledChild(self.start().map_err(failed)?);
        let (Some(input), Some(output)) = (child.0.stdin.take(), child.0.stdout.take()) else {
            return Err(broken("the parser has no input or output"));
        };
        let file = bytes.to_vec();
        Job::start_detached("fbx input", move || feed(input, request, &file)).map_err(failed)?;
        let (sender, receiver) = flume::bounded(1);
        // The receiver is gone if the import was cancelled.
        Job::start_detached("fbx output", move || _ = sender.send(collect(output, limit))).map_err(failed)?;
        let answer = loop {
            match receiver.recv_timeout(POLL) {
                Ok(answer) => break answer,
                Err(flume::RecvTimeoutError::Timeout) => self.still(until, context)?,
                Err(flume::RecvTimeoutError::Disconnected) => return Err(broken("its answer was lost")),
            }
        };
        let answer = match answer {
            AnswerEnd::Complete(answer) => answer,
            AnswerEnd::Flood => {
                let what = "bytes in the answer of the parser";
                return Err(ImportError::TooLarge { place: Place::File, what, size: limit + 1, limit });
            }
            AnswerEnd::Failed(error) => return Err(broken(format!("its answer cannot be read: {error}"))),
        };
        // Nothing arrives here: only its timeout is used.
        let (_silent, pause) = flume::bounded::<()>(0);
        let status = loop {
            match child.0.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) => self.still(until, context)?,
                Err(error) => return Err(broken(format!("its end is unknown: {error}"))),
            }
            // The output is closed, so that the end is a matter of microseconds.
            let _ = pause.recv_timeout(ENDING);
        };
        if status.success() { Ok(answer) } else { Err(broken(reason_of(status))) }
    }

    /// Starts the child with nothing but two pipes: no environment, no messages.
    fn start(&self) -> io::Result<Child> {
        let mut command = Command::new(&self.program);
        command
            .args(ARGUMENTS)
            .env_clear()
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        // Without it no program of Windows starts.
        #[cfg(windows)]
        if let Some(root) = std::env::var_os("SystemRoot") {
            command.env("SystemRoot", root);
        }
        command.spawn()
    }

    /// Returns an error if the import was cancelled, or takes too long.
    fn still(&self, until: Instant, context: &ImportContext<'_>) -> Result<(), ImportError> {
        context.work(CANCEL_EVERY)?;
        if Instant::now() < until {
            return Ok(());
        }
        Err(broken(format!("parsing takes longer than {} s", self.deadline.as_secs_f32())))
    }
}

/// Returns why a child ended without success.
fn reason_of(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        const SIGKILL: i32 = 9;
        const SIGXCPU: i32 = 24;
        match status.signal() {
            Some(SIGXCPU | SIGKILL) => {
                return format!("parsing takes longer than {CPU_SECONDS} s on the processor, or was ended");
            }
            Some(signal) => return format!("the parser crashed with signal {signal}"),
            None => {}
        }
    }
    format!("the parser crashed ({status})")
}

/// Writes the request and the file. The child may end before it has read all of it.
fn feed(mut input: ChildStdin, request: ParseRequest, file: &[u8]) {
    let written = input.write_all(&request.to_bytes()).and_then(|()| input.write_all(file));
    if let Err(error) = written {
        tracing::debug!("the parser of FBX did not read the whole file: {error}");
    }
}

/// Reads at most `limit` bytes of the answer.
fn collect(mut output: ChildStdout, limit: u64) -> AnswerEnd {
    let mut answer = Vec::new();
    let mut chunk = vec![0; CHUNK];
    loop {
        match output.read(&mut chunk) {
            Ok(0) => return AnswerEnd::Complete(answer),
            Ok(read) => {
                if answer.len() as u64 + read as u64 > limit || answer.try_reserve(read).is_err() {
                    return AnswerEnd::Flood;
                }
                answer.extend_from_slice(&chunk[..read]);
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return AnswerEnd::Failed(error),
        }
    }
}
