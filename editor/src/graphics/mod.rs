//! Everything that lives in the graphics thread.

mod message;

pub use message::{BoneLook, GraphicsMessage, GraphicsReply, Look, PanelsFrame, Shading};
