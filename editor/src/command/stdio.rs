//! `dragonfly --stdio FILE`: the editor as a line protocol on standard input and output.

use super::choice::{BUILT_IN, source};
use super::{Failure, tell};
use dragonfly_document::edit::LONGEST_LINE;
use dragonfly_document::protocol::Session;
use dragonfly_document::{Cancel, Editable};
use dragonfly_store::{Autosave, RealFiles};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Value of `--journal` with which nothing is recorded.
const OFF: &str = "off";

/// Returns the folder of journals that the arguments name; `None` where nothing is recorded.
fn journals(journal: Option<PathBuf>, autosave: Option<PathBuf>) -> Option<Autosave> {
    match journal {
        Some(off) if off == Path::new(OFF) => None,
        folder => Autosave::new(Arc::new(RealFiles), folder.or(autosave)),
    }
}

/// Answers each line of standard input with a line on standard output, until the input ends. Edits of a file are recorded in a
/// journal before they are answered.
pub(super) fn talk(
    file: Option<&PathBuf>,
    journal: Option<PathBuf>,
    autosave: Option<PathBuf>,
) -> Result<(), Failure> {
    let editable =
        Editable::open(&source(file.map_or(Path::new(BUILT_IN), PathBuf::as_path)), &Cancel::default())?;
    for warning in &editable.warnings {
        tell(warning);
    }
    let mut session = Session::recorded(editable, journals(journal, autosave));
    // The input has its own buffer, which shows whether further requests wait.
    let (mut input, mut output) = (BufReader::new(io::stdin().lock()), io::stdout().lock());
    let mut line = Vec::new();
    loop {
        session.trouble().iter().for_each(tell);
        line.clear();
        let read = (&mut input).take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut line);
        if read.map_err(|error| Failure::input("standard input", error))? == 0 {
            return session.end().map_err(Failure::Machine);
        }
        let answer = if line.len() > LONGEST_LINE {
            skip_line(&mut input).map_err(|error| Failure::input("standard input", error))?;
            Some(format!("{{\"error\":\"a line is longer than {LONGEST_LINE} bytes\"}}"))
        } else {
            match std::str::from_utf8(&line) {
                Ok(text) => session.answer(text),
                Err(_) => Some("{\"error\":\"the line is not UTF-8 text\"}".to_owned()),
            }
        };
        // The client waits for the answer, so it is flushed immediately.
        let said = answer.map_or(Ok(()), |answer| writeln!(output, "{answer}").and_then(|()| output.flush()));
        match said {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Err(Failure::OutputClosed),
            Err(error) => return Err(Failure::Machine(format!("standard output: {error}"))),
            Ok(()) if input.buffer().is_empty() => session.keep(),
            Ok(()) => {}
        }
    }
}

/// Skips the rest of a line.
fn skip_line(input: &mut impl BufRead) -> io::Result<()> {
    loop {
        let buffer = input.fill_buf()?;
        let (end, length) = match buffer.iter().position(|&byte| byte == b'\n') {
            Some(at) => (true, at + 1),
            None => (buffer.is_empty(), buffer.len()),
        };
        input.consume(length);
        if end {
            return Ok(());
        }
    }
}
