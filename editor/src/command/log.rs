//! What the program says about itself while it runs: warnings, and more when `DRAGONFLY_LOG` asks.

use std::panic;
use tracing_subscriber::EnvFilter;

/// Chooses how much is told.
const VARIABLE: &str = "DRAGONFLY_LOG";

/// Warnings of this program; of the libraries below it only errors, as theirs mean little to a person. What the driver
/// says comes back as errors of our own, with what to do about it.
const USUAL: &str = "error,wgpu_hal=off,dragonfly=warn,dragonfly_runtime=warn,dragonfly_anim=warn";

/// Sends what is traced to stderr. Does nothing when somebody already listens.
pub(super) fn start() {
    let filter = std::env::var(VARIABLE)
        .ok()
        .and_then(|wanted| EnvFilter::try_new(wanted).ok())
        .unwrap_or_else(|| EnvFilter::new(USUAL));
    let terminal = std::io::IsTerminal::is_terminal(&std::io::stderr());
    let _ = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(terminal)
        .try_init();
}

/// Lets a panic be told once, by whoever catches it, instead of also at once by the standard library.
///
/// Every thread of the program is guarded: the main thread by [`super::main`], the others by the runtime, the drawing
/// of a frame by the graphics thread, where a panic of the driver means no more than "the device is lost".
pub(super) fn quiet_panics() {
    panic::set_hook(Box::new(|panic| {
        let thread = std::thread::current();
        let place = panic.location().map_or_else(String::new, ToString::to_string);
        tracing::debug!(
            thread = thread.name().unwrap_or("unnamed"),
            place,
            backtrace = %std::backtrace::Backtrace::capture(),
            "panic: {}",
            panic.payload_as_str().unwrap_or("it did not say why")
        );
    }));
}
