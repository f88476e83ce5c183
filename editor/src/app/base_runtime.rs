//! The interface between [`super::MainRuntime`] and the program that is built on it (thesis §3.2.4.3).

use super::interface::Interface;
use dragonfly_picture::{GraphicsHandle, GraphicsReply};
use dragonfly_runtime::Context;
use std::cell::RefCell;
use std::rc::Rc;

/// The parts that the custom run-time works with.
#[derive(Clone)]
pub struct Parts {
    /// Window, panels, input.
    pub interface: Rc<RefCell<Interface>>,
    /// The graphics thread.
    pub graphics: GraphicsHandle,
}

/// A custom run-time: the editor's is [`super::EditorRuntime`].
pub trait BaseRuntime {
    /// Starts the run-time, when all parts exist. Called once, in the main thread.
    fn initialize(&mut self, parts: Parts, main: &mut Context);

    /// Handles a reply of the graphics thread. The first is [`GraphicsReply::Ready`], right after
    /// [`initialize`](Self::initialize).
    fn graphics_said(&mut self, reply: GraphicsReply, main: &mut Context);

    /// Carries out the effects of window input, without waiting until the panels are drawn.
    fn flush_effects(&mut self) {}

    /// Called in every iteration of the main thread, after the worker that draws the panels.
    fn update(&mut self, main: &mut Context);

    /// Releases everything. Input is off already, the graphics thread still runs.
    fn destroy(&mut self, main: &mut Context);
}
