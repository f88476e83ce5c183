//! The graphics device, and the listeners notified of its loss (thesis §3.2.8.1, `DirectDevice`, `DirectReceiver`).

use super::error::GraphicsError;
use super::gpu::Gpu;
use super::losses::{DeviceReports, LossRecord, LossTolerance};
use super::surface::{SurfaceSource, WindowSurface};
use dragonfly_document::FaultInjection;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

/// Parameters of a device (thesis §3.2.8.1: parameters in one structure with defaults).
#[derive(Clone)]
pub struct DeviceParameters {
    /// Graphics APIs to search for adapters.
    pub backends: wgpu::Backends,
    /// The window to draw into; `None` draws into textures only.
    pub source: Option<SurfaceSource>,
    /// Faults that a test injects.
    pub faults: FaultInjection,
}

impl Default for DeviceParameters {
    /// Uses the platform's native APIs, or those that `WGPU_BACKEND` names, and no window.
    fn default() -> Self {
        let backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
        Self { backends, source: None, faults: FaultInjection::default() }
    }
}

/// An owner of device resources (thesis §3.2.8.2).
pub trait DeviceListener {
    /// Called when the device is lost: drops everything that was created with it.
    fn on_lost(&mut self);
    /// Called with a new device: creates the resources again from the data kept.
    fn on_reset(&mut self, gpu: &Gpu);
}

/// Result of [`Device::check_device_state`].
#[derive(Debug)]
pub enum DeviceState {
    /// The device works.
    Working,
    /// The device was lost and created again; listeners have reloaded.
    Reset {
        /// Message of the driver.
        reason: String,
        /// Whether the device is lost too often.
        patience: LossTolerance,
    },
    /// The device could not be created again.
    Gone(GraphicsError),
}

/// The device, its queue and its surface. Created, used and dropped in one thread (T-091).
pub struct Device {
    parameters: DeviceParameters,
    instance: wgpu::Instance,
    adapter: wgpu::Adapter,
    gpu: Gpu,
    surface: Option<WindowSurface>,
    listeners: Vec<Rc<RefCell<dyn DeviceListener>>>,
    reports: DeviceReports,
    losses: LossRecord,
}

impl Device {
    /// Creates a device after checking `parameters` against the hardware.
    pub fn new(parameters: DeviceParameters) -> Result<Self, GraphicsError> {
        let reports = DeviceReports::default();
        let instance = instance(&parameters);
        let surface = parameters.source.as_ref().map(|source| source.surface(&instance)).transpose();
        // Without a driver there is no surface either, and the missing driver is what the user needs to know.
        let mut surface = surface.map_err(|error| {
            let adapters = pollster::block_on(instance.enumerate_adapters(parameters.backends));
            if adapters.is_empty() {
                GraphicsError::NoAdapter("no driver was found".to_owned())
            } else {
                error
            }
        })?;
        let (adapter, gpu) = make(&instance, &parameters, surface.as_mut(), &reports)?;
        let losses = LossRecord::default();
        Ok(Self { parameters, instance, adapter, gpu, surface, listeners: Vec::new(), reports, losses })
    }

    /// Registers `listener` for losses, after the existing listeners, and calls it with the present device.
    pub fn add_listener(&mut self, listener: Rc<RefCell<dyn DeviceListener>>) {
        listener.borrow_mut().on_reset(&self.gpu);
        self.listeners.push(listener);
    }

    /// Unregisters `listener`.
    pub fn remove_listener(&mut self, listener: &Rc<RefCell<dyn DeviceListener>>) {
        self.listeners.retain(|other| !Rc::ptr_eq(other, listener));
    }

    /// The device for creating resources.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The parameters the device was created with.
    pub fn parameters(&self) -> &DeviceParameters {
        &self.parameters
    }

    /// Name of the adapter, API and driver.
    pub fn adapter_name(&self) -> String {
        let info = self.adapter.get_info();
        let mut name = format!("{} ({:?}", info.name, info.backend);
        if !info.driver_info.is_empty() {
            name += &format!(", {}", info.driver_info);
        }
        name + ")"
    }

    /// Returns whether the processor draws, so that frames cost time that the rest of the program needs.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// The window's surface, with the device needed to use it.
    pub fn surface(&mut self) -> Option<(&mut WindowSurface, &Gpu)> {
        self.surface.as_mut().map(|surface| (surface, &self.gpu))
    }

    /// Number of unexpected errors since the start. More than zero is a bug in the program.
    pub fn errors(&self) -> u32 {
        self.reports.errors()
    }

    /// Number of losses since the start.
    pub fn losses(&self) -> u32 {
        self.losses.total()
    }

    /// Loses the device deliberately, for tests; not counted in [`LossTolerance`].
    pub fn lose(&mut self) {
        self.losses.expect_one();
        self.gpu.device.destroy();
        // The driver reports the loss at some later poll; nothing can be drawn from now on, so it is reported here.
        self.reports.report_loss("Destroyed: on purpose");
    }

    /// Reports that the device is unusable although the driver has not (a panic inside wgpu, a surface that answers
    /// "validation" twice): the next check creates it again.
    pub fn assume_lost(&mut self, reason: &str) {
        self.reports.report_loss(reason);
    }

    /// Forgets earlier losses, because the user asked to try again.
    pub fn forgive(&mut self) {
        self.losses.forgive();
    }

    /// Checks whether the device is usable (thesis §3.2.8.1). A lost one is created again and the listeners reload:
    /// first from the same adapter, then from a new one, then from a new instance.
    pub fn check_device_state(&mut self, now: Instant) -> DeviceState {
        // The callback of a lost device runs during a poll, and polling a lost device may panic.
        if let Err(panic) = super::guard::caught(|| drop(self.gpu.device.poll(wgpu::PollType::Poll))) {
            self.reports.report_loss(&panic);
        }
        let Some(reason) = self.reports.take_loss() else { return DeviceState::Working };
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
        // Late reports of the old device must not be mistaken for reports of the new one.
        self.reports = self.reports.successor();
        if let Some(surface) = &mut self.surface {
            surface.forget_configuration();
        }
        if let Ok(gpu) =
            Gpu::new(&self.adapter, self.surface.as_ref().map(WindowSurface::surface), &self.reports)
        {
            self.gpu = gpu;
            return Ok(());
        }
        if let Ok((adapter, gpu)) =
            make(&self.instance, &self.parameters, self.surface.as_mut(), &self.reports)
        {
            (self.adapter, self.gpu) = (adapter, gpu);
            return Ok(());
        }
        // The old surface must be dropped before the window can have another.
        self.surface = None;
        self.instance = instance(&self.parameters);
        self.surface =
            self.parameters.source.as_ref().map(|source| source.surface(&self.instance)).transpose()?;
        (self.adapter, self.gpu) =
            make(&self.instance, &self.parameters, self.surface.as_mut(), &self.reports)?;
        Ok(())
    }
}

impl Drop for Device {
    /// Lets the device finish before the surface and the window are dropped.
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
    reports: &DeviceReports,
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
    let gpu = Gpu::new(&adapter, surface.map(WindowSurface::surface), reports)?;
    Ok((adapter, gpu))
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim_end_matches(['.', ':']).to_owned()
}
