//! The graphics thread's workers (thesis §3.2.4.2): first [`Graphics`], which opens the frame, then one drawer per
//! pass, and last [`Present`]. A worker that cannot do its part ends the iteration, so an unfinished frame is never
//! presented.

use super::device::{Device, DeviceParameters};
use super::error::GraphicsError;
use super::guard::caught;
use super::message::{GraphicsMessage, GraphicsReply};
use super::pass::SharedPass;
use super::pick::{pick, pick_region};
use super::stage::{DeviceEvent, FrameOpening, RenderStage};
use super::surface::WindowSurface;
use super::thumbnail::ThumbnailOrder;
use super::{GraphicsHandle, Look};
use crate::camera::Camera;
use crate::playback::PlaybackClock;
use dragonfly_document::{FaultInjection, FaultPoint, View};
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time per frame if nothing else limits the frame rate.
const PACE: Duration = Duration::from_micros(16_667);
/// Shortest time per frame; a surface that returns faster does not limit the frame rate.
const FASTEST: Duration = Duration::from_micros(4_000);
/// Shortest time between two reports of frames to the main thread.
const STATISTICS: Duration = Duration::from_millis(250);
/// Time until a window that has nothing to draw into is tried again.
const RETRY: Duration = Duration::from_millis(100);

/// Opens frames, and keeps what is shown.
pub struct Graphics {
    start: StartStep,
    replies: Address<GraphicsReply>,
    stage: Option<Rc<RefCell<RenderStage>>>,
    /// Messages that arrived before the device was ready.
    waiting: Vec<GraphicsMessage>,
    captures: Vec<PathBuf>,
    thumbnails: VecDeque<ThumbnailOrder>,
    statistics: Rc<RefCell<Statistics>>,
    failed: bool,
    faults: FaultInjection,
}

/// Progress of the start.
enum StartStep {
    /// The thread has not been called yet.
    Prepared(DeviceParameters),
    /// The main thread was asked for a surface made with this instance.
    AwaitsSurface(DeviceParameters, wgpu::Instance),
    /// The device exists, or could not be created.
    Done,
}

/// Times of frames, shared with the presenter.
#[derive(Debug, Default)]
struct Statistics {
    opened: Option<Instant>,
    reported: Option<Instant>,
}

impl Graphics {
    /// Starts the graphics thread (T-133), whose replies go to `replies`. The device for a window of `size` physical
    /// pixels is created in that thread, which first replies [`GraphicsReply::NeedsSurface`] if there is a window, and
    /// then [`GraphicsReply::Ready`] or [`GraphicsReply::Fatal`].
    pub fn start(
        parameters: DeviceParameters,
        size: [u32; 2],
        replies: Address<GraphicsReply>,
    ) -> std::io::Result<GraphicsHandle> {
        let thread = Thread::start("graphics")?;
        Ok(Self::register(&thread.handle().clone(), Some(thread), parameters, size, replies))
    }

    /// Does the same as [`start`](Self::start) in a thread of the caller, which a test may step, with or without a
    /// window.
    pub fn start_in(
        thread: &ThreadHandle,
        parameters: DeviceParameters,
        size: [u32; 2],
        replies: Address<GraphicsReply>,
    ) -> GraphicsHandle {
        Self::register(thread, None, parameters, size, replies)
    }

    fn register(
        thread: &ThreadHandle,
        owner: Option<Thread>,
        parameters: DeviceParameters,
        size: [u32; 2],
        replies: Address<GraphicsReply>,
    ) -> GraphicsHandle {
        let (address, views) = (thread.reserve_address(), thread.reserve_address());
        let (own, shows) = (address.clone(), views.clone());
        // Fails only for a thread that has stopped, and then the result is not needed.
        let _ = thread.run(move |context| {
            let faults = parameters.faults.clone();
            let graphics = Rc::new(RefCell::new(Self {
                start: StartStep::Prepared(parameters),
                replies,
                stage: None,
                waiting: vec![GraphicsMessage::Resized(size)],
                captures: Vec::new(),
                thumbnails: VecDeque::new(),
                statistics: Rc::default(),
                failed: false,
                faults,
            }));
            // After a panic the state is kept: only the message is lost, or the frame, which is drawn again.
            let again = move || {
                graphics.borrow().draw_again();
                Rc::clone(&graphics)
            };
            let [receives, views, works] = [(); 3].map(|()| again.clone());
            context.register_restartable_receiver_at(&own, move |_| receives());
            context.register_restartable_receiver_at(&shows, move |_| Views(views()));
            context.register_restartable_worker(move |_| works());
        });
        GraphicsHandle::new(thread.clone(), address, views, owner)
    }

    /// First call in the thread: creates the device, or asks for the surface that the device must be able to draw into.
    fn initialize(&mut self, thread: &mut Context) {
        match std::mem::replace(&mut self.start, StartStep::Done) {
            StartStep::Prepared(parameters) if parameters.connection.is_some() => {
                match caught(|| parameters.instance()) {
                    Ok(instance) => {
                        self.reply(GraphicsReply::NeedsSurface(instance.clone()));
                        self.start = StartStep::AwaitsSurface(parameters, instance);
                    }
                    Err(panic) => self.fail(&panic),
                }
            }
            StartStep::Prepared(parameters) => self.begin(|| Device::new(parameters), thread),
            waits @ (StartStep::AwaitsSurface(..) | StartStep::Done) => self.start = waits,
        }
    }

    /// Creates the device that can draw into the surface that was asked for at the start.
    fn initialize_window(&mut self, surface: Result<WindowSurface, GraphicsError>, thread: &mut Context) {
        match std::mem::replace(&mut self.start, StartStep::Done) {
            StartStep::AwaitsSurface(parameters, instance) => {
                self.begin(|| Device::in_window(parameters, instance, surface), thread);
            }
            waits @ (StartStep::Prepared(_) | StartStep::Done) => self.start = waits,
        }
    }

    /// Creates the device with `make`, and the workers that draw with it.
    fn begin(&mut self, make: impl FnOnce() -> Result<Device, GraphicsError>, thread: &mut Context) {
        let now = thread.now();
        let mut stage = match caught(|| make().map(|device| RenderStage::with(device, now))) {
            Ok(Ok(stage)) => stage,
            Ok(Err(error)) => return self.fail(&error.to_string()),
            Err(panic) => return self.fail(&panic),
        };
        let adapter = stage.device().adapter_name();
        let gpu = stage.device().gpu();
        let (max_texture_side, samples) = (gpu.max_side, gpu.samples);
        tracing::info!(%adapter, samples, "graphics device created");
        let passes = stage.passes().to_vec();
        let stage = Rc::new(RefCell::new(stage));
        for pass in passes {
            let drawer = Drawer { stage: Rc::clone(&stage), pass };
            thread.register_restartable_worker(move |_| drawer.clone());
        }
        thread.register_last_worker(Present {
            stage: Rc::clone(&stage),
            replies: self.replies.clone(),
            statistics: Rc::clone(&self.statistics),
        });
        self.stage = Some(stage);
        self.reply(GraphicsReply::Ready { adapter, max_texture_side, smooth: samples > 1 });
        for message in std::mem::take(&mut self.waiting) {
            self.handle(message, thread);
        }
        // The drawers are called from the next iteration on.
        thread.iterate_again();
    }

    fn draw_again(&self) {
        if let Some(stage) = &self.stage {
            stage.borrow_mut().touch_window();
        }
    }

    fn fail(&mut self, reason: &str) {
        tracing::error!(reason, "no graphics");
        self.failed = true;
        self.waiting.clear();
        self.reply(GraphicsReply::Fatal(reason.to_owned()));
    }

    fn reply(&self, reply: GraphicsReply) {
        // The main thread may have stopped already when the program ends.
        let _ = self.replies.send(reply);
    }

    fn show(stage: &mut RenderStage, view: &View) {
        stage.scene.show(view);
        stage.touch_scene();
    }

    fn play(stage: &mut RenderStage, playback: PlaybackClock) {
        stage.scene.playback = playback;
        stage.touch_scene();
    }

    fn set_camera(stage: &mut RenderStage, camera: Camera) {
        if stage.scene.camera != camera {
            stage.scene.camera = camera;
            stage.touch_scene();
        }
    }

    fn set_look(stage: &mut RenderStage, look: Look) {
        if stage.scene.look != look {
            stage.scene.set_look(look);
            stage.touch_scene();
        }
    }

    /// Draws the next small picture, unless something moves: one in an iteration, so that what is urgent does not wait for all.
    fn draw_thumbnail(&mut self, stage: &mut RenderStage, thread: &mut Context) {
        let now = thread.now();
        if stage.moves(now) {
            return;
        }
        let drawn = self.thumbnails.front().and_then(|order| stage.thumbnail(order, now));
        if let Some(thumbnail) = drawn {
            self.thumbnails.pop_front();
            self.reply(GraphicsReply::Thumbnail(thumbnail));
            if !self.thumbnails.is_empty() {
                thread.iterate_again();
            }
        }
    }

    fn tell_events(&self, stage: &mut RenderStage) {
        for event in stage.take_events() {
            let losses = stage.device().losses();
            self.reply(match event {
                DeviceEvent::Recovered(reason) => GraphicsReply::Recovered { reason, losses },
                DeviceEvent::Paused(reason) => GraphicsReply::Paused { reason },
                DeviceEvent::NeedsSurface(instance) => GraphicsReply::NeedsSurface(instance),
            });
        }
    }

    fn gone(&mut self, reason: &str) {
        self.stage = None;
        self.fail(reason);
    }

    /// Draws into `surface` from now on, with a device that is created again for it.
    fn set_surface(&mut self, stage: &mut RenderStage, surface: Result<WindowSurface, GraphicsError>) {
        match caught(|| stage.set_surface(surface)) {
            Ok(Ok(())) => self.tell_events(stage),
            Ok(Err(error)) => self.gone(&error.to_string()),
            Err(panic) => self.gone(&panic),
        }
    }
}

impl Receiver for Graphics {
    type Message = GraphicsMessage;

    fn receive(&mut self, message: GraphicsMessage, thread: &mut Context) {
        self.handle(message, thread);
        self.faults.reach(FaultPoint::GraphicsMessage);
    }
}

impl Graphics {
    fn handle(&mut self, message: GraphicsMessage, thread: &mut Context) {
        let Some(stage) = self.stage.clone() else {
            if let GraphicsMessage::Surface(surface) = message {
                self.initialize_window(*surface, thread);
            } else if !self.failed {
                if let GraphicsMessage::Show(_) = message {
                    // Only the newest view will be shown.
                    self.waiting.retain(|message| !matches!(message, GraphicsMessage::Show(_)));
                }
                self.waiting.push(message);
            }
            return;
        };
        let stage = &mut *stage.borrow_mut();
        match message {
            GraphicsMessage::Show(view) => Self::show(stage, &view),
            GraphicsMessage::Play(playback) => Self::play(stage, playback),
            GraphicsMessage::Camera(camera) => Self::set_camera(stage, camera),
            GraphicsMessage::Look(look) => Self::set_look(stage, *look),
            GraphicsMessage::Still(bones) => {
                stage.scene.set_still(bones);
                stage.touch_scene();
            }
            GraphicsMessage::Panels(frame) => {
                stage.panels().borrow_mut().show(frame);
                stage.touch_window();
            }
            GraphicsMessage::Resized(size) => stage.resize(size),
            GraphicsMessage::Pick { position, ticket } => {
                stage.scene.prepare(thread.now());
                let thing = stage.scene.pick_thing(position);
                let bone = pick(&stage.scene, position);
                self.reply(GraphicsReply::Picked { bone, thing, ticket });
            }
            GraphicsMessage::PickAll { position, ticket } => {
                stage.scene.prepare(thread.now());
                let things = stage.scene.pick_things(position);
                let bones = stage.scene.pick_all(position);
                self.reply(GraphicsReply::PickedAll { bones, things, ticket });
            }
            GraphicsMessage::Catch { region, ticket } => {
                stage.scene.prepare(thread.now());
                let hidden = Arc::clone(&stage.scene.look.hidden);
                let mut bones = Vec::new();
                pick_region(&stage.scene, &region.region(), &hidden, &mut bones);
                let things = stage.scene.things_in(&region.region());
                self.reply(GraphicsReply::PickedAll { bones, things, ticket });
            }
            GraphicsMessage::Thumbnail(order) => self.thumbnails.push_back(order),
            GraphicsMessage::Appearance(appearance) => {
                stage.scene.appearances.receive(appearance);
                stage.touch_scene();
            }
            GraphicsMessage::Resume => stage.resume(),
            GraphicsMessage::Surface(surface) => self.set_surface(stage, *surface),
            GraphicsMessage::Capture(path) => {
                self.captures.push(path);
                stage.touch_window();
            }
        }
    }
}

/// Receives the document's views. A type of its own, so that the document need not know the graphics thread.
struct Views(Rc<RefCell<Graphics>>);

impl Receiver for Views {
    type Message = View;

    fn receive(&mut self, view: View, thread: &mut Context) {
        self.0.borrow_mut().handle(GraphicsMessage::Show(view), thread);
    }
}

impl Worker for Graphics {
    fn update(&mut self, thread: &mut Context) -> bool {
        if self.failed {
            return false;
        }
        let Some(stage) = self.stage.clone() else {
            self.initialize(thread);
            return false;
        };
        let stage = &mut *stage.borrow_mut();
        let now = thread.now();
        if self.faults.loses_device(stage.frames(), stage.moves(now)) {
            stage.device().lose();
            stage.touch_window();
        }
        self.draw_thumbnail(stage, thread);
        if !stage.wants_frame(now) {
            return false;
        }
        if let Some(wait) = too_soon(self.statistics.borrow().opened, now, stage) {
            thread.wake_at(now + wait);
            return false;
        }
        self.faults.reach(FaultPoint::Frame);
        for path in std::mem::take(&mut self.captures) {
            let written = stage.capture(now).and_then(|picture| write(&picture, &path));
            self.reply(GraphicsReply::Captured(written.map(|()| path)));
        }
        let opened = stage.open(now);
        self.tell_events(stage);
        match opened {
            FrameOpening::Frame => {
                self.statistics.borrow_mut().opened = Some(now);
                if stage.moves(now) || !self.thumbnails.is_empty() {
                    thread.iterate_again();
                }
                true
            }
            FrameOpening::Nothing => {
                if stage.wants_frame(now) {
                    thread.wake_at(now + RETRY);
                }
                false
            }
            FrameOpening::Gone(error) => {
                self.gone(&error.to_string());
                false
            }
        }
    }
}

/// Returns the time to wait for the next frame if the surface itself does not limit the frame rate.
fn too_soon(opened: Option<Instant>, now: Instant, stage: &mut RenderStage) -> Option<Duration> {
    let since = now.saturating_duration_since(opened?);
    let shortest = if stage.device().is_software() { PACE } else { FASTEST };
    (since < shortest).then(|| shortest - since)
}

fn write(picture: &image::RgbaImage, path: &Path) -> Result<(), String> {
    picture
        .save_with_format(path, image::ImageFormat::Png)
        .map_err(|error| format!("{}: {error}", path.display()))
}

/// Draws one pass.
#[derive(Clone)]
pub struct Drawer {
    stage: Rc<RefCell<RenderStage>>,
    pass: SharedPass,
}

impl Worker for Drawer {
    fn update(&mut self, thread: &mut Context) -> bool {
        let drawn = self.stage.borrow_mut().draw(&mut *self.pass.borrow_mut());
        if !drawn {
            // The next iteration checks the device.
            thread.iterate_again();
        }
        drawn
    }
}

/// Presents the frame that the passes drew.
pub struct Present {
    stage: Rc<RefCell<RenderStage>>,
    replies: Address<GraphicsReply>,
    statistics: Rc<RefCell<Statistics>>,
}

impl Worker for Present {
    fn update(&mut self, thread: &mut Context) -> bool {
        let mut stage = self.stage.borrow_mut();
        if !stage.present() {
            thread.iterate_again();
            return false;
        }
        let now = thread.now();
        let warnings = stage.take_warnings();
        if !warnings.is_empty() {
            let title = stage.scene.view().map(|view| view.file.title.clone()).unwrap_or_default();
            let _ = self.replies.send(GraphicsReply::Images { title, warnings });
        }
        if stage.wants_frame(now) {
            thread.iterate_again();
        }
        let mut statistics = self.statistics.borrow_mut();
        let is_due =
            statistics.reported.is_none_or(|reported| now.saturating_duration_since(reported) >= STATISTICS);
        if is_due && let Some(opened) = statistics.opened {
            statistics.reported = Some(now);
            let milliseconds = now.saturating_duration_since(opened).as_secs_f32() * 1000.0;
            let _ = self.replies.send(GraphicsReply::Statistics { frames: stage.frames(), milliseconds });
        }
        true
    }
}
