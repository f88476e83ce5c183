//! Limits the memory of the textures of a model, depending on the adapter.

/// Memory for the textures of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TextureMemory {
    /// The adapter has this many bytes for them.
    Device(u64),
    /// The processor draws: the textures are in the memory that the import promised for the file.
    Process,
}

/// Bytes of textures on a graphics card, for which there is no general way to ask how much it has.
const CARD: u64 = 2 << 30;
/// Bytes of textures on a graphics device that shares the memory of the computer, or may do so.
const SHARED: u64 = 1 << 30;
/// Bytes that the program needs with a software adapter for a model without images: code, shaders, and a frame of
/// moderate size.
const SOFTWARE: u64 = 176 << 20;
/// Bytes of images that wait at most until the device copies them.
pub(crate) const STAGING: u64 = 8 << 20;

impl TextureMemory {
    /// Returns the memory of an adapter of this type.
    pub(crate) fn of(adapter: wgpu::DeviceType) -> Self {
        match adapter {
            wgpu::DeviceType::Cpu => Self::Process,
            wgpu::DeviceType::DiscreteGpu => Self::Device(CARD),
            wgpu::DeviceType::Other | wgpu::DeviceType::IntegratedGpu | wgpu::DeviceType::VirtualGpu => {
                Self::Device(SHARED)
            }
        }
    }

    /// Returns the bytes for the textures of a model, if the import left `memory` bytes for the images and decoding one of
    /// them takes up to `decoding` bytes.
    pub(crate) fn room(self, memory: u64, decoding: u64) -> u64 {
        match self {
            Self::Device(bytes) => bytes,
            // A very large image would leave nothing, although most of the time it is not there.
            Self::Process => memory.saturating_sub(SOFTWARE + STAGING + decoding).max(memory / 8),
        }
    }
}
