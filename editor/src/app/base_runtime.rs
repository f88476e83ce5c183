//! What a program built on [`super::MainRuntime`] provides (thesis §3.2.4.3).

use super::interface::Interface;
use dragonfly_picture::{GraphicsHandle, GraphicsReply};
use dragonfly_runtime::Context;
use std::cell::RefCell;
use std::rc::Rc;

/// What the custom run-time gets to work with.
#[derive(Clone)]
pub struct Parts {
    /// Window, panels, input.
    pub interface: Rc<RefCell<Interface>>,
    /// The graphics thread.
    pub graphics: GraphicsHandle,
}

/// A custom run-time: the editor's is [`super::EditorRuntime`].
pub trait BaseRuntime {
    /// Everything is there: begin. Called once, in the main thread.
    fn initialize(&mut self, parts: Parts, main: &mut Context);

    /// The graphics thread said something else than that it is ready.
    fn graphics_said(&mut self, reply: GraphicsReply, main: &mut Context);

    /// Sends out what followed from input of the window, without waiting until the panels are drawn.
    fn flush_effects(&mut self) {}

    /// One turn of the main loop, after the window had its own.
    fn update(&mut self, main: &mut Context);

    /// The end is near: give back everything. Input is off already, graphics still there.
    fn destroy(&mut self, main: &mut Context);
}
