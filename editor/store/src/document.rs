//! Saving a document that has a journal: both stay consistent wherever the program or the machine stops.

use super::error::FileSaveError;
use super::journal::Journal;
use super::save::{SaveOptions, SaveOutcome, save};
use super::target::resolved;
use super::vfs::Vfs;
use std::path::Path;

/// Saves `bytes`, the document with all edits in `journal`, in the file at `path`.
///
/// When `path` is the file of the journal's document, the journal records the save before and after it: edits
/// appended later count as unsaved again, and after a crash between the two records the file itself shows whether it
/// was saved.
///
/// # Errors
/// As [`save`]. A journal that could not be written is only a notice, because the work is in the file.
pub fn save_document(
    files: &dyn Vfs,
    journal: &mut Journal,
    path: &Path,
    bytes: &[u8],
    options: &SaveOptions<'_>,
) -> Result<SaveOutcome, FileSaveError> {
    let own = journal.document() == Some(resolved(files, path)?);
    let before = if own { journal.saving(bytes) } else { Ok(()) };
    let mut saved = save(files, path, bytes, options)?;
    let after = if own && before.is_ok() { journal.saved(&saved.stamp) } else { Ok(()) };
    if let Err(error) = before.and(after) {
        saved.notices.push(format!("the journal could not record that the document was saved: {error}"));
    }
    Ok(saved)
}
