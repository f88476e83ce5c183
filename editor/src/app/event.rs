//! Events that wake the main loop, in addition to those of the window.

/// An event that another thread or the accessibility bridge puts into the window system's queue.
#[derive(Debug)]
pub(super) enum UserEvent {
    /// There are messages for the main thread.
    Wake,
    /// The system asks the program to end, by this signal.
    #[cfg_attr(not(unix), expect(dead_code, reason = "other systems have no signals"))]
    Signal(i32),
    /// An event of the accessibility bridge.
    AccessKit(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for UserEvent {
    fn from(event: accesskit_winit::Event) -> Self {
        Self::AccessKit(event)
    }
}
