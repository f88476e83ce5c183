//! One frame after another: opened once, drawn by every pass in order, presented once (T-089).
//!
//! The workers of the graphics thread call [`RenderStage::open`], [`RenderStage::draw`] and [`RenderStage::present`] in turn; rendering
//! without a window does the same. Everything that touches the device is guarded: a panic there means that the device
//! is lost.

use super::accumulation::FrameSum;
use super::device::{Device, DeviceLoss, DeviceParameters, DeviceState};
use super::error::GraphicsError;
use super::gpu::SceneEncoding;
use super::guard::caught;
use super::losses::LossTolerance;
use super::pass::{self, FrameCommands, Pass, PassLayer, Passes, SharedPass, Surroundings};
use super::readback;
use super::scene::Scene;
use super::shadow::sun_side;
use super::surface::{Acquired, WindowSurface};
use super::target::{SceneTarget, begin_window};
use image::RgbaImage;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

/// Result of opening a frame.
#[derive(Debug)]
pub enum FrameOpening {
    /// The frame is open for drawing.
    Frame,
    /// There is nothing to draw into at the moment.
    Nothing,
    /// The device is lost for good.
    Gone(GraphicsError),
}

/// An event of the device that the main thread needs to know.
#[derive(Debug)]
pub enum DeviceEvent {
    /// The device was lost and created again.
    Recovered(String),
    /// The device is lost too often; the scene is no longer drawn.
    Paused(String),
    /// Another device needs a surface made with this instance; nothing is drawn until it arrives.
    NeedsSurface(wgpu::Instance),
}

/// Parts of the window that are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DrawMode {
    /// Everything.
    All,
    /// The panels only, because drawing the scene seems to cause the losses.
    PanelsOnly,
    /// Nothing, because drawing the panels seems to cause them too.
    Nothing,
}

/// A frame between opening and presenting.
pub(super) struct OpenFrame {
    commands: FrameCommands,
    pass: Option<(PassLayer, wgpu::RenderPass<'static>)>,
    window: Option<wgpu::TextureView>,
    surface_texture: Option<wgpu::SurfaceTexture>,
    /// Whether the scene changed since it was drawn last.
    draws_scene: bool,
}

/// The frames of one device.
pub struct RenderStage {
    /// The first field, because fields are dropped in order: a frame that was opened and never presented is returned
    /// to a surface that still exists.
    frame: Option<OpenFrame>,
    pub(super) device: Device,
    /// The scene; code that changes it calls [`Self::touch_scene`].
    pub scene: Scene,
    pub(super) passes: Passes,
    target: Option<SceneTarget>,
    /// The second view.
    pub(super) second: Option<SceneTarget>,
    /// The sum of sub-frames, where a frame is the mean of several.
    pub(super) sum: Option<FrameSum>,
    pub(super) window_size: [u32; 2],
    scene_changed: bool,
    window_changed: bool,
    /// A texture that replaces the window in the next frame.
    stand_in: Option<wgpu::Texture>,
    pub(super) mode: DrawMode,
    events: Vec<DeviceEvent>,
    frames: u64,
}

impl RenderStage {
    /// Creates a device that draws into textures only, and an empty scene.
    pub fn new(parameters: DeviceParameters, now: Instant) -> Result<Self, GraphicsError> {
        Ok(Self::with(Device::new(parameters)?, now))
    }

    /// Creates an empty scene that `device` draws.
    pub fn with(mut device: Device, now: Instant) -> Self {
        let passes = pass::all();
        // The model first, because the passes draw with it.
        device.add_listener(Rc::clone(&passes.model) as _);
        for pass in &passes.list {
            device.add_listener(pass::listener(pass));
        }
        let mut scene = Scene::new(now);
        scene.shadow_side = sun_side(device.is_software());
        Self {
            device,
            scene,
            passes,
            target: None,
            second: None,
            sum: None,
            frame: None,
            window_size: [0, 0],
            scene_changed: true,
            window_changed: true,
            stand_in: None,
            mode: DrawMode::All,
            events: Vec::new(),
            frames: 0,
        }
    }

    /// The device.
    pub fn device(&mut self) -> &mut Device {
        &mut self.device
    }

    /// The passes in drawing order.
    pub fn passes(&self) -> &[SharedPass] {
        &self.passes.list
    }

    /// The pass of the panels.
    pub fn panels(&self) -> &Rc<RefCell<pass::PanelsPass>> {
        &self.passes.panels
    }

    /// Number of draw calls for surfaces and ghosts in the last frame of the scene.
    pub fn draw_calls(&self) -> usize {
        self.passes.model.borrow().draws()
    }

    /// Number of pipelines and bind groups that were set for these draw calls.
    pub fn state_changes(&self) -> usize {
        self.passes.model.borrow().state_changes()
    }

    /// Number of draw calls for the maps of shadows in the last frame of the scene.
    pub fn shadow_draws(&self) -> usize {
        self.passes.model.borrow().shadow_draws()
    }

    /// Number of vertices that were posed once for several passes in the last frame of the scene.
    pub fn skinned_vertices(&self) -> u64 {
        self.passes.model.borrow().skinned_vertices()
    }

    /// Sets how many bytes of vertices may be posed once for several passes; 0 poses them in each pass.
    pub fn set_skin_budget(&mut self, bytes: u64) {
        self.passes.model.borrow_mut().set_skin_budget(bytes);
    }

    /// Sets the size of the window, physical pixels; zero when it is minimized.
    pub fn resize(&mut self, size: [u32; 2]) {
        if self.window_size != size {
            self.window_size = size;
            self.window_changed = true;
        }
    }

    /// Size of the window, physical pixels.
    pub fn window_size(&self) -> [u32; 2] {
        self.window_size
    }

    /// Marks the scene as changed: the next frame draws it again.
    pub fn touch_scene(&mut self) {
        self.scene_changed = true;
    }

    /// Marks everything but the scene as changed: the next frame draws the panels over the scene as it is.
    pub fn touch_window(&mut self) {
        self.window_changed = true;
    }

    /// Returns whether there is anything new to draw at `now`.
    pub fn wants_frame(&self, now: Instant) -> bool {
        let possible = self.mode != DrawMode::Nothing && !self.device.awaits_surface();
        let visible = possible && !self.window_size.contains(&0);
        let scene_wants = self.mode == DrawMode::All && (self.scene_changed || self.moves(now));
        visible && (scene_wants || self.window_changed)
    }

    /// Returns whether the scene changes by itself.
    pub fn moves(&self, now: Instant) -> bool {
        self.mode == DrawMode::All && self.scene.moves(now)
    }

    /// Sets whether all images of a model are loaded before its first frame, and not some with every frame.
    pub fn load_at_once(&mut self, at_once: bool) {
        self.passes.model.borrow_mut().load_at_once(at_once);
    }

    /// Returns the warnings about the images of the model that is shown, since the last call.
    pub fn take_warnings(&mut self) -> Vec<String> {
        self.passes.model.borrow_mut().take_warnings()
    }

    /// Returns whether images of models wait for the next frames.
    pub fn is_loading(&self) -> bool {
        self.passes.model.borrow().is_loading()
    }

    /// Number of frames presented so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Returns the events of the device since the last call.
    pub fn take_events(&mut self) -> Vec<DeviceEvent> {
        std::mem::take(&mut self.events)
    }

    /// Draws everything again after [`DeviceEvent::Paused`].
    pub fn resume(&mut self) {
        self.device.forgive();
        self.mode = DrawMode::All;
        self.scene_changed = true;
    }

    /// Checks the device. Returns the result of opening a frame if nothing can be drawn.
    pub(super) fn check(&mut self, now: Instant) -> Option<FrameOpening> {
        self.frame = None;
        match self.device.check_device_state(now) {
            DeviceState::Working => {}
            DeviceState::Reset(loss) => self.after_reset(loss),
            DeviceState::NeedsSurface(instance) => {
                self.forget_textures();
                self.events.push(DeviceEvent::NeedsSurface(instance));
                return Some(FrameOpening::Nothing);
            }
            DeviceState::AwaitsSurface => return Some(FrameOpening::Nothing),
            DeviceState::Gone(error) => return Some(FrameOpening::Gone(error)),
        }
        let is_possible = self.mode != DrawMode::Nothing && !self.window_size.contains(&0);
        (!is_possible).then_some(FrameOpening::Nothing)
    }

    /// Draws the scene in `encoding` from now on. Returns `false` when the device counts as lost.
    pub(super) fn encode_as(&mut self, encoding: SceneEncoding) -> bool {
        if self.device.gpu().encoding() == encoding {
            return true;
        }
        (self.target, self.second, self.sum) = (None, None, None);
        self.scene_changed = true;
        let encoded = caught(|| self.device.encode_as(encoding));
        self.keep(encoded.map(|()| None))
    }

    /// Checks the device, computes the scene for `now` and opens a frame.
    pub fn open(&mut self, now: Instant) -> FrameOpening {
        if let Some(stopped) = self.check(now) {
            return stopped;
        }
        if !self.encode_as(SceneEncoding::Display) {
            return FrameOpening::Nothing;
        }
        let draws_scene = self.mode == DrawMode::All && (self.scene_changed || self.moves(now));
        if draws_scene {
            if !self.draw_second(now) {
                return FrameOpening::Nothing;
            }
            self.scene.prepare(now);
        }
        match caught(|| self.open_frame(draws_scene)) {
            Ok(true) => FrameOpening::Frame,
            Ok(false) => FrameOpening::Nothing,
            Err(panic) => {
                self.device.assume_lost(&panic);
                FrameOpening::Nothing
            }
        }
    }

    /// Draws one pass. Returns `false` when the frame is broken.
    pub fn draw(&mut self, pass: &mut dyn Pass) -> bool {
        let Some(mut frame) = self.frame.take() else { return false };
        let drawn = caught(|| {
            self.draw_pass(&mut frame, pass);
            frame
        });
        self.keep(drawn.map(Some))
    }

    /// Ends the frame and presents it. Returns `false` when it was broken.
    pub fn present(&mut self) -> bool {
        let Some(frame) = self.frame.take() else { return false };
        let draws_scene = frame.draws_scene;
        let presented = caught(|| {
            let OpenFrame { commands, pass, surface_texture, .. } = frame;
            drop(pass);
            let gpu = self.device.gpu();
            gpu.queue.submit(commands.before.into_iter().chain([commands.encoder.finish()]));
            if let Some(texture) = surface_texture
                && let Some((surface, gpu)) = self.device.surface()
            {
                surface.pre_present_notify();
                gpu.queue.present(texture);
            }
        });
        let done = self.keep(presented.map(|()| None));
        if done {
            self.frames += 1;
            self.window_changed = false;
            // While images are loaded, every frame shows more of them.
            self.scene_changed = self.scene_changed && !draws_scene || self.is_loading();
        }
        done
    }

    /// Opens a frame, draws every pass and presents it, as the workers do in turn.
    pub fn whole_frame(&mut self, now: Instant) -> FrameOpening {
        let opened = self.open(now);
        if matches!(opened, FrameOpening::Frame) {
            for pass in self.passes.list.clone() {
                if !self.draw(&mut *pass.borrow_mut()) {
                    return FrameOpening::Nothing;
                }
            }
            if !self.present() {
                return FrameOpening::Nothing;
            }
        }
        opened
    }

    /// Reads the scene without the panels, as drawn last.
    pub fn read_scene(&mut self) -> Result<RgbaImage, String> {
        let Some(target) = &self.target else { return Err("there is no scene".to_owned()) };
        let picture = caught(|| readback::read(self.device.gpu(), target.texture()));
        picture.unwrap_or_else(|panic| {
            self.device.assume_lost(&panic);
            Err(panic)
        })
    }

    /// Renders the whole window at `now` once more, into a texture, because what a surface shows cannot be read
    /// everywhere.
    pub fn capture(&mut self, now: Instant) -> Result<RgbaImage, String> {
        let size = self.window_size.map(|side| side.min(self.device.gpu().max_side));
        if size.contains(&0) {
            return Err("the window has no size".to_owned());
        }
        let texture = caught(|| self.make_stand_in(size))?;
        self.stand_in = Some(texture.clone());
        self.window_changed = true;
        self.load_at_once(true);
        let opened = self.whole_frame(now);
        self.load_at_once(false);
        self.stand_in = None;
        self.window_changed = true;
        match opened {
            FrameOpening::Frame => {
                caught(|| readback::read(self.device.gpu(), &texture)).and_then(|read| read)
            }
            FrameOpening::Nothing => Err("nothing could be drawn".to_owned()),
            FrameOpening::Gone(error) => Err(error.to_string()),
        }
    }

    /// Continues with the surface that [`DeviceEvent::NeedsSurface`] asked for.
    pub fn set_surface(
        &mut self,
        surface: Result<WindowSurface, GraphicsError>,
    ) -> Result<(), GraphicsError> {
        match self.device.set_surface(surface) {
            DeviceState::Reset(loss) => self.after_reset(loss),
            DeviceState::Gone(error) => return Err(error),
            DeviceState::Working | DeviceState::NeedsSurface(_) | DeviceState::AwaitsSurface => {}
        }
        Ok(())
    }

    /// Drops the textures of a lost device.
    fn forget_textures(&mut self) {
        (self.target, self.second, self.sum) = (None, None, None);
        self.stand_in = None;
    }

    fn after_reset(&mut self, DeviceLoss { reason, patience }: DeviceLoss) {
        self.forget_textures();
        self.scene.shadow_side = sun_side(self.device.is_software());
        (self.scene_changed, self.window_changed) = (true, true);
        if patience == LossTolerance::Left || !self.device.parameters().faults.pauses() {
            self.events.push(DeviceEvent::Recovered(reason));
            return;
        }
        // First without the scene; if that does not help, without anything.
        self.device.forgive();
        self.mode = if self.mode == DrawMode::All { DrawMode::PanelsOnly } else { DrawMode::Nothing };
        self.events.push(DeviceEvent::Paused(reason));
    }

    fn open_frame(&mut self, draws_scene: bool) -> bool {
        let mut surface_texture = None;
        let window = if let Some(texture) = &self.stand_in {
            Some(texture.create_view(&Default::default()))
        } else if let Some((surface, gpu)) = self.device.surface() {
            match surface.acquire(gpu, self.window_size) {
                Acquired::Frame(texture) => {
                    let view = texture.texture.create_view(&Default::default());
                    surface_texture = Some(texture);
                    Some(view)
                }
                Acquired::Nothing => return false,
                Acquired::DeviceLost => {
                    self.device.assume_lost("the window's surface does not respond");
                    return false;
                }
            }
        } else {
            None
        };
        let gpu = self.device.gpu();
        if draws_scene {
            let [_, _, width, height] = self.scene.look.viewport;
            let size = [width, height].map(|side| side.min(gpu.max_side));
            if size.contains(&0) {
                self.target = None;
            } else if self.target.as_ref().is_none_or(|target| target.size() != size) {
                self.target = Some(SceneTarget::new(gpu, size));
            }
            gpu.write_frame(self.scene.uniform());
        }
        let encoder = gpu.device.create_command_encoder(&Default::default());
        let mut commands = FrameCommands { encoder, before: Vec::new() };
        let around = self.surroundings(window_extent(surface_texture.as_ref(), self.window_size));
        for pass in &self.passes.list {
            let mut pass = pass.borrow_mut();
            let wanted = match pass.layer() {
                PassLayer::Scene => draws_scene,
                PassLayer::Window => window.is_some(),
            };
            if wanted {
                pass.prepare(&around, &mut commands);
            }
        }
        self.frame = Some(OpenFrame { commands, pass: None, window, surface_texture, draws_scene });
        true
    }

    fn draw_pass(&self, frame: &mut OpenFrame, pass: &mut dyn Pass) {
        let layer = pass.layer();
        let begun = frame.pass.as_ref().is_some_and(|(begun, _)| *begun == layer);
        if !begun {
            // The previous pass must end before its encoder can begin another.
            frame.pass = None;
            let encoder = &mut frame.commands.encoder;
            let next = match (layer, &self.target, &frame.window) {
                (PassLayer::Scene, Some(target), _) if frame.draws_scene => target.begin(encoder),
                (PassLayer::Window, _, Some(window)) => begin_window(encoder, window),
                _ => return,
            };
            frame.pass = Some((layer, next));
        }
        let extent = window_extent(frame.surface_texture.as_ref(), self.window_size);
        let around = self.surroundings(extent);
        if let Some((_, open)) = &mut frame.pass {
            pass.draw(&around, open);
        }
    }

    pub(super) fn surroundings(&self, window_size: [u32; 2]) -> Surroundings<'_> {
        Surroundings {
            gpu: self.device.gpu(),
            scene: &self.scene,
            window_size,
            scene_view: self.target.as_ref().map(SceneTarget::view),
            second_view: self.second.as_ref().map(SceneTarget::view),
        }
    }

    fn make_stand_in(&self, [width, height]: [u32; 2]) -> wgpu::Texture {
        let gpu = self.device.gpu();
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("stand-in"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: gpu.window_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Keeps the frame after a successful step; after a panic the frame is dropped and the device counts as lost.
    pub(super) fn keep(&mut self, step: Result<Option<OpenFrame>, String>) -> bool {
        match step {
            Ok(frame) => {
                self.frame = frame;
                true
            }
            Err(panic) => {
                self.device.assume_lost(&panic);
                false
            }
        }
    }
}

/// Returns the size that can actually be drawn into, in pixels.
fn window_extent(texture: Option<&wgpu::SurfaceTexture>, otherwise: [u32; 2]) -> [u32; 2] {
    texture.map_or(otherwise, |texture| [texture.texture.width(), texture.texture.height()])
}
