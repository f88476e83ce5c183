//! How a person acts on the picture: what the mouse does there, as a machine that needs no window to be tested.

mod viewport;

pub(crate) use viewport::orbit;
pub use viewport::{Button, Input, Outcome, ViewportControl};
