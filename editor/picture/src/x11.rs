//! A second connection to an X server, and the number of the window on it.

#![allow(unsafe_code)]

use std::ffi::c_int;
use std::num::NonZeroU32;
use std::ptr::NonNull;
use std::sync::Arc;
use wgpu::rwh::{
    DisplayHandle, HandleError, HasDisplayHandle, RawDisplayHandle, RawWindowHandle, WindowHandle,
    XcbDisplayHandle, XcbWindowHandle,
};
use x11rb::xcb_ffi::XCBConnection;

/// A connection unknown to the main thread; clones share it.
#[derive(Clone)]
// Same name as another `OwnConnection`: one per platform, chosen by `cfg`.
pub(super) struct OwnConnection {
    connection: Arc<XCBConnection>,
    screen: c_int,
}

impl OwnConnection {
    /// Connects to the server that the environment names, as the main thread did. `None` on another window system, or
    /// when the server accepts no more connections.
    pub(super) fn beside(shared: &dyn HasDisplayHandle) -> Option<Self> {
        let RawDisplayHandle::Xlib(_) = shared.display_handle().ok()?.as_raw() else { return None };
        match XCBConnection::connect(None) {
            Ok((connection, screen)) => {
                Some(Self { connection: Arc::new(connection), screen: c_int::try_from(screen).ok()? })
            }
            Err(error) => {
                tracing::warn!(%error, "no second connection to the X server; clicks may be handled late");
                None
            }
        }
    }

    /// The connection as drivers expect it.
    pub(super) fn display_handle(&self) -> DisplayHandle<'_> {
        let connection = NonNull::new(self.connection.get_raw_xcb_connection());
        let raw = XcbDisplayHandle::new(connection, self.screen);
        // SAFETY: it is an open connection, closed when the last clone of `self` is dropped; the handle borrows from one.
        unsafe { DisplayHandle::borrow_raw(raw.into()) }
    }

    /// The same window on this connection.
    pub(super) fn window_handle<'a>(
        &self,
        handle: WindowHandle<'a>,
    ) -> Result<WindowHandle<'a>, HandleError> {
        let RawWindowHandle::Xlib(window) = handle.as_raw() else { return Err(HandleError::NotSupported) };
        let number = |number| u32::try_from(number).ok().and_then(NonZeroU32::new);
        let mut raw = XcbWindowHandle::new(number(window.window).ok_or(HandleError::Unavailable)?);
        raw.visual_id = number(window.visual_id);
        // SAFETY: the server numbers windows, the same way for all of its connections, and this one is borrowed no
        // longer than it was from the given handle.
        Ok(unsafe { WindowHandle::borrow_raw(raw.into()) })
    }
}
