//! The command ffmpeg as the encoder: `ffmpeg -f yuv4mpegpipe -i - [SOUND] ARGS OUT`. It is found in the path and started without a shell.

use super::super::{Failure, tell};
use super::ffmpeg_sound::FfmpegSound;
use super::words::words;
use dragonfly_runtime::{CancelFlag, Job, JobAnswer, ThreadHandle};
use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::time::{Duration, Instant};

/// Name of the program.
const PROGRAM: &str = "ffmpeg";
/// Name of the option, for messages.
const OPTION: &str = "--external-ffmpeg";
/// Longest line of it that is shown, bytes.
const LONGEST_LINE: u64 = 4096;
/// Number of its last lines that are part of the failure.
const LAST_LINES: usize = 3;
/// Time for its last messages after its end: another program that it started may keep the pipe open.
const PATIENCE: Duration = Duration::from_secs(5);

/// A running ffmpeg.
pub(super) struct FfmpegRun {
    child: Child,
    /// Its last lines.
    messages: JobAnswer<Vec<String>>,
    _job: Job,
}

impl FfmpegRun {
    /// Starts ffmpeg with the arguments of the option, for frames and sounds. Returns it and its input. A job of `thread` shows its messages.
    pub(super) fn start(
        arguments: &str,
        output: &Path,
        sound: Option<&FfmpegSound>,
        thread: &ThreadHandle,
    ) -> Result<(Self, ChildStdin), Failure> {
        let arguments = words(arguments).map_err(|reason| Failure::input(OPTION, reason))?;
        let mut command = Command::new(PROGRAM);
        // It overwrites its output as every command of this program does, and asks no questions.
        command.args(["-hide_banner", "-nostats", "-loglevel", "warning", "-y"]);
        command.args(["-f", "yuv4mpegpipe", "-i", "-"]);
        command.args(sound.map(FfmpegSound::arguments).unwrap_or_default()).args(arguments);
        // A name that begins with a minus would be an option.
        match output.as_os_str().as_encoded_bytes().first() {
            Some(b'-') => command.arg(Path::new(".").join(output)),
            Some(_) | None => command.arg(output),
        };
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(not_started)?;
        let (Some(input), Some(errors)) = (child.stdin.take(), child.stderr.take()) else {
            return Err(Failure::Machine(format!("{PROGRAM} has no pipes")));
        };
        let work = move |_: &CancelFlag| show(BufReader::new(errors));
        let started = Job::start_oneshot(thread, "messages of ffmpeg", work);
        let (job, messages) = started.map_err(|error| {
            let _ = child.kill();
            let _ = child.wait();
            Failure::Machine(format!("no thread could be started: {error}"))
        })?;
        Ok((Self { child, messages, _job: job }, input))
    }

    /// Waits for the end of ffmpeg, whose input is closed.
    ///
    /// # Errors
    ///
    /// It failed; contains its last messages.
    pub(super) fn end(mut self) -> Result<(), Failure> {
        let status = self.child.wait();
        let status = status.map_err(|error| Failure::Machine(format!("{PROGRAM}: {error}")))?;
        let lines = self.messages.wait(Instant::now() + PATIENCE).unwrap_or_default();
        if status.success() {
            return Ok(());
        }
        let why = if lines.is_empty() { String::new() } else { format!(": {}", lines.join("; ")) };
        Err(Failure::input(OPTION, format_args!("{PROGRAM} failed ({status}){why}")))
    }

    /// Ends ffmpeg before its input is complete.
    pub(super) fn kill(mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn not_started(error: io::Error) -> Failure {
    let install = "install it (Debian: apt install ffmpeg), or leave the option out for an MP4";
    match error.kind() {
        io::ErrorKind::NotFound => {
            Failure::Machine(format!("{OPTION}: there is no {PROGRAM} in the path; {install}"))
        }
        _ => Failure::Machine(format!("{OPTION}: {PROGRAM} cannot be started: {error}")),
    }
}

/// Shows each line until the end. Returns the last ones.
fn show(mut from: impl BufRead) -> Vec<String> {
    let mut last = VecDeque::new();
    let mut line = Vec::new();
    loop {
        line.clear();
        match from.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return last.into(),
            Ok(_) => {}
        }
        let text = String::from_utf8_lossy(&line);
        let text = super::super::choice::plain(text.trim_end());
        if !text.is_empty() {
            tell(format_args!("{PROGRAM}: {text}"));
            last.push_back(text);
            if last.len() > LAST_LINES {
                last.pop_front();
            }
        }
    }
}
