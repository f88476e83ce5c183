//! The reasons why nothing can be drawn.

/// Reasons why nothing can be drawn.
#[derive(Debug, thiserror::Error)]
pub enum GraphicsError {
    /// The computer has no usable graphics adapter.
    #[error("no graphics adapter: {0}; install a Vulkan driver (Debian: mesa-vulkan-drivers)")]
    NoAdapter(String),
    /// The adapter lacks a feature that drawing needs.
    #[error("the graphics adapter {adapter} cannot {lack}")]
    Unsuitable {
        /// Name of the adapter.
        adapter: String,
        /// The missing feature.
        lack: &'static str,
    },
    /// The adapter could not create a device.
    #[error("the graphics adapter could not create a device: {0}")]
    NoDevice(String),
    /// The window cannot be drawn into.
    #[error("the window cannot be drawn into: {0}")]
    NoSurface(String),
    /// The requested image is larger than the device supports, or empty.
    #[error("an image of {width} × {height} pixels is too large or empty; the device supports up to {limit}")]
    PictureSize {
        /// Requested width, pixels.
        width: u32,
        /// Requested height, pixels.
        height: u32,
        /// Longest supported side, pixels.
        limit: u32,
    },
    /// The device reported errors in this program's calls.
    #[error("{0} unexpected graphics errors; run with RUST_LOG=error to see them")]
    Refused(u32),
    /// The device was lost while drawing and could not be created again.
    #[error("the graphics device was lost: {0}")]
    Lost(String),
}
