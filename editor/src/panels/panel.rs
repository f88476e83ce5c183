//! The interface of a panel: an id, a title, a default position, and a function that draws it.

use super::context::PanelContext;
use super::request::Request;
use egui::Ui;

/// Id of the panel through which the viewport is seen.
pub const VIEWPORT: &str = "viewport";

/// Position of a panel before the user moves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PanelPlace {
    /// Upper left.
    Left,
    /// Lower left.
    LeftBelow,
    /// The middle.
    Middle,
    /// The right edge.
    Right,
    /// Along the lower edge.
    Below,
    /// Along the lower edge, at the right.
    BelowRight,
}

/// The kind of document for which a panel is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PanelSubject {
    /// A model, or nothing yet.
    Model,
    /// A scene.
    Scene,
    /// Either.
    Any,
}

impl PanelSubject {
    /// Returns whether a panel is shown while a scene is open, or while none is.
    pub fn fits(self, is_scene: bool) -> bool {
        match self {
            Self::Model => !is_scene,
            Self::Scene => is_scene,
            Self::Any => true,
        }
    }
}

/// A part of the window.
pub trait Panel {
    /// Returns its name in files; never changes.
    fn id(&self) -> &'static str;

    /// Returns its name on the screen.
    fn title(&self) -> &'static str;

    /// Returns its position before the user moves it.
    fn place(&self) -> PanelPlace;

    /// Returns the kind of document for which it is shown.
    fn subject(&self) -> PanelSubject {
        PanelSubject::Model
    }

    /// Draws it. What the user did is pushed to `requests`.
    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>);
}
