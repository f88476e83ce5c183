//! The document: what is open, and what everybody may read of it.

mod cancel;
mod folder;
pub mod images;
mod import;
mod load;
mod view;

pub use cancel::{Cancel, Progress, Stage};
pub use folder::{DoorError, Folder, read_file};
pub use load::{LoadError, Source, load_model};
pub use view::{DecodedImage, LoadedModel, View};
