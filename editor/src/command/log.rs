//! Logging to stderr: warnings, and more if `DRAGONFLY_LOG` is set.

use std::panic;
use tracing_subscriber::EnvFilter;

/// Environment variable with the log filter.
const VARIABLE: &str = "DRAGONFLY_LOG";

/// Default filter: warnings of this program, and only errors of its libraries, whose warnings do not help the user. Errors
/// of the driver are reported as errors of our own, with advice.
const USUAL: &str = "error,wgpu_hal=off,dragonfly=warn,dragonfly_runtime=warn,dragonfly_anim=warn";

/// Installs the log subscriber that writes to stderr. Does nothing if one is already installed.
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

/// Installs a panic hook that only logs at debug level. The code that catches the panic reports it to the user.
///
/// Panics are caught in every thread: in the main thread by [`super::main`], in the others by the runtime, and during the drawing
/// of a frame by the graphics thread, where a panic of the driver is treated as a lost device.
pub(super) fn quiet_panics() {
    panic::set_hook(Box::new(|panic| {
        let thread = std::thread::current();
        let place = panic.location().map_or_else(String::new, ToString::to_string);
        tracing::debug!(
            thread = thread.name().unwrap_or("unnamed"),
            place,
            backtrace = %std::backtrace::Backtrace::capture(),
            "panic: {}",
            panic.payload_as_str().unwrap_or("no reason given")
        );
    }));
}
