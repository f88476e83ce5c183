//! What a document edits and saves: the file of a model, of which only the edited bytes change, or texts.

use super::adapter::{ModelAdapter, TextFile, TextFiles};
use super::text_changes::text_changes;
use dragonfly_anim::format::{EditableFile, OutputFile, SavePlan};
use std::sync::Arc;

/// What is edited, as it is in the files.
#[derive(Clone)]
pub(super) enum EditedContent {
    /// A model, in the file that later saves start from.
    Model(Arc<EditableFile>),
    /// The script of a scene, or a project.
    Texts(TextFiles),
}

impl EditedContent {
    /// Returns the names of the files that it needs next to it.
    pub(super) fn neighbors(&self) -> Vec<String> {
        match self {
            Self::Model(file) => file.neighbors(),
            Self::Texts(texts) => texts.list().iter().skip(1).map(|file| file.name.to_string()).collect(),
        }
    }

    /// Returns the texts as they are in the files; none for a model.
    pub(super) fn texts(&self) -> TextFiles {
        match self {
            Self::Model(_) => TextFiles::default(),
            Self::Texts(texts) => texts.clone(),
        }
    }
}

/// Returns what saving the texts of `adapter` would write: those that changed since `on_disk`, and the main file.
pub(super) fn plan_of_texts(on_disk: &TextFiles, adapter: &ModelAdapter) -> SavePlan {
    let file =
        |file: &TextFile| OutputFile { name: file.name.to_string(), bytes: file.text.as_bytes().to_vec() };
    let Some((main, others)) = adapter.texts().list().split_first() else { return SavePlan::default() };
    let changed = |one: &&TextFile| on_disk.called(&one.name).is_none_or(|old| old.text != one.text);
    let files = others.iter().filter(changed).chain([main]).map(file).collect();
    SavePlan { files, lost: Vec::new(), changes: Some(text_changes(on_disk, adapter.texts())) }
}
