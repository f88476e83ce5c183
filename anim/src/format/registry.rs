//! The formats that a program knows, as a value.

use super::{AssetFs, BUILTIN, Format, ImportError, Imported, ReadOptions};
use std::borrow::Cow;

/// Extensions of model formats that other programs write. A file that is named so is expected to have that format, so
/// a program refuses to save anything else under such a name.
const FOREIGN_EXTENSIONS: &[&str] = &["fbx", "dae", "blend"];

/// The formats that a program reads and writes. There is no global list: a program makes this value once and passes it
/// to whatever opens and saves files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formats(Cow<'static, [Format]>);

impl Default for Formats {
    fn default() -> Self {
        Self::builtin()
    }
}

impl Formats {
    /// Returns the formats of this crate, [`BUILTIN`].
    pub const fn builtin() -> Self {
        Self(Cow::Borrowed(BUILTIN))
    }

    /// Returns a registry without formats, to be filled by [`Self::with`].
    pub const fn none() -> Self {
        Self(Cow::Borrowed(&[]))
    }

    /// Adds a format, which takes precedence over those that are there and replaces one of the same name.
    pub fn with(mut self, format: Format) -> Self {
        let formats = self.0.to_mut();
        formats.retain(|other| *other != format);
        formats.insert(0, format);
        self
    }

    /// Returns the formats in the order of precedence.
    pub fn iter(&self) -> std::slice::Iter<'_, Format> {
        self.0.iter()
    }

    /// Returns the format of this name.
    pub fn by_name(&self, name: &str) -> Option<&Format> {
        self.iter().find(|format| format.name == name)
    }

    /// Returns the first format with this file name extension, given without the dot and in any case.
    pub fn by_extension(&self, extension: &str) -> Option<&Format> {
        self.iter().find(|format| format.has_extension(extension))
    }

    /// Returns the format of a file called `name` that contains `bytes`: the first format that recognizes the content,
    /// otherwise the one of the file name extension.
    pub fn detect(&self, name: &str, bytes: &[u8]) -> Option<&Format> {
        let by_name = || self.by_extension(name.rsplit_once('.')?.1);
        self.iter().find(|format| (format.sniff)(bytes)).or_else(by_name)
    }

    /// Returns every extension of every format, in order, for the filter of a file dialog.
    pub fn extensions(&self) -> Vec<&'static str> {
        self.iter().flat_map(|format| format.extensions.iter().copied()).collect()
    }

    /// Returns every extension with its dot, for help texts: `.dfm, .glb, .gltf, .bvh`.
    pub fn extension_list(&self) -> String {
        self.extensions().iter().map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    }

    /// Returns whether a file name extension, in any case, belongs to a model format: one of these, or one of those
    /// that other programs write (FBX, Collada, …).
    pub fn is_model_extension(&self, extension: &str) -> bool {
        self.by_extension(extension).is_some()
            || FOREIGN_EXTENSIONS.iter().any(|foreign| foreign.eq_ignore_ascii_case(extension))
    }

    /// Reads a model from the bytes of a file; see [`super::read`].
    pub fn read(
        &self,
        name: &str,
        bytes: &[u8],
        files: &dyn AssetFs,
        options: &ReadOptions<'_>,
    ) -> Result<Imported, ImportError> {
        super::definition::check_file_size(bytes.len())?;
        let format =
            self.detect(name, bytes).ok_or_else(|| ImportError::UnknownFormat { name: name.to_owned() })?;
        format.import(bytes, files, options)
    }
}

impl<'a> IntoIterator for &'a Formats {
    type Item = &'a Format;
    type IntoIter = std::slice::Iter<'a, Format>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
