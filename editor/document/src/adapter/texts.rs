//! The texts of a document: the script of a scene, or the files of a project.

use crate::edit::{EditScript, TextRef};
use dragonfly_anim::stage::script::MOST_BYTES;
use dragonfly_anim::stage::splice::TextSplices;
use std::sync::Arc;
use thiserror::Error;

/// A text file of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Its path relative to the folder of the main file, with `/` between its parts.
    pub name: Arc<str>,
    /// Its contents.
    pub text: Arc<str>,
}

/// The text files of a document, the main file first. None for a model. A clone is cheap.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextFiles(Arc<[TextFile]>);

/// The reason why a text cannot be edited. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TextEditError {
    /// The document has no such text.
    #[error("the document has no text {0}")]
    NoText(String),
    /// A new text has no name.
    #[error("a new text needs a name")]
    NoName,
    /// The document cannot get a new text.
    #[error("{name}: {reason}")]
    NotCreated {
        /// Its name.
        name: String,
        /// The reason.
        reason: String,
    },
    /// The text has something else at this byte than the edit says.
    #[error("byte {at} of {name}: the text there is not {old:?}")]
    OtherText {
        /// Name of the text.
        name: Arc<str>,
        /// The byte.
        at: usize,
        /// What the edit expects, cut to a few words.
        old: String,
    },
    /// Two replacements of one edit overlap.
    #[error("two replacements of the text overlap")]
    Overlap,
    /// The edit replaces nothing.
    #[error("the edit would not change the text")]
    Nothing,
    /// The text would be too large.
    #[error("the text would have {0} bytes; at most {MOST_BYTES} can be opened again")]
    TooLarge(usize),
}

impl FromIterator<TextFile> for TextFiles {
    fn from_iter<I: IntoIterator<Item = TextFile>>(files: I) -> Self {
        Self(files.into_iter().collect())
    }
}

impl TextFiles {
    /// Returns the files, the main file first.
    pub fn new(files: impl Into<Arc<[TextFile]>>) -> Self {
        Self(files.into())
    }

    /// Returns the only text of a document, with the name of its file.
    pub fn one(name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> Self {
        Self::new([TextFile { name: name.into(), text: text.into() }])
    }

    /// Returns the files, the main file first.
    pub fn list(&self) -> &[TextFile] {
        &self.0
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the text of the main file; `None` where there is none.
    pub fn main(&self) -> Option<&Arc<str>> {
        self.0.first().map(|file| &file.text)
    }

    /// Returns the file called `name`.
    pub fn called(&self, name: &str) -> Option<&TextFile> {
        self.0.iter().find(|file| &*file.name == name)
    }

    /// Returns the position of a text; that of the main file where none is given.
    ///
    /// # Errors
    ///
    /// [`TextEditError::NoText`].
    pub fn find(&self, text: Option<&TextRef>) -> Result<usize, TextEditError> {
        let found = match text {
            None => Some(0),
            Some(TextRef::Index(index)) => Some(*index),
            Some(TextRef::Name(name)) => self.0.iter().position(|file| *file.name == **name),
        };
        let named = || text.map_or_else(|| "at all".to_owned(), ToString::to_string);
        found.filter(|&index| index < self.0.len()).ok_or_else(|| TextEditError::NoText(named()))
    }

    /// Applies an edit that was applied before.
    pub(crate) fn edit(&mut self, edit: &EditScript) {
        if let (true, Ok(texts)) = (edit.create, edit.created_in(self)) {
            *self = texts;
            return;
        }
        let Ok(index) = self.find(edit.text.as_ref()) else { return };
        if let Some(Ok(splices)) = self.0.get(index).map(|file| edit.splices_in(file)) {
            self.splice(index, &splices);
        }
    }

    /// Replaces parts of a text, and returns what leads back. The splices were checked.
    pub(super) fn splice(&mut self, index: usize, splices: &TextSplices) -> TextSplices {
        let Some(file) = self.0.get(index) else {
            unreachable!("an operation names text {index}, which is not there")
        };
        let inverse = splices.inverse(&file.text);
        let text = splices.apply(&file.text).into();
        let mut files = self.0.to_vec();
        files[index].text = text;
        self.0 = files.into();
        inverse
    }
}
