//! Suppression of messages that libraries write to our stderr.

/// Prevents a misleading message of Mesa. Mesa asks a Wayland server for the graphics device, even
/// if no server runs, and libwayland then prints "error: XDG_RUNTIME_DIR is invalid" to stderr.
/// After a message of this program, that looks like a failure.
///
/// Only an environment variable disables this, and it must be set when the process starts. So where
/// there is no Wayland server, the program executes itself again, in the same process.
pub(super) fn about_wayland() {
    #[cfg(target_os = "linux")]
    {
        use std::env;
        use std::os::unix::process::CommandExt;
        const FORBID: &str = "NODEVICE_SELECT";
        let set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
        if set("XDG_RUNTIME_DIR") || set(FORBID) {
            return;
        }
        let Ok(program) = env::current_exe() else { return };
        let mut arguments = env::args_os();
        let mut command = std::process::Command::new(program);
        if let Some(name) = arguments.next() {
            command.arg0(name);
        }
        // `exec` returns only if it failed; then Mesa's message appears, and nothing else changes.
        let _ = command.args(arguments).env(FORBID, "1").exec();
    }
}
