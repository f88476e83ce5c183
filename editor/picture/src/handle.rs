//! The handle of the graphics thread for other threads: each method of [`Graphics`](super::Graphics) sends a message.

use super::error::GraphicsError;
use super::message::{GraphicsMessage, Look, PanelsFrame};
use super::surface::WindowSurface;
use super::thumbnail::ThumbnailOrder;
use crate::camera::Camera;
use crate::pick::region::OwnedRegion;
use crate::playback::PlaybackClock;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use dragonfly_runtime::{Address, Thread, ThreadHandle};
use std::path::PathBuf;
use std::sync::Arc;

/// A handle of the graphics thread. Cheap to clone; every method returns at once. Messages to a thread that has
/// stopped are dropped. The thread stops when the last handle is dropped.
#[derive(Clone)]
pub struct GraphicsHandle {
    thread: ThreadHandle,
    address: Address<GraphicsMessage>,
    views: Address<View>,
    /// Address for cameras: a new camera replaces one that is still queued. The addresses below do the same for their
    /// messages.
    camera: Address<GraphicsMessage>,
    look: Address<GraphicsMessage>,
    playback: Address<GraphicsMessage>,
    size: Address<GraphicsMessage>,
    /// `None` if another owner has the thread.
    _owner: Option<Arc<Thread>>,
}

impl GraphicsHandle {
    pub(super) fn new(
        thread: ThreadHandle,
        address: Address<GraphicsMessage>,
        views: Address<View>,
        owner: Option<Thread>,
    ) -> Self {
        let [camera, look, playback, size] = [(); 4].map(|()| address.latest());
        Self { thread, address, views, camera, look, playback, size, _owner: owner.map(Arc::new) }
    }

    /// The graphics thread.
    pub fn thread(&self) -> &ThreadHandle {
        &self.thread
    }

    /// Stops the thread, after everything that was sent to it before.
    pub fn stop(&self) {
        self.thread.remote_stop();
    }

    /// Sends a message. Of waiting cameras, looks, playbacks and sizes, only the newest is kept.
    pub fn send(&self, message: GraphicsMessage) {
        let address = match &message {
            GraphicsMessage::Camera(_) => &self.camera,
            GraphicsMessage::Look(_) => &self.look,
            GraphicsMessage::Play(_) => &self.playback,
            GraphicsMessage::Resized(_) => &self.size,
            _ => &self.address,
        };
        // The thread has stopped, so the message is not needed.
        let _ = address.send(message);
    }

    /// Address to which the document sends its views directly, without a detour over another thread.
    pub fn views(&self) -> &Address<View> {
        &self.views
    }

    /// Shows `view` from now on.
    pub fn show(&self, view: View) {
        self.send(GraphicsMessage::Show(view));
    }

    /// Shows this time of this take.
    pub fn play(&self, playback: PlaybackClock) {
        self.send(GraphicsMessage::Play(playback));
    }

    /// Sets the camera.
    pub fn set_camera(&self, camera: Camera) {
        self.send(GraphicsMessage::Camera(camera));
    }

    /// Sets the look.
    pub fn set_look(&self, look: Look) {
        self.send(GraphicsMessage::Look(Box::new(look)));
    }

    /// Shows these bones at rest, and all others animated.
    pub fn hold_still(&self, bones: Vec<BoneIndex>) {
        self.send(GraphicsMessage::Still(bones));
    }

    /// Shows these panels. None of these messages is dropped, because each may contain textures that are sent only
    /// once.
    pub fn show_panels(&self, frame: PanelsFrame) {
        self.send(GraphicsMessage::Panels(Box::new(frame)));
    }

    /// Sets the size of the window, physical pixels.
    pub fn resize(&self, size: [u32; 2]) {
        self.send(GraphicsMessage::Resized(size));
    }

    /// Requests the bone at a pixel of the window.
    pub fn pick(&self, position: [f32; 2], ticket: u64) {
        self.send(GraphicsMessage::Pick { position, ticket });
    }

    /// Requests all bones at a pixel of the window.
    pub fn pick_all(&self, position: [f32; 2], ticket: u64) {
        self.send(GraphicsMessage::PickAll { position, ticket });
    }

    /// Requests the bones in a region of the viewport, points from its top left.
    pub fn catch(&self, region: OwnedRegion, ticket: u64) {
        self.send(GraphicsMessage::Catch { region, ticket });
    }

    /// Requests a small picture of a shot.
    pub fn draw_thumbnail(&self, order: ThumbnailOrder) {
        self.send(GraphicsMessage::Thumbnail(order));
    }

    /// Resumes drawing the scene after a pause.
    pub fn resume(&self) {
        self.send(GraphicsMessage::Resume);
    }

    /// Answers [`GraphicsReply::NeedsSurface`](super::GraphicsReply::NeedsSurface).
    pub fn set_surface(&self, surface: Result<WindowSurface, GraphicsError>) {
        self.send(GraphicsMessage::Surface(Box::new(surface)));
    }

    /// Writes the whole window as a PNG file.
    pub fn capture(&self, path: PathBuf) {
        self.send(GraphicsMessage::Capture(path));
    }
}
