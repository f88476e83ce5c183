//! Interim: drives the stage in the second thread until the graphics module brings its own workers.

use crate::graphics::stage::{Event, Opened, Stage};
use crate::graphics::surface::SurfaceSource;
use crate::graphics::{DeviceParameters, GraphicsMessage, GraphicsReply};
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The graphics thread's own object.
pub struct Graphics {
    source: Option<SurfaceSource>,
    stage: Option<Stage>,
    size: [u32; 2],
    waiting: Vec<GraphicsMessage>,
    replies: Address<GraphicsReply>,
    told: Instant,
    last: f32,
}

/// As other threads see it.
#[derive(Clone)]
pub struct GraphicsHandle {
    _thread: Arc<Thread>,
    handle: ThreadHandle,
    address: Address<GraphicsMessage>,
}

impl Graphics {
    /// Starts the thread.
    pub fn start(source: SurfaceSource, size: [u32; 2], replies: Address<GraphicsReply>) -> std::io::Result<GraphicsHandle> {
        let thread = Thread::start("graphics")?;
        let handle = thread.handle().clone();
        let address = handle.reserve_address();
        let at = address.clone();
        let _ = handle.run(move |context| {
            let graphics = Rc::new(RefCell::new(Self {
                source: Some(source),
                stage: None,
                size,
                waiting: Vec::new(),
                replies,
                told: Instant::now(),
                last: 0.0,
            }));
            context.register_receiver_at(&at, Rc::clone(&graphics));
            context.register_worker(graphics);
        });
        Ok(GraphicsHandle { _thread: Arc::new(thread), handle, address })
    }

    fn apply(&mut self, message: GraphicsMessage) {
        let Some(stage) = &mut self.stage else {
            self.waiting.push(message);
            return;
        };
        match message {
            GraphicsMessage::ShowModel(loaded) => {
                stage.scene.show_model(loaded.clone());
                for pass in stage.passes() {
                    let _ = pass;
                }
                stage.touch_scene();
            }
            GraphicsMessage::Play(playback) => {
                stage.scene.playback = playback;
                stage.touch_scene();
            }
            GraphicsMessage::Camera(camera) => {
                stage.scene.camera = camera;
                stage.touch_scene();
            }
            GraphicsMessage::Look(look) => {
                stage.scene.look = *look;
                stage.touch_scene();
            }
            GraphicsMessage::Panels(frame) => {
                stage.panels().borrow_mut().show(frame);
                stage.touch_window();
            }
            GraphicsMessage::Resized(size) => stage.resize(size),
            GraphicsMessage::Pick { ticket, .. } => {
                let _ = self.replies.send(GraphicsReply::Picked { bone: None, ticket });
            }
            GraphicsMessage::LoseDevice => stage.device().lose(),
            GraphicsMessage::Resume => stage.resume(),
            GraphicsMessage::Capture(_) => {}
        }
    }
}

impl Receiver for Graphics {
    type Message = GraphicsMessage;

    fn receive(&mut self, message: GraphicsMessage, _thread: &mut Context) {
        self.apply(message);
    }
}

impl Worker for Graphics {
    fn update(&mut self, thread: &mut Context) -> bool {
        if let Some(source) = self.source.take() {
            match Stage::new(DeviceParameters { source: Some(source), ..DeviceParameters::default() }, Instant::now()) {
                Ok(mut stage) => {
                    stage.resize(self.size);
                    let adapter = stage.device().adapter_name();
                    let max_texture_side = stage.device().gpu().max_side;
                    self.stage = Some(stage);
                    let _ = self.replies.send(GraphicsReply::Ready { adapter, max_texture_side });
                    for message in std::mem::take(&mut self.waiting) {
                        self.apply(message);
                    }
                }
                Err(error) => {
                    let _ = self.replies.send(GraphicsReply::Fatal(error.to_string()));
                }
            }
        }
        let Some(stage) = &mut self.stage else { return true };
        let begun = Instant::now();
        if stage.wants_frame(begun) {
            if let Opened::Gone(error) = stage.whole_frame(begun) {
                let _ = self.replies.send(GraphicsReply::Fatal(error.to_string()));
            }
            self.last = begun.elapsed().as_secs_f32() * 1e3;
        }
        for event in stage.take_events() {
            let _ = self.replies.send(match event {
                Event::Recovered(reason) => GraphicsReply::Recovered { reason, losses: stage.device().losses() },
                Event::Paused(reason) => GraphicsReply::Paused { reason },
            });
        }
        if self.told.elapsed() > Duration::from_millis(500) {
            self.told = Instant::now();
            let _ = self.replies.send(GraphicsReply::Statistics { frames: stage.frames(), milliseconds: self.last });
        }
        let now = Instant::now();
        if stage.moves(now) {
            thread.wake_at(begun + Duration::from_millis(16));
        } else if stage.wants_frame(now) {
            thread.wake_at(now + Duration::from_millis(16));
        }
        true
    }
}

impl GraphicsHandle {
    /// Tells it something.
    pub fn send(&self, message: GraphicsMessage) {
        let _ = self.address.send(message);
    }

    /// Its thread.
    pub fn thread(&self) -> &ThreadHandle {
        &self.handle
    }

    /// Ends it.
    pub fn stop(&self) {
        self.handle.remote_stop();
    }
}
