//! The window of the program as a target for frames.

use dragonfly_picture::TargetWindow;
use std::sync::Arc;
use winit::raw_window_handle::{DisplayHandle, HandleError, HasDisplayHandle, HasWindowHandle, WindowHandle};
use winit::window::Window;

/// A window of winit that frames are presented in. Its handles are asked for in the main thread only.
pub(super) struct WinitWindow(pub(super) Arc<Window>);

impl HasDisplayHandle for WinitWindow {
    fn display_handle(&self) -> Result<DisplayHandle<'_>, HandleError> {
        self.0.display_handle()
    }
}

impl HasWindowHandle for WinitWindow {
    fn window_handle(&self) -> Result<WindowHandle<'_>, HandleError> {
        self.0.window_handle()
    }
}

impl TargetWindow for WinitWindow {
    fn pre_present_notify(&self) {
        self.0.pre_present_notify();
    }
}
