//! `dragonfly --stdio FILE`: the editor as a line protocol on standard input and output.

use super::choice::{BUILT_IN, source};
use super::{Failure, tell};
use dragonfly_document::edit::LONGEST_LINE;
use dragonfly_document::protocol::Session;
use dragonfly_document::{Cancel, Editable};
use std::io::{self, BufRead, Read, Write};
use std::path::{Path, PathBuf};

/// Answers each line of standard input with a line on standard output, until the input ends.
pub(super) fn talk(file: Option<&PathBuf>) -> Result<(), Failure> {
    let editable =
        Editable::open(&source(file.map_or(Path::new(BUILT_IN), PathBuf::as_path)), &Cancel::default())?;
    for warning in &editable.warnings {
        tell(warning);
    }
    let mut session = Session::new(editable);
    let (mut input, mut output) = (io::stdin().lock(), io::stdout().lock());
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = (&mut input).take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut line);
        if read.map_err(|error| Failure::input("standard input", error))? == 0 {
            return Ok(());
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
