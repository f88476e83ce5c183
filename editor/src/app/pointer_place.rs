//! The place of the pointer, asked for where no event reports it: winit reports that files were dropped, but not where.

use winit::window::Window;

/// Returns where the pointer is, physical pixels from the top left of the content of the window. `None` where the window system is not asked.
pub(super) fn of(window: &Window) -> Option<[f32; 2]> {
    system::pointer(window)
}

#[cfg(all(unix, not(target_vendor = "apple")))]
mod system {
    use wgpu::rwh::{HasWindowHandle, RawWindowHandle};
    use winit::window::Window;
    use x11rb::protocol::xproto::ConnectionExt;

    /// Asks the X server over a connection of its own: the events of the window's one belong to winit.
    pub(super) fn pointer(window: &Window) -> Option<[f32; 2]> {
        let RawWindowHandle::Xlib(handle) = window.window_handle().ok()?.as_raw() else { return None };
        let id = u32::try_from(handle.window).ok()?;
        let (connection, _) = x11rb::connect(None).ok()?;
        let reply = connection.query_pointer(id).ok()?.reply().ok()?;
        reply.same_screen.then(|| [f32::from(reply.win_x), f32::from(reply.win_y)])
    }
}

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
mod system {
    use winit::window::Window;

    /// The window system is not asked.
    pub(super) fn pointer(_window: &Window) -> Option<[f32; 2]> {
        None
    }
}
