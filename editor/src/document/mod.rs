//! The document: what is open, and what everybody may read of it.

mod about;
pub mod adapter;
mod alike;
mod base;
mod cancel;
pub mod edit;
mod editable;
mod folder;
mod handle;
pub mod history;
pub mod images;
mod import;
mod job;
mod keeper;
mod load;
mod message;
mod offer;
mod open;
mod owner;
mod recorded;
mod recovering;
mod replay;
mod saving;
mod view;

pub use cancel::{Cancel, Progress, Stage};
pub use editable::{Editable, SaveError, SavePlan, Written, make_folder};
pub use folder::{DoorError, Folder, read_file};
pub use handle::DocumentHandle;
pub use load::{LoadError, Loader, Opened, Source, load_model, open_model};
pub use message::{DocumentMessage, DocumentReply};
pub use offer::Offer;
pub use open::Change;
pub use owner::{Document, Setup};
pub use recovering::Decision;
pub use saving::{NotSaved, SaveOrder, SaveTo, SavedFile, Then};
pub use view::{DecodedImage, FileView, HistoryView, LoadedModel, View};
