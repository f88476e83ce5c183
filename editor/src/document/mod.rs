//! The document: what is open, and what everybody may read of it.

mod cancel;
mod folder;
pub mod images;
mod import;
mod job;
mod load;
mod owner;
mod view;

pub use cancel::{Cancel, Progress, Stage};
pub use folder::{DoorError, Folder, read_file};
pub use load::{LoadError, Loader, Source, load_model};
pub use owner::{Document, DocumentHandle, DocumentMessage, DocumentReply};
pub use view::{DecodedImage, LoadedModel, View};
