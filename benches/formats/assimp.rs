//! assimp, as a process that reads files and answers with the time: compiled from `assimp.cc` where the library is installed.

use dragonfly_kit::figures::root;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The running process.
pub(crate) struct Assimp {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Assimp {
    /// Compiles and starts it in `folder`; `None` where the library or a compiler is missing.
    pub(crate) fn start(folder: &Path) -> Option<Self> {
        let flags = Command::new("pkg-config").args(["--cflags", "--libs", "assimp"]).output().ok()?;
        let flags = String::from_utf8_lossy(&flags.stdout).into_owned();
        let program = folder.join("assimp");
        let source = root().join("benches/formats/assimp.cc");
        let built = Command::new("g++")
            .args(["-std=c++17", "-O2", "-o"])
            .args([&program, &source])
            .args(flags.split_whitespace())
            .status();
        built.ok().filter(|status| status.success())?;
        let mut child = Command::new(&program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
        let (input, output) = (child.stdin.take()?, BufReader::new(child.stdout.take()?));
        Some(Self { child, input, output })
    }

    /// Returns the milliseconds that it takes to read a file; `None` if it cannot.
    pub(crate) fn read(&mut self, path: &Path) -> Option<f64> {
        writeln!(self.input, "{}", path.display()).ok()?;
        self.input.flush().ok()?;
        let mut line = String::new();
        self.output.read_line(&mut line).ok()?;
        line.trim().parse::<f64>().ok().map(|nanoseconds| nanoseconds / 1e6)
    }
}

impl Drop for Assimp {
    fn drop(&mut self) {
        // Fails only if the process has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
