//! The viewport, in the graphics thread.

use super::{PanelHandle, View};
use crate::design::skeleton::{self, Line, Point};
use dragonfly_runtime::{Context, Receiver, Worker};

/// Called with each image.
pub type Screen = Box<dyn FnMut(&[Line])>;

/// The messages of the viewport.
pub enum ViewportMessage {
    /// Show this view from now on.
    Show(View),
    /// A request for the bone at this point. The panel receives the answer.
    Pick(Point),
}

/// Draws the newest view.
pub struct Viewport {
    newest: Option<View>,
    picture: Vec<Line>,
    panel: PanelHandle,
    screen: Screen,
}

impl Viewport {
    /// Returns a viewport without a view.
    pub fn new(panel: PanelHandle, screen: Screen) -> Self {
        Self { newest: None, picture: Vec::new(), panel, screen }
    }

    /// Draws `view` in the next frame, unless a newer one arrives before.
    pub fn show(&mut self, view: View) {
        self.newest = Some(view);
    }

    /// Sends the panel the bone at `point` in the last image.
    pub fn pick(&self, point: Point) {
        self.panel.picked(skeleton::pick(&self.picture, point));
    }
}

impl Receiver for Viewport {
    type Message = ViewportMessage;

    fn receive(&mut self, message: ViewportMessage, _: &mut Context) {
        match message {
            ViewportMessage::Show(view) => self.show(view),
            ViewportMessage::Pick(point) => self.pick(point),
        }
    }
}

impl Worker for Viewport {
    fn update(&mut self, _: &mut Context) -> bool {
        if let Some(view) = self.newest.take() {
            self.picture = skeleton::draw(&view);
            (self.screen)(&self.picture);
        }
        true
    }
}
