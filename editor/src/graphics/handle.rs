//! The graphics thread as other threads see it: the methods of [`Graphics`](super::Graphics), each of which sends a message.

use super::message::{GraphicsMessage, Look, PanelsFrame};
use crate::camera::Camera;
use crate::document::LoadedModel;
use crate::playback::Playback;
use dragonfly_runtime::Address;
use std::path::PathBuf;
use std::sync::Arc;

/// Cheap to clone; every method returns at once. What is sent to a thread that has stopped is dropped: there is nothing
/// left to show it in.
#[derive(Clone, Debug)]
pub struct GraphicsHandle {
    address: Address<GraphicsMessage>,
    /// Where the newest camera takes the place of one that waits; likewise the others.
    camera: Address<GraphicsMessage>,
    look: Address<GraphicsMessage>,
    playback: Address<GraphicsMessage>,
    size: Address<GraphicsMessage>,
}

impl GraphicsHandle {
    /// A handle of the graphics at `address`.
    pub fn new(address: Address<GraphicsMessage>) -> Self {
        let latest = || address.latest();
        Self { camera: latest(), look: latest(), playback: latest(), size: latest(), address }
    }

    /// Shows `loaded` instead of what is shown.
    pub fn show_model(&self, loaded: Arc<LoadedModel>) {
        let _ = self.address.send(GraphicsMessage::ShowModel(loaded));
    }

    /// Shows this time of this take.
    pub fn play(&self, playback: Playback) {
        let _ = self.playback.send(GraphicsMessage::Play(playback));
    }

    /// Looks from there.
    pub fn set_camera(&self, camera: Camera) {
        let _ = self.camera.send(GraphicsMessage::Camera(camera));
    }

    /// Draws like that.
    pub fn set_look(&self, look: Look) {
        let _ = self.look.send(GraphicsMessage::Look(Box::new(look)));
    }

    /// Shows these panels. All of them arrive: each may bring textures that come only once.
    pub fn show_panels(&self, frame: PanelsFrame) {
        if let Err(error) = self.address.send(GraphicsMessage::Panels(Box::new(frame)))
            && let GraphicsMessage::Panels(mut frame) = error.into_inner()
        {
            // egui insists that textures are not forgotten by mistake; here it is on purpose.
            frame.textures.clear();
        }
    }

    /// The window has this many physical pixels.
    pub fn resize(&self, size: [u32; 2]) {
        let _ = self.size.send(GraphicsMessage::Resized(size));
    }

    /// Asks which bone is at a pixel of the window.
    pub fn pick(&self, position: [f32; 2], ticket: u64) {
        let _ = self.address.send(GraphicsMessage::Pick { position, ticket });
    }

    /// Loses the device on purpose.
    pub fn lose_device(&self) {
        let _ = self.address.send(GraphicsMessage::LoseDevice);
    }

    /// Draws the scene again after a pause.
    pub fn resume(&self) {
        let _ = self.address.send(GraphicsMessage::Resume);
    }

    /// Writes the whole window as a PNG.
    pub fn capture(&self, path: PathBuf) {
        let _ = self.address.send(GraphicsMessage::Capture(path));
    }
}
