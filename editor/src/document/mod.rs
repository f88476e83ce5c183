//! The document: what is open, and what everybody may read of it.

mod folder;
mod view;

pub use folder::{DoorError, Folder, read_file};
pub use view::{DecodedImage, LoadedModel, View};
