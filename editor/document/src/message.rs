//! The messages that other threads send to the document, and its replies.

use super::pose_library::{PoseFolder, PoseOrder};
use super::retarget_order::{MapFile, RetargetOrder};
use super::saving::{NotSaved, SaveOrder, SavedFile, Then};
use super::scan::Decision;
use super::take_check::{CheckedTake, TakeCheck};
use super::{
    BoneMap, ClipOrder, ExportOrder, ExportReport, LoadedModel, Offer, OutdatedEdits, OutdatedEditsChoice,
    Progress, SoundSource, Source, UnfitEdit, View,
};
use dragonfly_store::FileState;
use std::path::PathBuf;
use std::sync::Arc;

/// A message to the document about files: opening, saving, recovering. What is edited is sent as a [`Change`](super::Change).
#[derive(Clone, Debug, PartialEq)]
pub enum DocumentMessage {
    /// Opens a model in place of the open one. A model that is still loading is cancelled. Where the open one has unsaved work,
    /// the document replies [`DocumentReply::Unsaved`] instead; a scene that waits is shown before, as by [`Self::ShowScene`].
    Open {
        /// The model to open.
        source: Source,
        /// Opens it without asking: the user has decided. Unsaved work stays in the journal. The model of a scene that waits is read
        /// again.
        anyway: bool,
    },
    /// Cancels loading, the import of takes, and a save that copies the files of a scene into another folder.
    CancelLoading,
    /// Saves.
    Save(SaveOrder),
    /// Requests the list of what a save would change, and the save that follows once the user has seen it.
    Plan(Option<SaveOrder>),
    /// Opens the file again, which another program may have changed, and applies the unsaved edits to it. The reply is
    /// [`DocumentReply::Rebased`].
    Reload,
    /// Reverts to the saved state.
    Revert,
    /// Asks whether the program may end: the reply is [`DocumentReply::MayQuit`] or [`DocumentReply::Unsaved`]. A scene that waits is shown
    /// first, as by [`Self::ShowScene`].
    Quit,
    /// Discards the unsaved work of the open document: its journal goes to the trash folder when the document is closed. A scene that waits
    /// keeps its own.
    DoNotSave,
    /// Opens a model of the open scene to edit it; named as the script names it. The scene waits, with its history. The reply is
    /// [`DocumentReply::Opened`], with the edits that the project keeps as steps.
    EditModel(String),
    /// Shows the scene again, after [`Self::EditModel`]: a project keeps the edits that are not saved into the model, as one step, and plays
    /// them. The reply is [`DocumentReply::Opened`]; or [`DocumentReply::Refused`] where the edits would be lost.
    ShowScene,
    /// The user's decision about edits of a model that were made for another file. The model is opened as by [`Self::EditModel`] then.
    DecideOutdated(OutdatedEdits, OutdatedEditsChoice),
    /// The user's decision about edits of several models that were made for other files: one step of the scene, which is shown.
    DecideAllOutdated(Vec<OutdatedEdits>, OutdatedEditsChoice),
    /// Shows another script of the open project, by the name of its file.
    ShowScript(String),
    /// The lengths in seconds of sounds of the open scene, which were read to be shown: the plan has no other way to know when they end. `None`
    /// for one that cannot be read any more.
    SoundsRead(Vec<(SoundSource, Option<f64>)>),
    /// Checks whether another program changed the file.
    LookAtFile,
    /// Finds out which folders a save into this folder would create. The reply is [`DocumentReply::NewFolders`].
    LookAtFolder(PathBuf),
    /// Searches for unsaved work of earlier sessions, and replies also if there is none.
    Search,
    /// Reads another model, whose takes are wanted for the open one. The reply is [`DocumentReply::SourceRead`].
    ReadSource(Source),
    /// Reads another file, with whose takes those of the open model are compared. The reply is [`DocumentReply::ComparedRead`].
    ReadCompared(Source),
    /// Computes a take of that model for the open one, and adds it.
    Retarget(RetargetOrder),
    /// Imports all takes of files onto the open model, as one step.
    ImportTakes(ClipOrder),
    /// Writes files of any format from the open model, or finds out what they would lose. The reply is [`DocumentReply::Exported`].
    Export(ExportOrder),
    /// Reads or writes a bone map.
    MapFile(MapFile),
    /// Checks a take for defects. The reply is [`DocumentReply::Checked`].
    CheckTake(TakeCheck),
    /// Reads or changes the folder of the pose library. The reply is [`DocumentReply::Poses`].
    Poses(PoseOrder),
    /// The user's decision about unsaved work of an earlier session.
    Decide(Box<Offer>, Decision),
    /// The present path of the file that unsaved work belongs to. If it is that file, the work is restored there.
    FoundAt(Box<Offer>, PathBuf),
}

/// A reply of the document to the main thread, for the panels.
#[derive(Debug)]
pub enum DocumentReply {
    /// The newest state. It replaces one that is still queued, so it may overtake other replies.
    View(View),
    /// A model has been opened: sent once for each, in order with the other replies.
    Opened(Arc<LoadedModel>),
    /// The file was opened again with the unsaved edits; follows after [`DocumentReply::Opened`]. Contains the edits that do not fit.
    Rebased(Vec<UnfitEdit>),
    /// A model is loading, or the files of a scene are being copied into another folder.
    Loading {
        /// Its title.
        title: String,
        /// The progress so far.
        progress: Progress,
    },
    /// Loading was cancelled; the open model stays.
    Cancelled,
    /// Loading failed; the open model stays.
    Failed {
        /// The model that was to be opened.
        source: Source,
        /// Path and reason.
        reason: String,
    },
    /// An edit could not be applied, and nothing changed.
    Refused(String),
    /// The document was saved.
    Saved(SavedFile),
    /// The document was not saved; with the order that failed.
    NotSaved(SaveOrder, NotSaved),
    /// The changes that a save would write, one line each, or why it is impossible; and the save that follows once the
    /// user has seen them.
    Plan(Result<String, String>, Option<SaveOrder>),
    /// Something was not done because the open model has unsaved work: the user decides.
    Unsaved(Then),
    /// A model was not opened to edit it, because the edits that its project keeps were made for another file: the user decides.
    OutdatedEdits(OutdatedEdits),
    /// The models of the scene were read, and those of these edits have other files than those for which they were made: the user decides
    /// about all of them. Sent once for each model while a scene is open.
    ChangedModels(Vec<OutdatedEdits>),
    /// Nothing is unsaved: the program may end.
    MayQuit,
    /// Another program changed or deleted the file.
    FileChanged(FileState),
    /// The folders that a save into a folder creates, as a path in the one that exists; `None` where it creates none or fails.
    NewFolders {
        /// The folder.
        folder: PathBuf,
        /// The folders that are created.
        created: Option<PathBuf>,
    },
    /// Unsaved work of an earlier session can be restored.
    Offers(Vec<Offer>),
    /// The file at this path is not the one that the unsaved work belongs to.
    OtherFile(Box<Offer>, PathBuf),
    /// The user searched for unsaved work, and there is none.
    NothingToOffer,
    /// The model whose takes are wanted was read.
    SourceRead(Arc<LoadedModel>),
    /// The file to compare with was read.
    ComparedRead(Arc<LoadedModel>),
    /// A bone map was read.
    MapRead(BoneMap),
    /// Files were written from the open model, or would be; or the reason why they were not.
    Exported(ExportOrder, Result<ExportReport, String>),
    /// A take was checked.
    Checked(CheckedTake),
    /// The poses of a folder.
    Poses(PoseFolder),
    /// A message for the status line.
    Notice(String),
    /// A warning for the status line.
    Warning(String),
    /// An internal error closed the document. Recorded work is offered.
    Lost,
}
