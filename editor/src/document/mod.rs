//! The document: what is open, and what everybody may read of it.

mod about;
pub mod adapter;
mod cancel;
pub mod edit;
mod editable;
mod folder;
pub mod history;
pub mod images;
mod import;
mod job;
mod load;
mod open;
mod owner;
mod view;

pub use cancel::{Cancel, Progress, Stage};
pub use editable::{Editable, SaveError, SavePlan, Written, make_folder};
pub use folder::{DoorError, Folder, read_file};
pub use load::{LoadError, Loader, Source, load_model};
pub use open::Change;
pub use owner::{Document, DocumentHandle, DocumentMessage, DocumentReply};
pub use view::{DecodedImage, HistoryView, LoadedModel, View};
