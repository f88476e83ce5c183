//! The search for unsaved work of an earlier session, and what the user decides about it.

use super::offer::Offer;
use dragonfly_store::{Autosave, FolderLimits, Readability};

/// A decision of the user about unsaved work of an earlier session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// Restore it, with its history.
    Keep,
    /// Open it as a separate document that has no file yet. Its journal stays as it is.
    Beside,
    /// Move it to the trash folder.
    Discard,
    /// Leave it where it is and offer it again next time.
    Later,
}

/// Limits for journals that are kept although they contain history but no unsaved work.
const HISTORIES: FolderLimits = FolderLimits { least: 20, most: 200, bytes: 1 << 30 };

/// The unsaved work in the autosave folder.
#[derive(Debug, Default)]
pub(super) struct RecoveryScan {
    pub(super) offers: Vec<Offer>,
    /// Messages about journals that cannot be read.
    pub(super) unreadable: Vec<String>,
}

impl RecoveryScan {
    /// Returns the result of a search that failed with the panic `reason`.
    pub(super) fn failed(reason: &str) -> Self {
        let text =
            format!("the search for unsaved work of earlier sessions failed: {reason}; nothing was changed");
        Self { unreadable: vec![text], ..Self::default() }
    }

    /// Searches the whole folder, and deletes the oldest journals with nothing but history.
    pub(super) fn of(autosave: &Autosave) -> Self {
        let mut scan = Self::default();
        if let Err(error) = autosave.tidy(HISTORIES) {
            tracing::warn!("{error}");
        }
        let found = match autosave.recoverable() {
            Ok(found) => found,
            Err(error) => {
                scan.unreadable.push(error.to_string());
                return scan;
            }
        };
        for found in found {
            match &found.reading {
                Readability::Newer(version) => scan.unreadable.push(format!(
                    "{}: unsaved work of a newer version of this program (format {version}) cannot be read; the file was not changed",
                    found.journal.display()
                )),
                Readability::Damaged(reason) => scan.unreadable.push(format!(
                    "{}: the unsaved work cannot be read: {reason}; the file was not changed",
                    found.journal.display()
                )),
                Readability::Whole | Readability::Cut(_) if found.is_offered() => match Offer::of(autosave, &found) {
                    Ok(offer) if offer.steps > 0 => scan.offers.push(offer),
                    Ok(_) => {}
                    Err(reason) => scan.unreadable.push(reason),
                },
                Readability::Whole | Readability::Cut(_) => {}
            }
        }
        scan
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_folder_has_no_unsaved_work() {
        let folder = std::env::temp_dir().join(format!("dragonfly-nothing-{}", std::process::id()));
        let autosave = Autosave::new(std::sync::Arc::new(dragonfly_store::RealFiles), Some(folder)).unwrap();
        let scan = RecoveryScan::of(&autosave);
        assert!(scan.offers.is_empty() && scan.unreadable.is_empty(), "{scan:?}");
    }
}
