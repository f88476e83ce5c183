//! The window's surface: configured when there is something to configure, never with a size of zero.

use super::connection::{ConnectedWindow, Connection};
use super::device::GraphicsError;
use super::gpu::Gpu;
use std::sync::Arc;
use wgpu::rwh::{HasDisplayHandle, HasWindowHandle};

/// A window that frames can be presented in. The window system belongs to the caller; only its handles are needed here.
pub trait TargetWindow: HasWindowHandle + HasDisplayHandle + Send + Sync + 'static {
    /// Notifies the window system that a frame is about to be presented.
    fn pre_present_notify(&self);
}

/// The window and connection that a surface is made from. Kept, so that the surface can be made again after a loss.
#[derive(Clone)]
pub struct SurfaceSource {
    /// The window.
    pub window: Arc<dyn TargetWindow>,
    /// The driver's connection to the window system.
    pub connection: Connection,
}

impl SurfaceSource {
    /// Describes an instance that can draw into the window.
    pub fn instance_descriptor(&self) -> wgpu::InstanceDescriptor {
        wgpu::InstanceDescriptor::new_with_display_handle(Box::new(self.connection.clone()))
    }

    /// A surface of the window.
    pub fn surface(&self, instance: &wgpu::Instance) -> Result<WindowSurface, GraphicsError> {
        let window =
            ConnectedWindow { window: Arc::clone(&self.window), connection: self.connection.clone() };
        let surface = instance
            .create_surface(wgpu::SurfaceTarget::DisplayAndWindow(Box::new(window)))
            .map_err(|error| GraphicsError::NoSurface(error.to_string()))?;
        Ok(WindowSurface { surface, window: Arc::clone(&self.window), configured: None, refusals: 0 })
    }
}

/// What came of asking for the next picture to draw into.
pub enum Acquired {
    /// Draw into this.
    Frame(wgpu::SurfaceTexture),
    /// Not now: minimised, hidden, or between two sizes.
    Nothing,
    /// The device behind it is gone.
    DeviceLost,
}

/// A surface and its present configuration.
pub struct WindowSurface {
    surface: wgpu::Surface<'static>,
    window: Arc<dyn TargetWindow>,
    configured: Option<wgpu::SurfaceConfiguration>,
    /// "Validation" answers in a row.
    refusals: u32,
}

impl WindowSurface {
    /// The surface itself.
    pub fn surface(&self) -> &wgpu::Surface<'static> {
        &self.surface
    }

    /// The format to draw in: one that does not encode, because egui wants to do that itself.
    pub fn format(&self, adapter: &wgpu::Adapter) -> Result<wgpu::TextureFormat, GraphicsError> {
        let formats = self.surface.get_capabilities(adapter).formats;
        egui_wgpu::preferred_framebuffer_format(&formats)
            .map_err(|error| GraphicsError::NoSurface(error.to_string()))
    }

    /// The device it was configured for is gone.
    pub fn forget_configuration(&mut self) {
        self.configured = None;
        self.refusals = 0;
    }

    /// Tells the window system that a picture comes.
    pub fn pre_present_notify(&self) {
        self.window.pre_present_notify();
    }

    /// The next picture of the window, which has `size` pixels.
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
                // Shows what it should; the window's new size comes as a message and configures it anew.
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

    /// What a lost device or a destroyed window answers for ever, but a window in the middle of a change only once.
    fn refused(&mut self) -> Acquired {
        self.refusals += 1;
        if self.refusals < 2 {
            return Acquired::Nothing;
        }
        self.refusals = 0;
        Acquired::DeviceLost
    }

    /// Did the window take it? One that was destroyed behind our back does not, which is no error of ours.
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
        // Answered at once: the scope is kept on this side of the driver.
        let refusal = pollster::block_on(scope.pop());
        if let Some(error) = &refusal {
            tracing::warn!(%error, "the window takes no pictures");
        }
        self.configured = refusal.is_none().then_some(configuration);
        self.configured.is_some()
    }
}
