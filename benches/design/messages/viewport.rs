//! The viewport, in the graphics thread.

use super::{PanelHandle, View};
use crate::design::skeleton::{self, Line, Point};
use dragonfly_runtime::{Context, Receiver, Worker};

/// Where pictures go.
pub type Screen = Box<dyn FnMut(&[Line])>;

/// What others may ask of the viewport.
pub enum ViewportMessage {
    /// Show this from now on.
    Show(View),
    /// Which bone is here? The panel gets the answer.
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
    /// A viewport that has nothing to show yet.
    pub fn new(panel: PanelHandle, screen: Screen) -> Self {
        Self { newest: None, picture: Vec::new(), panel, screen }
    }

    /// Draws `view` in the next frame, unless a newer one comes before.
    pub fn show(&mut self, view: View) {
        self.newest = Some(view);
    }

    /// Tells the panel which bone of the last picture is at `point`.
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
