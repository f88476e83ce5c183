//! The document that Dragonfly edits.
//!
//! This crate owns the open model and every change of it: the vocabulary of edits ([`edit`]), the takes in their three forms
//! ([`adapter`]), undo and redo ([`history`]), loading, saving, the journal of unsaved work and its recovery, the thread that owns all of
//! this ([`Document`]), the protocol of `--stdio` ([`protocol`]), sets of bones ([`bones`]), posing by hand ([`posing`]), and the built-in
//! model ([`demo`]). Other threads send a
//! [`DocumentMessage`] or a [`Change`] and read the published [`View`].
//!
//! It must not know windows, panels or graphics: it depends on no crate of a user interface or of a GPU, so that the command line, tests
//! and other front ends can use it alone.

mod about;
pub mod adapter;
mod alike;
pub mod archive;
mod base;
mod base_skeleton;
mod beside;
mod bone_map;
pub mod bones;
mod cancel;
mod changed_models;
mod checked_models;
mod checked_sounds;
mod checking;
mod clip_import;
mod clip_news;
mod clip_order;
mod clips;
mod comparing;
mod conversion;
mod copied_files;
pub mod demo;
pub mod edit;
mod editable;
mod editable_write;
mod edited_content;
mod editing_models;
mod export;
mod exporting;
mod fault;
mod folder;
mod found_files;
mod handle;
pub mod history;
pub mod images;
mod import;
mod job;
mod journal_writer;
mod leaving;
mod line_names;
mod load;
mod loading_model;
mod merged_texts;
mod message;
mod needed_files;
mod new_folders;
mod offer;
mod open;
mod open_scene;
mod opening;
mod outdated_edits;
mod owner;
mod packing;
mod pose_files;
mod pose_library;
pub mod posing;
mod project_edits;
mod project_models;
mod project_notes;
pub mod protocol;
mod rebase;
mod rebasing;
mod receivers;
mod recorded;
mod recovering;
mod reference_source;
mod replay;
mod retarget_order;
mod retargeting;
mod running_save;
mod save_files;
mod save_job;
mod saving;
mod scan;
mod scene_check;
mod scene_files;
mod scene_includes;
mod scene_lines;
mod scene_model_source;
mod scene_models;
mod scene_source;
mod scene_view;
mod shapes;
mod sound;
mod source;
mod step_amount;
mod take_check;
mod take_thresholds;
pub mod text;
mod text_changes;
mod text_merge;
mod text_source;
mod thing_names;
mod unused;
mod view;
mod waiting_scene;
mod writing;
mod written_copies;

pub use bone_map::BoneMap;
pub use cancel::{Cancel, LoadStage, Progress};
pub use clip_order::ClipOrder;
pub use clips::{ClipNaming, ClipSettings, ClipTakes, TakeNames, clip_takes};
pub use conversion::{
    ConversionError, ConversionOrder, ConvertedFile, PreparedConversion, checked_preset, checked_textures,
    export, export_presets, places_textures, prepare_conversion, write_files, written_extensions,
};
pub use copied_files::CopiedFiles;
pub use editable::Editable;
pub use export::{ExportContent, ExportOrder, ExportReport, ExportedFile, export_files};
pub use fault::{FaultInjection, FaultPlan, FaultPoint};
pub use folder::{FileAccessError, Folder, read_file};
pub use found_files::{FoundFiles, name_found_files};
pub use handle::DocumentHandle;
pub use images::DecodedImage;
pub use import::{formats, written_format, written_formats};
pub use line_names::paths_of_renamed_line;
pub use load::{Loader, OpenedModel, load_model, open_model};
pub use message::{DocumentMessage, DocumentReply};
pub use new_folders::{ensure_folder, make_folder};
pub use offer::Offer;
pub use open::Change;
pub use outdated_edits::{OutdatedEdits, OutdatedEditsChoice};
pub use owner::{Document, Setup};
pub use packing::{PackError, pack, unpack};
pub use pose_library::{PoseFile, PoseFolder, PoseOrder, StoredPose};
pub use project_edits::listed_models;
pub use rebase::{Rebase, Rebased, UnfitEdit};
pub use reference_source::{REFERENCE_SIDE, ReferenceSource};
pub use retarget_order::{MapFile, RetargetOrder};
pub use save_files::{SaveFiles, WrittenFile};
pub use saving::{NotSaved, SaveOrder, SaveTo, SavedFile, Then, check_extension};
pub use scan::Decision;
pub use scene_check::{CheckedText, check_scene};
pub use scene_files::{MissingFile, SceneFile, SceneFileKind, SceneFiles};
pub use scene_source::{LoadedScene, SceneLoadError, load_scene};
pub use scene_view::{SceneModel, SceneView};
pub use shapes::{ModelShapes, ShapeMesh};
pub use sound::{SoundPeaks, SoundSource, SoundStamp};
pub use source::{LoadError, Source};
pub use step_amount::{PoseChange, StepAmount};
pub use take_check::{CheckedTake, TakeCheck};
pub use take_thresholds::TakeThresholds;
pub use text_source::{is_project, is_scene, is_script};
pub use thing_names::{references_of_renamed_thing, script_that_names};
pub use view::{FileView, HistoryView, LoadedModel, View, WaitingSceneView};
pub use writing::StayingFiles;
