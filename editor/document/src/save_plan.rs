//! The plan of a save: the files that it will write.

use dragonfly_anim::format::dfm;
use dragonfly_anim::format::gltf::save::{self, Changes, OutputFile, Plan};
use std::fmt;
use thiserror::Error;

/// The files that a save will write.
pub struct SavePlan {
    /// The files in the order of writing; names relative to the folder of the opened file.
    pub files: Vec<OutputFile>,
    /// The changes of a file that is patched; `None` where the whole file is written.
    pub changes: Option<Changes>,
}

/// The reason why a document cannot be saved. Nothing was written.
#[derive(Debug, Error)]
pub enum SavePlanError {
    /// The takes cannot be stored in the file.
    #[error(transparent)]
    Gltf(#[from] save::SaveError),
    /// The model cannot be stored in our own format.
    #[error(transparent)]
    Dfm(#[from] dfm::WriteError),
}

impl fmt::Display for SavePlan {
    /// Writes the changes, one line each.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.changes, self.files.last()) {
            (Some(changes), _) => write!(out, "{changes}"),
            (None, Some(file)) => writeln!(out, "the whole file is written anew: {} bytes", file.bytes.len()),
            (None, None) => writeln!(out, "nothing changes"),
        }
    }
}

impl SavePlan {
    pub(super) fn of(plan: &Plan<'_>) -> Self {
        Self { files: plan.write(), changes: Some(plan.changes().clone()) }
    }
}
