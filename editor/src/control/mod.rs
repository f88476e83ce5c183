//! How a person acts on the picture: what the mouse does there, as a machine that needs no window to be tested.

mod base;
pub mod expression;
mod framework;
pub mod gizmo;
pub mod hands;
mod input;
mod key;
pub mod path;
mod places;
mod viewport;

pub use base::{Area, BaseControl, ControlId, Controls, Mouse, Pass, PassFlags};
pub use framework::ControlFramework;
pub use hands::Hands;
pub use input::{InputEvent, PlaceError};
pub use key::{Key, Modifiers};
pub(crate) use viewport::orbit;
pub use viewport::{Button, Catch, Outcome, ViewportControl};
