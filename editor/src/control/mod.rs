//! How a person acts on the picture: what the mouse does there, as a machine that needs no window to be tested.

mod base;
mod cycle;
pub mod expression;
mod framework;
pub mod gizmo;
mod input;
mod key;
pub mod path;
mod places;
mod viewport;
pub mod viewport_tools;

pub use base::{Area, BaseControl, ControlId, Controls, Mouse, Pass, PassFlags};
pub use cycle::ClickCycle;
pub use framework::ControlFramework;
pub use input::{InputEvent, PlaceError};
pub use key::{Key, Modifiers};
pub(crate) use viewport::orbit;
pub use viewport::{Button, Catch, Outcome, ViewportControl};
pub use viewport_tools::ViewportTools;
