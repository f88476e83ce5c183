//! The graphics thread as other threads see it: the methods of [`Graphics`](super::Graphics), each of which sends a message.

use super::message::{Appearance, GraphicsMessage, Look, PanelsFrame};
use crate::camera::Camera;
use crate::pick::OwnedRegion;
use crate::playback::Playback;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use dragonfly_runtime::{Address, Thread, ThreadHandle};
use std::path::PathBuf;
use std::sync::Arc;

/// Cheap to clone; every method returns at once. What is sent to a thread that has stopped is dropped: there is nothing
/// left to show it in. The thread stops when the last handle goes.
#[derive(Clone)]
pub struct GraphicsHandle {
    thread: ThreadHandle,
    address: Address<GraphicsMessage>,
    views: Address<View>,
    /// Where the newest camera takes the place of one that waits; likewise the others.
    camera: Address<GraphicsMessage>,
    look: Address<GraphicsMessage>,
    playback: Address<GraphicsMessage>,
    size: Address<GraphicsMessage>,
    /// `None` where somebody else owns the thread.
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

    /// Its thread.
    pub fn thread(&self) -> &ThreadHandle {
        &self.thread
    }

    /// Ends the thread, after everything that was sent to it before.
    pub fn stop(&self) {
        self.thread.remote_stop();
    }

    /// Sends a message; of cameras, looks, times and sizes that wait, the newest is enough.
    pub fn send(&self, message: GraphicsMessage) {
        let address = match &message {
            GraphicsMessage::Camera(_) => &self.camera,
            GraphicsMessage::Look(_) => &self.look,
            GraphicsMessage::Play(_) => &self.playback,
            GraphicsMessage::Resized(_) => &self.size,
            _ => &self.address,
        };
        // The thread has stopped, and nothing is to be done about it.
        let _ = address.send(message);
    }

    /// Where the document shows its states, so that no other thread has to carry them.
    pub fn views(&self) -> &Address<View> {
        &self.views
    }

    /// Shows `view` instead of what is shown.
    pub fn show(&self, view: View) {
        self.send(GraphicsMessage::Show(view));
    }

    /// Shows this time of this take.
    pub fn play(&self, playback: Playback) {
        self.send(GraphicsMessage::Play(playback));
    }

    /// Looks from there.
    pub fn set_camera(&self, camera: Camera) {
        self.send(GraphicsMessage::Camera(camera));
    }

    /// Draws like that.
    pub fn set_look(&self, look: Look) {
        self.send(GraphicsMessage::Look(Box::new(look)));
    }

    /// Shows these bones at rest, and all others as they move.
    pub fn hold_still(&self, bones: Vec<BoneIndex>) {
        self.send(GraphicsMessage::Still(bones));
    }

    /// Shows these panels. All of them arrive: each may bring textures that come only once.
    pub fn show_panels(&self, frame: PanelsFrame) {
        self.send(GraphicsMessage::Panels(Box::new(frame)));
    }

    /// The window has this many physical pixels.
    pub fn resize(&self, size: [u32; 2]) {
        self.send(GraphicsMessage::Resized(size));
    }

    /// Asks which bone is at a pixel of the window.
    pub fn pick(&self, position: [f32; 2], ticket: u64) {
        self.send(GraphicsMessage::Pick { position, ticket });
    }

    /// Asks which bones are at a pixel of the window.
    pub fn pick_all(&self, position: [f32; 2], ticket: u64) {
        self.send(GraphicsMessage::PickAll { position, ticket });
    }

    /// Asks which bones are in a part of the viewport, points from its top left.
    pub fn catch(&self, region: OwnedRegion, ticket: u64) {
        self.send(GraphicsMessage::Catch { region, ticket });
    }

    /// Lets a control of the scene look like this.
    pub fn show_control(&self, appearance: Appearance) {
        self.send(GraphicsMessage::Control(Box::new(appearance)));
    }

    /// Loses the device on purpose.
    pub fn lose_device(&self) {
        self.send(GraphicsMessage::LoseDevice);
    }

    /// Draws the scene again after a pause.
    pub fn resume(&self) {
        self.send(GraphicsMessage::Resume);
    }

    /// Writes the whole window as a PNG.
    pub fn capture(&self, path: PathBuf) {
        self.send(GraphicsMessage::Capture(path));
    }
}
