//! The handle of a window is asked for in the thread that created the window, and in no other: Windows and macOS give it
//! to no other.

use dragonfly_kit::eventually;
use dragonfly_picture::{
    Connection, DeviceParameters, Graphics, GraphicsHandle, GraphicsReply, SurfaceSource, TargetWindow,
    WindowSurface,
};
use dragonfly_runtime::{Context, Receiver, Thread};
use std::cell::RefCell;
use std::marker::PhantomData;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread::ThreadId;
use std::time::Duration;
use wgpu::rwh::{DisplayHandle, HandleError, HasDisplayHandle, HasWindowHandle, WindowHandle};

/// A window that records the threads in which its handle is asked for, and has none.
struct RecordingWindow(Sender<ThreadId>);

impl HasWindowHandle for RecordingWindow {
    fn window_handle(&self) -> Result<WindowHandle<'_>, HandleError> {
        self.0.send(std::thread::current().id()).expect("the test listens");
        Err(HandleError::Unavailable)
    }
}

impl HasDisplayHandle for RecordingWindow {
    fn display_handle(&self) -> Result<DisplayHandle<'_>, HandleError> {
        Ok(DisplayHandle::windows())
    }
}

impl TargetWindow for RecordingWindow {
    fn pre_present_notify(&self) {}
}

/// The main thread's side: answers requests for a surface and keeps the other replies.
struct WindowOwner {
    surfaces: SurfaceSource,
    graphics: Option<GraphicsHandle>,
    replies: Vec<GraphicsReply>,
}

impl Receiver for WindowOwner {
    type Message = GraphicsReply;

    fn receive(&mut self, reply: GraphicsReply, _: &mut Context) {
        match (reply, &self.graphics) {
            (GraphicsReply::NeedsSurface(instance), Some(graphics)) => {
                graphics.set_surface(self.surfaces.surface(&instance));
            }
            (reply, _) => self.replies.push(reply),
        }
    }
}

#[test]
fn only_the_thread_of_the_window_asks_for_its_handle() {
    let (asked, asks) = channel();
    let window = Arc::new(RecordingWindow(asked));
    let connection = Connection::beside(Arc::clone(&window) as _);
    let mut main = Thread::capture("main", || {});
    let owner = Rc::new(RefCell::new(WindowOwner {
        surfaces: SurfaceSource::new(window, connection.clone()),
        graphics: None,
        replies: Vec::new(),
    }));
    let address = main.context().register_receiver(Rc::clone(&owner));
    let parameters = DeviceParameters { connection: Some(connection), ..DeviceParameters::default() };
    let graphics = Graphics::start(parameters, [64, 64], address).expect("a thread");
    owner.borrow_mut().graphics = Some(graphics.clone());
    eventually(Duration::from_secs(60), || {
        main.iterate();
        !owner.borrow().replies.is_empty()
    });
    let replies = std::mem::take(&mut owner.borrow_mut().replies);
    assert!(matches!(&replies[..], [GraphicsReply::Fatal(_)]), "the window has no handle: {replies:?}");
    let asks: Vec<ThreadId> = asks.try_iter().collect();
    assert_eq!(asks, [std::thread::current().id()], "asked once, and here");
    graphics.stop();
}

/// Whether a type may be sent to another thread: the answer of this trait, unless the type has one of its own.
trait StaysInItsThread {
    fn is_send() -> bool {
        false
    }
}

struct Probe<T>(PhantomData<T>);

impl<T> StaysInItsThread for Probe<T> {}

impl<T: Send> Probe<T> {
    fn is_send() -> bool {
        true
    }
}

#[test]
fn the_source_of_surfaces_cannot_be_sent_to_another_thread() {
    assert!(Probe::<Connection>::is_send(), "the graphics thread gets it");
    assert!(Probe::<WindowSurface>::is_send(), "and a finished surface");
    assert!(!Probe::<SurfaceSource>::is_send(), "but not what asks for the handle");
}
