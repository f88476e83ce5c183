//! The window's surface in the graphics thread: configured before use, never with a size of zero.

use super::connection::TargetWindow;
use super::gpu::Gpu;
use std::sync::Arc;

/// Result of acquiring the next image to draw into.
pub enum Acquired {
    /// An image to draw into.
    Frame(wgpu::SurfaceTexture),
    /// None at the moment: the window is minimized, hidden, or between two sizes.
    Nothing,
    /// The device of the surface is lost.
    DeviceLost,
}

/// A surface and its present configuration.
pub struct WindowSurface {
    surface: wgpu::Surface<'static>,
    notify_window: Box<dyn Fn() + Send>,
    configured: Option<wgpu::SurfaceConfiguration>,
    /// Number of consecutive "validation" results.
    refusals: u32,
}

impl WindowSurface {
    /// A surface of `window` that is not configured yet.
    pub(super) fn new(surface: wgpu::Surface<'static>, window: Arc<dyn TargetWindow>) -> Self {
        // From here on only the notification can be reached, and not the handles of the window.
        let notify_window = Box::new(move || window.pre_present_notify());
        Self { surface, notify_window, configured: None, refusals: 0 }
    }

    /// The surface itself.
    pub fn surface(&self) -> &wgpu::Surface<'static> {
        &self.surface
    }

    /// Forgets the configuration, because its device is lost.
    pub fn forget_configuration(&mut self) {
        self.configured = None;
        self.refusals = 0;
    }

    /// Notifies the window system that a frame is about to be presented.
    pub fn pre_present_notify(&self) {
        (self.notify_window)();
    }

    /// Acquires the next image of the window, which has `size` pixels.
    pub fn acquire(&mut self, gpu: &Gpu, size: [u32; 2]) -> Acquired {
        if size.contains(&0) {
            return Acquired::Nothing;
        }
        let size = size.map(|side| side.min(gpu.max_side));
        if self.configured.as_ref().is_none_or(|now| [now.width, now.height] != size)
            && !self.configure(gpu, size)
        {
            return self.refused();
        }
        use wgpu::CurrentSurfaceTexture as Current;
        for _ in 0..2 {
            match self.surface.get_current_texture() {
                // A suboptimal image can be drawn into; the new size of the window arrives as a message and configures
                // the surface again.
                Current::Success(texture) | Current::Suboptimal(texture) => {
                    self.refusals = 0;
                    return Acquired::Frame(texture);
                }
                Current::Outdated | Current::Lost => {
                    if !self.configure(gpu, size) {
                        return self.refused();
                    }
                }
                Current::Timeout | Current::Occluded => return Acquired::Nothing,
                Current::Validation => {
                    if matches!(self.refused(), Acquired::DeviceLost) {
                        return Acquired::DeviceLost;
                    }
                    if !self.configure(gpu, size) {
                        return self.refused();
                    }
                }
            }
        }
        Acquired::Nothing
    }

    /// Counts "validation" results: a lost device or a destroyed window returns them forever, a window that is
    /// changing only once.
    fn refused(&mut self) -> Acquired {
        self.refusals += 1;
        if self.refusals < 2 {
            return Acquired::Nothing;
        }
        self.refusals = 0;
        Acquired::DeviceLost
    }

    /// Configures the surface and returns whether the window accepted it. A window destroyed by another program does
    /// not, which is not an error of this program.
    fn configure(&mut self, gpu: &Gpu, [width, height]: [u32; 2]) -> bool {
        let configuration = wgpu::SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format: gpu.window_format,
            color_space: Default::default(),
            width,
            height,
            present_mode: wgpu::PresentMode::AutoVsync,
            desired_maximum_frame_latency: 2,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        self.surface.configure(&gpu.device, &configuration);
        // Ready at once: wgpu keeps the error scope in this process.
        let refusal = pollster::block_on(scope.pop());
        if let Some(error) = &refusal {
            tracing::warn!(%error, "the window accepts no images");
        }
        self.configured = refusal.is_none().then_some(configuration);
        self.configured.is_some()
    }
}
