//! Handles the messages by which the graphics thread and the custom run-time learn of each other (thesis §3.2.4.4).

use super::base_runtime::{BaseRuntime, Parts};
use super::timeline::{Step, StepTrace};
use dragonfly_picture::{GraphicsHandle, GraphicsReply, SurfaceSource};
use dragonfly_runtime::{Context, Receiver, Worker};
use std::cell::RefCell;
use std::rc::Rc;

/// Creates a custom run-time.
pub type MakeRuntime = Box<dyn FnOnce() -> Box<dyn BaseRuntime>>;

/// Waits for the graphics thread, then starts the custom run-time.
pub struct InitManager {
    prepared: Option<MakeRuntime>,
    runtime: Option<Box<dyn BaseRuntime>>,
    parts: Option<Parts>,
    /// Makes the surfaces of the window, which only this thread can.
    surfaces: SurfaceSource,
    graphics: Option<GraphicsHandle>,
    timeline: Rc<RefCell<StepTrace>>,
    fatal: Option<String>,
}

impl InitManager {
    /// Creates a manager that will start the run-time that `prepared` creates.
    pub fn new(prepared: MakeRuntime, surfaces: SurfaceSource, timeline: Rc<RefCell<StepTrace>>) -> Self {
        Self {
            prepared: Some(prepared),
            runtime: None,
            parts: None,
            surfaces,
            graphics: None,
            timeline,
            fatal: None,
        }
    }

    /// Sets the parts that the run-time will get.
    pub(super) fn set_parts(&mut self, parts: Parts) {
        self.graphics = Some(parts.graphics.clone());
        self.parts = Some(parts);
    }

    /// Returns the reason why nothing can be drawn, if the graphics thread has reported one.
    pub(super) fn fatal(&self) -> Option<&str> {
        self.fatal.as_deref()
    }

    /// Returns whether the run-time was started.
    pub(super) fn is_running(&self) -> bool {
        self.runtime.is_some()
    }

    /// Starts the run-time, now that the graphics thread is ready.
    fn initialize(&mut self, main: &mut Context) {
        let (Some(make), Some(parts)) = (self.prepared.take(), self.parts.take()) else { return };
        let reach = |step| self.timeline.borrow_mut().reach(step);
        reach(Step::GraphicsInitialisation);
        let mut runtime = make();
        reach(Step::EditorRuntime);
        runtime.initialize(parts, main);
        reach(Step::EditorRuntimeInitialisation);
        self.runtime = Some(runtime);
        reach(Step::RunTime);
    }

    /// Makes a surface for the graphics thread, which cannot: a window gives its handle only to the thread that created it.
    fn send_surface(&self, instance: &wgpu::Instance) {
        if let Some(graphics) = &self.graphics {
            tracing::info!("surface of the window made");
            graphics.set_surface(self.surfaces.surface(instance));
        }
    }

    /// Carries out the effects of window input; see [`BaseRuntime::flush_effects`].
    pub(super) fn flush_effects(&mut self) {
        if let Some(runtime) = &mut self.runtime {
            runtime.flush_effects();
        }
    }

    /// Ends the run-time, if it was started.
    pub(super) fn destroy(&mut self, main: &mut Context) {
        self.prepared = None;
        self.parts = None;
        self.graphics = None;
        if let Some(mut runtime) = self.runtime.take() {
            runtime.destroy(main);
            drop(runtime);
            self.timeline.borrow_mut().reach(Step::EditorRuntimeDestruction);
        }
    }
}

impl Receiver for InitManager {
    type Message = GraphicsReply;

    fn receive(&mut self, reply: GraphicsReply, main: &mut Context) {
        match &reply {
            GraphicsReply::Ready { .. } => self.initialize(main),
            GraphicsReply::Fatal(reason) => self.fatal = Some(reason.clone()),
            GraphicsReply::NeedsSurface(instance) => self.send_surface(instance),
            _ => {}
        }
        if let Some(runtime) = &mut self.runtime {
            runtime.graphics_said(reply, main);
        }
    }
}

impl Worker for InitManager {
    fn update(&mut self, main: &mut Context) -> bool {
        if let Some(runtime) = &mut self.runtime {
            runtime.update(main);
        }
        true
    }
}
