//! What other threads may tell the document, and what it tells them.

use super::job::JobNews;
use super::recovering::{Decision, Scan};
use super::saving::{NotSaved, SaveOrder, SavedFile, Then};
use super::{Change, LoadedModel, Offer, Progress, Source, View};
use dragonfly_store::FileState;
use std::path::PathBuf;
use std::sync::Arc;

/// What other threads may tell the document.
#[derive(Debug)]
pub enum DocumentMessage {
    /// Opens a model in place of the one that is open; what is being loaded is given up. What is not saved stays in the
    /// journal.
    Open(Source),
    /// Gives up what is being loaded.
    CancelLoading,
    /// Edits what is open, undoes, does again.
    Change(Change),
    /// [`Self::Change`] whose sender waits for the outcome: the first view with [`View::answered`] at or above the number
    /// contains the change, or was made after it was refused. Numbers ascend and begin at 1.
    NumberedChange(u64, Change),
    /// Saves.
    Save(SaveOrder),
    /// What would a save write? And what is to come once a person has seen it?
    Plan(Option<SaveOrder>),
    /// Goes back to what was saved.
    Revert,
    /// The person wants to go on to this: is anything unsaved in the way?
    Leave(Then),
    /// The person does not want what is not saved: it goes into the bin when the document is closed.
    DoNotSave,
    /// Did somebody else change the file?
    LookAtFile,
    /// Looks for unsaved work of an earlier time, and says so if there is none.
    Search,
    /// What becomes of unsaved work of an earlier time.
    Decide(Box<Offer>, Decision),
    /// The file that unsaved work of an earlier time is about is here now; the work goes on there, if it is that file.
    FoundAt(Box<Offer>, PathBuf),
    /// From a job; `ticket` tells whether anybody still waits for it.
    #[doc(hidden)]
    News(u64, NewsBox),
    /// From the search for unsaved work.
    #[doc(hidden)]
    Found(ScanBox),
}

/// What a job says, opaque to others.
#[derive(Debug)]
pub struct NewsBox(pub(super) Box<JobNews>);

/// What was found, opaque to others.
#[derive(Debug)]
pub struct ScanBox(pub(super) Scan);

/// What the document tells the main thread, for the panels.
#[derive(Debug)]
pub enum DocumentReply {
    /// The newest state; it takes the place of one that still waits, so it may overtake what else is said.
    View(View),
    /// What was on its way is open: said once for each, in order with the other answers.
    Opened(Arc<LoadedModel>),
    /// A model is on its way.
    Loading {
        /// Its title.
        title: String,
        /// How far it is.
        progress: Progress,
    },
    /// Loading was given up on request; what was open still is.
    Cancelled,
    /// Loading failed; what was open still is.
    Failed {
        /// What was to be opened.
        source: Source,
        /// Place and reason.
        reason: String,
    },
    /// An edit could not be done, and nothing changed.
    Refused(String),
    /// It was saved.
    Saved(SavedFile),
    /// It was not; the order comes back.
    NotSaved(SaveOrder, NotSaved),
    /// What a save would write, a line each, or why it could not be; and what comes once that was seen.
    Plan(Result<String, String>, Option<SaveOrder>),
    /// Something unsaved is in the way (`true`), or nothing.
    Leave(Then, bool),
    /// Somebody else changed the file, or it is gone.
    FileChanged(FileState),
    /// Unsaved work of an earlier time can be had back.
    Offers(Vec<Offer>),
    /// The file at this path is not the one that the work was done on.
    OtherFile(Box<Offer>, PathBuf),
    /// A person looked for unsaved work, and there is none.
    NothingToOffer,
    /// Something that a person should know, quietly.
    Told(String),
    /// Something that they must know.
    Warned(String),
    /// The document was lost by a mistake in the program; what was recorded of it is offered.
    Lost,
}
