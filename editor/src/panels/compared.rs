//! The choice of the take with which the one shown is compared.

use dragonfly_document::adapter::TakeId;

/// The choice of the take with which the one shown is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CompareWith {
    /// Nothing.
    #[default]
    Nothing,
    /// The same take as it was when the file was opened.
    Opened,
    /// Another take of the model.
    Take(TakeId),
}
