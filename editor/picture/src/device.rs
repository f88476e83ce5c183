//! The device and everybody who must hear of its loss (thesis §3.2.8.1, `DirectDevice`, `DirectReceiver`).

use super::fault::{Faults, LossRecord, Patience};
use super::gpu::Gpu;
use super::surface::{SurfaceSource, WindowSurface};
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

/// Why nothing can be drawn.
#[derive(Debug, thiserror::Error)]
pub enum GraphicsError {
    /// The machine has no usable graphics adapter.
    #[error("no graphics adapter: {0}; install a Vulkan driver (Debian: mesa-vulkan-drivers)")]
    NoAdapter(String),
    /// The adapter lacks something that drawing needs.
    #[error("the graphics adapter {adapter} cannot {lack}")]
    Unsuitable {
        /// Its name.
        adapter: String,
        /// What it cannot do.
        lack: &'static str,
    },
    /// The adapter gave no device.
    #[error("the graphics adapter gave no device: {0}")]
    NoDevice(String),
    /// The window cannot be drawn into.
    #[error("the window cannot be drawn into: {0}")]
    NoSurface(String),
    /// A picture larger than the device can make.
    #[error("a picture of {width} × {height} pixels is too large or empty; the device makes up to {limit}")]
    PictureSize {
        /// As asked.
        width: u32,
        /// As asked.
        height: u32,
        /// Longest side.
        limit: u32,
    },
    /// The device refused something that this program asked of it.
    #[error("{0} unexpected graphics errors; RUST_LOG=error tells which")]
    Refused(u32),
    /// The device was lost while drawing and could not be made anew.
    #[error("the graphics device was lost: {0}")]
    Lost(String),
}

/// What to make the device of (thesis §3.2.8.1: parameters in one structure with defaults).
#[derive(Clone)]
pub struct DeviceParameters {
    /// Where adapters are looked for.
    pub backends: wgpu::Backends,
    /// The window to draw into; `None` draws into textures only.
    pub source: Option<SurfaceSource>,
}

impl Default for DeviceParameters {
    /// The platform's native interfaces, or what `WGPU_BACKEND` names; no window.
    fn default() -> Self {
        Self { backends: wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY), source: None }
    }
}

/// Holds resources of the device (thesis §3.2.8.2).
pub trait DeviceListener {
    /// The device is gone: drop what was made with it.
    fn on_lost(&mut self);
    /// There is a new one: make again what is needed, from what was kept.
    fn on_reset(&mut self, gpu: &Gpu);
}

/// What [`Device::check_device_state`] found.
#[derive(Debug)]
pub enum DeviceState {
    /// As before.
    Working,
    /// It was lost and made anew; listeners have reloaded.
    Reset {
        /// What the driver said.
        reason: String,
        /// Does it get lost too often?
        patience: Patience,
    },
    /// It cannot be made anew.
    Gone(GraphicsError),
}

/// The device, its queue, its surface. Made, used and dropped in one thread (T-091).
pub struct Device {
    parameters: DeviceParameters,
    instance: wgpu::Instance,
    adapter: wgpu::Adapter,
    gpu: Gpu,
    surface: Option<WindowSurface>,
    listeners: Vec<Rc<RefCell<dyn DeviceListener>>>,
    faults: Faults,
    losses: LossRecord,
}

impl Device {
    /// Makes a device after checking `parameters` against the hardware.
    pub fn new(parameters: DeviceParameters) -> Result<Self, GraphicsError> {
        let faults = Faults::default();
        let instance = instance(&parameters);
        let surface = parameters.source.as_ref().map(|source| source.surface(&instance)).transpose();
        // Without a driver there is no surface either; the driver is what a person has to hear of.
        let mut surface = surface.map_err(|error| {
            let adapters = pollster::block_on(instance.enumerate_adapters(parameters.backends));
            if adapters.is_empty() {
                GraphicsError::NoAdapter("no driver was found".to_owned())
            } else {
                error
            }
        })?;
        let (adapter, gpu) = make(&instance, &parameters, surface.as_mut(), &faults)?;
        let losses = LossRecord::default();
        Ok(Self { parameters, instance, adapter, gpu, surface, listeners: Vec::new(), faults, losses })
    }

    /// Tells `listener` of losses from now on, behind those that came before; it gets the present device at once.
    pub fn add_listener(&mut self, listener: Rc<RefCell<dyn DeviceListener>>) {
        listener.borrow_mut().on_reset(&self.gpu);
        self.listeners.push(listener);
    }

    /// Does not tell `listener` any more.
    pub fn remove_listener(&mut self, listener: &Rc<RefCell<dyn DeviceListener>>) {
        self.listeners.retain(|other| !Rc::ptr_eq(other, listener));
    }

    /// The device to make resources with.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The parameters it was made of.
    pub fn parameters(&self) -> &DeviceParameters {
        &self.parameters
    }

    /// Name of the adapter, backend and driver.
    pub fn adapter_name(&self) -> String {
        let info = self.adapter.get_info();
        let mut name = format!("{} ({:?}", info.name, info.backend);
        if !info.driver_info.is_empty() {
            name += &format!(", {}", info.driver_info);
        }
        name + ")"
    }

    /// Does the processor draw, so that frames cost what the rest of the program needs too?
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// The window's surface, and what is needed to use it.
    pub fn surface(&mut self) -> Option<(&mut WindowSurface, &Gpu)> {
        self.surface.as_mut().map(|surface| (surface, &self.gpu))
    }

    /// Errors that nobody expected, since the start. Zero, or the program has a mistake.
    pub fn errors(&self) -> u32 {
        self.faults.errors()
    }

    /// Losses since the start.
    pub fn losses(&self) -> u32 {
        self.losses.total()
    }

    /// Loses the device on purpose; does not count against [`Patience`].
    pub fn lose(&mut self) {
        self.losses.expect_one();
        self.gpu.device.destroy();
        // The driver says so at some later poll; nothing can be drawn from now on, so it is said here.
        self.faults.report_loss("Destroyed: on purpose");
    }

    /// Notes that the device is unusable although the driver has not said so (a panic inside wgpu, a surface that answers
    /// "validation" twice): the next check makes it anew.
    pub fn assume_lost(&mut self, reason: &str) {
        self.faults.report_loss(reason);
    }

    /// Forgets earlier losses: somebody asked to try again.
    pub fn forgive(&mut self) {
        self.losses.forgive();
    }

    /// Is the device usable (thesis §3.2.8.1)? A lost one is made anew and the listeners reload: first from the same
    /// adapter, then from a new one, then from a new instance.
    pub fn check_device_state(&mut self, now: Instant) -> DeviceState {
        // The callback of a lost device comes during a poll, and polling a lost device may panic.
        if let Err(panic) = super::guard::caught(|| drop(self.gpu.device.poll(wgpu::PollType::Poll))) {
            self.faults.report_loss(&panic);
        }
        let Some(reason) = self.faults.take_loss() else { return DeviceState::Working };
        let patience = self.losses.note(now);
        tracing::warn!(%reason, losses = self.losses.total(), "the graphics device was lost");
        for listener in &self.listeners {
            listener.borrow_mut().on_lost();
        }
        if let Err(error) = self.recreate() {
            return DeviceState::Gone(error);
        }
        for listener in &self.listeners {
            listener.borrow_mut().on_reset(&self.gpu);
        }
        DeviceState::Reset { reason, patience }
    }

    fn recreate(&mut self) -> Result<(), GraphicsError> {
        // What the old device still reports while it goes must not be taken for news of the new one.
        self.faults = self.faults.successor();
        if let Some(surface) = &mut self.surface {
            surface.forget_configuration();
        }
        if let Ok(gpu) = Gpu::new(&self.adapter, self.surface.as_ref(), &self.faults) {
            self.gpu = gpu;
            return Ok(());
        }
        if let Ok((adapter, gpu)) =
            make(&self.instance, &self.parameters, self.surface.as_mut(), &self.faults)
        {
            (self.adapter, self.gpu) = (adapter, gpu);
            return Ok(());
        }
        // The old surface must be gone before the window can have another.
        self.surface = None;
        self.instance = instance(&self.parameters);
        self.surface =
            self.parameters.source.as_ref().map(|source| source.surface(&self.instance)).transpose()?;
        (self.adapter, self.gpu) =
            make(&self.instance, &self.parameters, self.surface.as_mut(), &self.faults)?;
        Ok(())
    }
}

impl Drop for Device {
    /// Lets the device finish before the surface and the window go.
    fn drop(&mut self) {
        let _ = super::guard::caught(|| drop(self.gpu.device.poll(wgpu::PollType::wait_indefinitely())));
    }
}

fn instance(parameters: &DeviceParameters) -> wgpu::Instance {
    let mut descriptor = match &parameters.source {
        Some(source) => source.instance_descriptor(),
        None => wgpu::InstanceDescriptor::new_without_display_handle(),
    }
    .with_env();
    descriptor.backends = parameters.backends;
    descriptor.backend_options.noop.enable = parameters.backends.contains(wgpu::Backends::NOOP);
    wgpu::Instance::new(descriptor)
}

fn make(
    instance: &wgpu::Instance,
    parameters: &DeviceParameters,
    surface: Option<&mut WindowSurface>,
    faults: &Faults,
) -> Result<(wgpu::Adapter, Gpu), GraphicsError> {
    let surface = surface.map(|surface| &*surface);
    let request = |force_fallback_adapter| {
        pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface.map(WindowSurface::surface),
            force_fallback_adapter,
            ..Default::default()
        }))
    };
    let adapter = request(false).or_else(|error| request(true).map_err(|_| error)).map_err(|error| {
        tracing::debug!(backends = ?parameters.backends, %error, "no adapter");
        GraphicsError::NoAdapter(first_line(&error.to_string()))
    })?;
    let gpu = Gpu::new(&adapter, surface, faults)?;
    Ok((adapter, gpu))
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim_end_matches(['.', ':']).to_owned()
}
