//! The program; all of it is in the library, where tests and benches can reach it.

#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    dragonfly::command::main()
}
