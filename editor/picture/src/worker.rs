//! The graphics thread's workers (thesis §3.2.4.2): first [`Graphics`], which opens the frame, then one drawer per
//! pass, and last [`Present`]. A worker that cannot do its part ends the iteration, so an unfinished frame is never
//! presented.

use super::device::DeviceParameters;
use super::error::GraphicsError;
use super::guard::caught;
use super::message::{GraphicsMessage, GraphicsReply};
use super::pass::SharedPass;
use super::pick::{pick, pick_region};
use super::stage::{DeviceEvent, FrameOpening, RenderStage};
use super::{GraphicsHandle, Look};
use crate::camera::Camera;
use crate::playback::PlaybackClock;
use dragonfly_document::{FaultInjection, FaultPoint, View};
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use std::cell::RefCell;
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
    parameters: Option<DeviceParameters>,
    replies: Address<GraphicsReply>,
    stage: Option<Rc<RefCell<RenderStage>>>,
    /// Messages that arrived before the device was ready.
    waiting: Vec<GraphicsMessage>,
    captures: Vec<PathBuf>,
    statistics: Rc<RefCell<Statistics>>,
    failed: bool,
    faults: FaultInjection,
}

/// Times of frames, shared with the presenter.
#[derive(Debug, Default)]
struct Statistics {
    opened: Option<Instant>,
    reported: Option<Instant>,
}

impl Graphics {
    /// Starts the graphics thread (T-133), whose replies go to `replies`. The device for a window of `size` physical
    /// pixels is created at the first call in that thread, which replies [`GraphicsReply::Ready`] or
    /// [`GraphicsReply::Fatal`].
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
                parameters: Some(parameters),
                replies,
                stage: None,
                waiting: vec![GraphicsMessage::Resized(size)],
                captures: Vec::new(),
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

    /// First call in the thread: creates the device and the workers that draw with it.
    fn initialize(&mut self, thread: &mut Context) -> bool {
        let Some(parameters) = self.parameters.take() else { return false };
        let now = thread.now();
        let mut stage = match caught(|| RenderStage::new(parameters, now)) {
            Ok(Ok(stage)) => stage,
            Ok(Err(error)) => return self.fail(&error.to_string()),
            Err(panic) => return self.fail(&panic),
        };
        let adapter = stage.device().adapter_name();
        let max_texture_side = stage.device().gpu().max_side;
        tracing::info!(%adapter, "graphics device created");
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
        self.reply(GraphicsReply::Ready { adapter, max_texture_side });
        for message in std::mem::take(&mut self.waiting) {
            self.handle(message, thread);
        }
        // The drawers are called from the next iteration on.
        thread.iterate_again();
        false
    }

    fn draw_again(&self) {
        if let Some(stage) = &self.stage {
            stage.borrow_mut().touch_window();
        }
    }

    fn fail(&mut self, reason: &str) -> bool {
        tracing::error!(reason, "no graphics");
        self.failed = true;
        self.waiting.clear();
        self.reply(GraphicsReply::Fatal(reason.to_owned()));
        false
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
            stage.scene.look = look;
            stage.touch_scene();
        }
    }

    fn tell_events(&self, stage: &mut RenderStage) {
        for event in stage.take_events() {
            let losses = stage.device().losses();
            self.reply(match event {
                DeviceEvent::Recovered(reason) => GraphicsReply::Recovered { reason, losses },
                DeviceEvent::Paused(reason) => GraphicsReply::Paused { reason },
            });
        }
    }

    fn gone(&mut self, error: &GraphicsError) -> bool {
        self.stage = None;
        self.fail(&error.to_string())
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
            if !self.failed {
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
                let bone = pick(&stage.scene, position);
                self.reply(GraphicsReply::Picked { bone, ticket });
            }
            GraphicsMessage::PickAll { position, ticket } => {
                stage.scene.prepare(thread.now());
                let bones = stage.scene.pick_all(position);
                self.reply(GraphicsReply::PickedAll { bones, ticket });
            }
            GraphicsMessage::Catch { region, ticket } => {
                stage.scene.prepare(thread.now());
                let hidden = Arc::clone(&stage.scene.look.hidden);
                let mut bones = Vec::new();
                pick_region(&stage.scene, &region.region(), &hidden, &mut bones);
                self.reply(GraphicsReply::PickedAll { bones, ticket });
            }
            GraphicsMessage::Appearance(appearance) => {
                stage.scene.appearances.receive(appearance);
                stage.touch_scene();
            }
            GraphicsMessage::Resume => stage.resume(),
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
        let Some(stage) = self.stage.clone() else { return self.initialize(thread) };
        let stage = &mut *stage.borrow_mut();
        let now = thread.now();
        if self.faults.loses_device(stage.frames(), stage.moves(now)) {
            stage.device().lose();
            stage.touch_window();
        }
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
                if stage.moves(now) {
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
            FrameOpening::Gone(error) => self.gone(&error),
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
