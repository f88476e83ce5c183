//! The graphics thread's connection to the window system: a separate connection on X, otherwise the main thread's.
//!
//! A connection to an X server is one stream. A thread that waits there for a reply, as drivers do in the graphics
//! thread, also reads the events that precede it and puts them into a queue in the process. The main thread sleeps
//! until the stream is readable, which it no longer is: a click or a close is not handled until something else
//! happens. A second connection is a second stream, and a window has the same number on all connections.
//!
//! Wayland keeps one queue per reader, and the other systems have no such stream.

use std::fmt;
use std::sync::Arc;
use wgpu::rwh::{DisplayHandle, HandleError, HasDisplayHandle, HasWindowHandle, WindowHandle};

#[cfg(all(unix, not(target_vendor = "apple")))]
use super::x11::OwnConnection;

/// Stands for the second connection on systems without X.
#[cfg(not(all(unix, not(target_vendor = "apple"))))]
#[derive(Clone)]
enum OwnConnection {}

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
impl OwnConnection {
    fn beside(_: &dyn HasDisplayHandle) -> Option<Self> {
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

/// A connection over which the driver communicates with the window system; clones share it.
#[derive(Clone)]
pub struct Connection {
    shared: MainDisplay,
    own: Option<OwnConnection>,
}

impl Connection {
    /// Opens a second connection to the same server as the main thread's, if that is needed and possible.
    pub fn beside(shared: MainDisplay) -> Self {
        let own = OwnConnection::beside(&*shared);
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

/// A window that frames can be presented in. The window system belongs to the caller; only its handles are needed here.
/// Windows and macOS give the handle of a window only to the thread that created it, so only
/// [`SurfaceSource`](super::SurfaceSource), which stays in that thread, asks for it.
pub trait TargetWindow: HasWindowHandle + HasDisplayHandle + Send + Sync + 'static {
    /// Notifies the window system that a frame is about to be presented.
    fn pre_present_notify(&self);
}

/// A window as the driver reaches it over a connection.
pub(super) struct ConnectedWindow {
    /// The window.
    pub(super) window: Arc<dyn TargetWindow>,
    /// The connection to it.
    pub(super) connection: Connection,
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
