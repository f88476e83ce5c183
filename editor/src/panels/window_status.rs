//! Status of the window and the graphics device, as the panels show it.

/// State of the graphics device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeviceStatus {
    /// The device is being created.
    #[default]
    Starting,
    /// The device draws.
    Ready {
        /// Adapter, backend, driver.
        adapter: String,
    },
    /// The device was lost too often and waits for the user.
    Paused {
        /// The driver's message.
        reason: String,
    },
}

/// Graphics device, frame time and full screen.
#[derive(Debug, Default)]
pub struct WindowStatus {
    device: DeviceStatus,
    frame_time: Option<f32>,
    full_screen: bool,
}

impl WindowStatus {
    /// Returns the state of the graphics device.
    pub fn device(&self) -> &DeviceStatus {
        &self.device
    }

    /// Sets the state of the graphics device.
    pub fn set_device(&mut self, device: DeviceStatus) {
        self.device = device;
    }

    /// Returns the duration of the last frame, milliseconds.
    pub fn frame_time(&self) -> Option<f32> {
        self.frame_time
    }

    /// Sets the duration of the last frame, milliseconds.
    pub fn set_frame_time(&mut self, milliseconds: f32) {
        self.frame_time = Some(milliseconds);
    }

    /// Returns whether the window fills the screen.
    pub fn is_full_screen(&self) -> bool {
        self.full_screen
    }

    /// Switches between the whole screen and a window. Returns whether the window is to fill the screen now.
    pub fn toggle_full_screen(&mut self) -> bool {
        self.full_screen = !self.full_screen;
        self.full_screen
    }
}
