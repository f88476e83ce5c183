//! The child process: closes the cage, reads the file, writes the answer.

mod cage;

use crate::answer::{CageReport, answer};
use crate::request::ParseRequest;
use dragonfly_anim::format::{ByteBudget, ImportContext, NoFiles, ReadOptions};
use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::process::ExitCode;

/// Arguments with which a program becomes the parser.
pub const ARGUMENTS: [&str; 2] = ["--parse", "fbx"];

/// Seconds on the processor that a child may use.
pub(crate) const CPU_SECONDS: u64 = 20;

/// Returns whether a program with these arguments, the first of which is its name, was started as a child. To be checked
/// before anything else is done, since the child does not have the rights for it.
pub fn is_requested(arguments: impl IntoIterator<Item = OsString>) -> bool {
    arguments.into_iter().skip(1).eq(ARGUMENTS.map(OsString::from))
}

/// Serves one request: parses the file on the standard input and writes the answer to the standard output.
pub fn serve() -> ExitCode {
    serve_with(|_, _| None)
}

/// Like [`serve`], and calls `inside` with the bytes of the file, and the protections that are missing, when the cage is
/// closed; a code that it returns ends the child instead of an answer. For tests, which plant faults there.
pub fn serve_with(inside: impl FnOnce(&[u8], &[String]) -> Option<ExitCode>) -> ExitCode {
    run(inside).unwrap_or(ExitCode::from(3))
}

fn run(inside: impl FnOnce(&[u8], &[String]) -> Option<ExitCode>) -> io::Result<ExitCode> {
    let mut input = io::stdin().lock();
    // The request comes from the parent, the bytes after it from anyone.
    let request = ParseRequest::read(&mut input)?;
    let cage: CageReport = cage::close(request.memory);
    let mut bytes = Vec::new();
    input.read_to_end(&mut bytes)?;
    if let Some(code) = inside(&bytes, &cage.missing) {
        return Ok(code);
    }
    let options = ReadOptions {
        budget: ByteBudget::at_most(request.memory),
        conventions: request.conventions(),
        ..ReadOptions::default()
    };
    options.budget.input(bytes.len());
    let context = ImportContext::new(&NoFiles, &options);
    let answer = answer(&bytes, context, cage);
    let mut output = io::stdout().lock();
    output.write_all(&answer)?;
    output.flush()?;
    Ok(ExitCode::SUCCESS)
}
