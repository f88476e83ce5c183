//! The controls in the viewport: a state machine of what the mouse does there, testable without a window.

mod area;
mod base;
pub(crate) mod drag;
pub mod expression;
mod framework;
pub mod gizmo;
mod input;
mod key;
pub mod line;
pub mod path;
pub mod path_point;
pub mod path_points;
mod places;
mod point_drag;
mod viewport;
pub mod viewport_tools;

pub use area::{Area, ControlId};
pub use base::{BaseControl, ControlLookup, InputFlow, Mouse, PassFlags};
pub use framework::ControlFramework;
pub use input::{Button, InputEvent, PlaceError};
pub use key::{Key, Modifiers};
pub(crate) use viewport::orbit;
pub use viewport::{Catch, ViewportControl, ViewportOutcome};
pub use viewport_tools::{ToolOutcome, ToolScene, ViewportTool, ViewportTools};
