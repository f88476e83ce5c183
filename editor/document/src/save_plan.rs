//! What a save will write, before it is written.

use dragonfly_anim::format::dfm;
use dragonfly_anim::format::gltf::save::{self, Changes, OutputFile, Plan};
use std::fmt;
use thiserror::Error;

/// What a save will write.
pub struct SavePlan {
    /// The files, in the order in which to write them; names relative to the folder of the file that was opened.
    pub files: Vec<OutputFile>,
    /// What changes in a file that is patched; none where the whole file is written.
    pub changes: Option<Changes>,
}

/// Why something cannot be saved; nothing was written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The takes do not fit into the file.
    #[error(transparent)]
    Gltf(#[from] save::SaveError),
    /// The same for our own format.
    #[error(transparent)]
    Dfm(#[from] dfm::WriteError),
}

impl fmt::Display for SavePlan {
    /// What will change, a line each.
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
