//! Keeping other people's libraries from speaking on our stderr.

/// Mesa asks a Wayland server which graphics device to take, even where there is none, and the library it asks with then
/// complains on stderr ("error: XDG_RUNTIME_DIR is invalid"). Below a message of ours that looks like a failure.
///
/// Its question can be forbidden by the environment alone, and that must be so when the process starts. So where
/// there is no Wayland to ask, the program starts itself once more; it stays the same process.
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
        // Returns only when it failed, and then no more than silence is lost.
        let _ = command.args(arguments).env(FORBID, "1").exec();
    }
}
