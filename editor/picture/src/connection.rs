//! The graphics thread's connection to the window system: on X a connection of its own, else the main thread's.
//!
//! A connection to an X server is one stream. Whoever waits there for an answer, as drivers do in the graphics thread, also
//! reads the events that come before it, and puts them into a queue on this side of the stream. The main thread sleeps
//! until the stream is readable, and then it is not any more: a click or a close stays unheard until something else
//! happens. Another connection is another stream, and a window has the same number on all of them.
//!
//! Wayland keeps a queue for each reader, and the other systems have no such stream.

use super::surface::TargetWindow;
use std::fmt;
use std::sync::Arc;
use wgpu::rwh::{DisplayHandle, HandleError, HasDisplayHandle, HasWindowHandle, WindowHandle};

#[cfg(all(unix, not(target_vendor = "apple")))]
use super::x11::Own;

/// What there is none of where there is no X.
#[cfg(not(all(unix, not(target_vendor = "apple"))))]
#[derive(Clone)]
enum Own {}

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
impl Own {
    fn beside(_: &MainDisplay) -> Option<Self> {
        None
    }

    fn display_handle(&self) -> DisplayHandle<'_> {
        match *self {}
    }

    fn window_handle<'a>(&self, _: WindowHandle<'a>) -> Result<WindowHandle<'a>, HandleError> {
        match *self {}
    }
}

/// The main thread's connection to the window system.
pub type MainDisplay = Arc<dyn HasDisplayHandle + Send + Sync>;

/// A connection over which the driver may talk to the window system; clones are the same connection.
#[derive(Clone)]
pub struct Connection {
    shared: MainDisplay,
    own: Option<Own>,
}

impl Connection {
    /// Connects to where the main thread's connection leads, if that is needed and possible.
    pub fn beside(shared: MainDisplay) -> Self {
        let own = Own::beside(&shared);
        Self { shared, own }
    }
}

impl HasDisplayHandle for Connection {
    fn display_handle(&self) -> Result<DisplayHandle<'_>, HandleError> {
        self.own.as_ref().map_or_else(|| self.shared.display_handle(), |own| Ok(own.display_handle()))
    }
}

impl fmt::Debug for Connection {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Connection").field("own", &self.own.is_some()).finish_non_exhaustive()
    }
}

/// A window as the driver sees it over a connection.
pub struct ConnectedWindow {
    /// The window.
    pub window: Arc<dyn TargetWindow>,
    /// The way to it.
    pub connection: Connection,
}

impl HasDisplayHandle for ConnectedWindow {
    fn display_handle(&self) -> Result<DisplayHandle<'_>, HandleError> {
        self.connection.display_handle()
    }
}

impl HasWindowHandle for ConnectedWindow {
    fn window_handle(&self) -> Result<WindowHandle<'_>, HandleError> {
        let handle = self.window.window_handle()?;
        self.connection.own.as_ref().map_or(Ok(handle), |own| own.window_handle(handle))
    }
}
