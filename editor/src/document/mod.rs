//! The document: what is open, and what everybody may read of it.

mod view;

pub use view::{DecodedImage, LoadedModel, View};
