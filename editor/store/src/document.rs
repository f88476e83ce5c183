//! Saving a document that has a journal: the two know of each other, whenever the program or the machine stops.

use super::error::SaveError;
use super::journal::Journal;
use super::save::{SaveOptions, Saved, resolved, save};
use super::vfs::Vfs;
use std::path::Path;

/// Saves `bytes`, which are the document with all that `journal` holds, in the file at `path`.
///
/// When `path` is the file of the journal's document, the journal says so before and after: what is appended to it
/// later is unsaved work again, and after a crash between the two the file itself tells whether it was saved.
///
/// # Errors
/// As [`save`]. That the journal could not be written is a notice: the work is in the file then.
pub fn save_document(
    files: &dyn Vfs,
    journal: &mut Journal,
    path: &Path,
    bytes: &[u8],
    options: &SaveOptions<'_>,
) -> Result<Saved, SaveError> {
    let own = journal.document() == Some(resolved(files, path)?);
    let before = if own { journal.saving(bytes) } else { Ok(()) };
    let mut saved = save(files, path, bytes, options)?;
    let after = if own && before.is_ok() { journal.saved(&saved.stamp) } else { Ok(()) };
    if let Err(error) = before.and(after) {
        saved.notices.push(format!("the journal does not know that the document was saved: {error}"));
    }
    Ok(saved)
}
