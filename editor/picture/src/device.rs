//! The graphics device, and the listeners notified of its loss (thesis §3.2.8.1, `DirectDevice`, `DirectReceiver`).

use super::connection::Connection;
use super::error::GraphicsError;
use super::gpu::{Gpu, SAMPLES, SceneEncoding};
use super::losses::{DeviceReports, LossRecord, LossTolerance};
use super::surface::WindowSurface;
use dragonfly_document::FaultInjection;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

/// Parameters of a device (thesis §3.2.8.1: parameters in one structure with defaults).
#[derive(Clone)]
pub struct DeviceParameters {
    /// Graphics APIs to search for adapters.
    pub backends: wgpu::Backends,
    /// Connection to the window system with the window to draw into; `None` draws into textures only.
    pub connection: Option<Connection>,
    /// Largest number of samples per pixel of the scene; 1 turns the smoothing of edges off.
    pub most_samples: u32,
    /// Faults that a test injects.
    pub faults: FaultInjection,
}

impl Default for DeviceParameters {
    /// Uses the platform's native APIs, or those that `WGPU_BACKEND` names, and no window.
    fn default() -> Self {
        let backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
        Self { backends, connection: None, most_samples: SAMPLES, faults: FaultInjection::default() }
    }
}

impl DeviceParameters {
    /// Creates an instance, which can draw into a window if there is a connection.
    pub fn instance(&self) -> wgpu::Instance {
        let mut descriptor = match &self.connection {
            Some(connection) => {
                wgpu::InstanceDescriptor::new_with_display_handle(Box::new(connection.clone()))
            }
            None => wgpu::InstanceDescriptor::new_without_display_handle(),
        }
        .with_env();
        descriptor.backends = self.backends;
        descriptor.backend_options.noop.enable = self.backends.contains(wgpu::Backends::NOOP);
        wgpu::Instance::new(descriptor)
    }
}

/// An owner of device resources (thesis §3.2.8.2).
pub trait DeviceListener {
    /// Called when the device is lost: drops everything that was created with it.
    fn on_lost(&mut self);
    /// Called with a new device: creates the resources again from the data kept.
    fn on_reset(&mut self, gpu: &Gpu);
}

/// A loss of the device.
#[derive(Debug)]
pub struct DeviceLoss {
    /// Message of the driver.
    pub reason: String,
    /// Whether the device is lost too often.
    pub patience: LossTolerance,
}

/// Result of [`Device::check_device_state`].
#[derive(Debug)]
pub enum DeviceState {
    /// The device works.
    Working,
    /// The device was lost and created again; listeners have reloaded.
    Reset(DeviceLoss),
    /// The device was lost, and another one needs a surface made with this instance. Returned once.
    NeedsSurface(wgpu::Instance),
    /// The device was lost, and the surface for another one has not arrived yet.
    AwaitsSurface,
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
    /// The encoding of the scene, also of a device that is created again.
    encoding: SceneEncoding,
    /// The loss after which a surface is awaited; until it arrives there is no usable device.
    awaits_surface: Option<DeviceLoss>,
}

impl Device {
    /// Creates a device that draws into textures only, after checking `parameters` against the hardware.
    pub fn new(parameters: DeviceParameters) -> Result<Self, GraphicsError> {
        let instance = parameters.instance();
        Self::with(parameters, instance, None)
    }

    /// Creates a device that draws into a window, whose surface the main thread made with `instance`.
    pub fn in_window(
        parameters: DeviceParameters,
        instance: wgpu::Instance,
        surface: Result<WindowSurface, GraphicsError>,
    ) -> Result<Self, GraphicsError> {
        let surface = surface.map_err(|error| explain(error, &instance, parameters.backends))?;
        Self::with(parameters, instance, Some(surface))
    }

    fn with(
        parameters: DeviceParameters,
        instance: wgpu::Instance,
        surface: Option<WindowSurface>,
    ) -> Result<Self, GraphicsError> {
        let reports = DeviceReports::default();
        let (adapter, gpu) = make(&instance, &parameters, surface.as_ref(), &reports)?;
        Ok(Self {
            parameters,
            instance,
            adapter,
            gpu,
            surface,
            listeners: Vec::new(),
            reports,
            losses: LossRecord::default(),
            encoding: SceneEncoding::default(),
            awaits_surface: None,
        })
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

    /// Draws the scene in `encoding` from now on: the listeners create their resources again where it differs. Unlike a loss, that is planned,
    /// and takes as long.
    pub(crate) fn encode_as(&mut self, encoding: SceneEncoding) {
        if self.encoding == encoding {
            return;
        }
        for listener in &self.listeners {
            listener.borrow_mut().on_lost();
        }
        self.encoding = encoding;
        self.gpu.set_encoding(encoding);
        for listener in &self.listeners {
            listener.borrow_mut().on_reset(&self.gpu);
        }
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
    /// first from the same adapter, then from a new one, then from a new instance. For a window, that instance needs
    /// another surface, which arrives by [`set_surface`](Self::set_surface).
    pub fn check_device_state(&mut self, now: Instant) -> DeviceState {
        if self.awaits_surface.is_some() {
            return DeviceState::AwaitsSurface;
        }
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
        let loss = DeviceLoss { reason, patience };
        match self.recreate() {
            Ok(true) => self.reload(loss),
            Ok(false) => {
                self.awaits_surface = Some(loss);
                DeviceState::NeedsSurface(self.instance.clone())
            }
            Err(error) => DeviceState::Gone(error),
        }
    }

    /// Returns whether the device is lost until [`set_surface`](Self::set_surface) is called.
    pub fn awaits_surface(&self) -> bool {
        self.awaits_surface.is_some()
    }

    /// Creates the device again with the surface that [`DeviceState::NeedsSurface`] asked for.
    pub fn set_surface(&mut self, surface: Result<WindowSurface, GraphicsError>) -> DeviceState {
        let Some(loss) = self.awaits_surface.take() else { return DeviceState::Working };
        let made = surface
            .map_err(|error| explain(error, &self.instance, self.parameters.backends))
            .and_then(|surface| {
                let surface = self.surface.insert(surface);
                make(&self.instance, &self.parameters, Some(surface), &self.reports)
            });
        match made {
            Ok((adapter, gpu)) => {
                (self.adapter, self.gpu) = (adapter, gpu);
                self.reload(loss)
            }
            Err(error) => DeviceState::Gone(error),
        }
    }

    fn reload(&mut self, loss: DeviceLoss) -> DeviceState {
        self.gpu.set_encoding(self.encoding);
        for listener in &self.listeners {
            listener.borrow_mut().on_reset(&self.gpu);
        }
        DeviceState::Reset(loss)
    }

    /// Creates the device again. Returns `false` if that needs a surface made with the new instance.
    fn recreate(&mut self) -> Result<bool, GraphicsError> {
        // Late reports of the old device must not be mistaken for reports of the new one.
        self.reports = self.reports.successor();
        if let Some(surface) = &mut self.surface {
            surface.forget_configuration();
        }
        let surface = self.surface.as_ref().map(WindowSurface::surface);
        if let Ok(gpu) = Gpu::new(&self.adapter, surface, self.parameters.most_samples, &self.reports) {
            self.gpu = gpu;
            return Ok(true);
        }
        if let Ok((adapter, gpu)) =
            make(&self.instance, &self.parameters, self.surface.as_ref(), &self.reports)
        {
            (self.adapter, self.gpu) = (adapter, gpu);
            return Ok(true);
        }
        // The old surface must be dropped before the window can have another.
        let had_surface = self.surface.take().is_some();
        self.instance = self.parameters.instance();
        if had_surface {
            return Ok(false);
        }
        (self.adapter, self.gpu) = make(&self.instance, &self.parameters, None, &self.reports)?;
        Ok(true)
    }
}

impl Drop for Device {
    /// Lets the device finish before the surface and the window are dropped.
    fn drop(&mut self) {
        let _ = super::guard::caught(|| drop(self.gpu.device.poll(wgpu::PollType::wait_indefinitely())));
    }
}

/// Returns the error to report when no surface could be made: without a driver there is none, and the missing driver is
/// what the user needs to know.
fn explain(error: GraphicsError, instance: &wgpu::Instance, backends: wgpu::Backends) -> GraphicsError {
    if pollster::block_on(instance.enumerate_adapters(backends)).is_empty() {
        GraphicsError::NoAdapter("no driver was found".to_owned())
    } else {
        error
    }
}

/// Creates a device of the best adapter, or of another one if that fails: an API may be installed and not work.
fn make(
    instance: &wgpu::Instance,
    parameters: &DeviceParameters,
    surface: Option<&WindowSurface>,
    reports: &DeviceReports,
) -> Result<(wgpu::Adapter, Gpu), GraphicsError> {
    let surface = surface.map(WindowSurface::surface);
    let request = |force_fallback_adapter| {
        pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            force_fallback_adapter,
            ..Default::default()
        }))
    };
    let best = request(false).or_else(|error| request(true).map_err(|_| error)).map_err(|error| {
        tracing::debug!(backends = ?parameters.backends, %error, "no adapter");
        GraphicsError::NoAdapter(first_line(&error.to_string()))
    })?;
    let error = match Gpu::new(&best, surface, parameters.most_samples, reports) {
        Ok(gpu) => return Ok((best, gpu)),
        Err(error) => error,
    };
    let identity = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        (info.backend, info.vendor, info.device, info.name)
    };
    for other in pollster::block_on(instance.enumerate_adapters(parameters.backends)) {
        let is_usable = surface.is_none_or(|surface| other.is_surface_supported(surface));
        if is_usable
            && identity(&other) != identity(&best)
            && let Ok(gpu) = Gpu::new(&other, surface, parameters.most_samples, reports)
        {
            tracing::warn!(%error, "another graphics adapter is used");
            return Ok((other, gpu));
        }
    }
    Err(error)
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim_end_matches(['.', ':']).to_owned()
}
