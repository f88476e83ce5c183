//! The overlays over the panels, by name; `overlays.rs` draws them.

use super::file_choice::FileChoice;

/// An overlay over the panels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// Search for a command.
    Palette,
    /// Shortcuts of keyboard and mouse.
    Shortcuts,
    /// Version and licenses.
    About,
    /// A field for a path.
    OpenPath,
    /// Units, axes and frame rate with which the open file is read again.
    ImportOptions,
    /// Format, content and path of an export.
    Export,
    /// A field for the path of the file with which takes are compared.
    ComparePath,
    /// A field for the path of a file or folder, on a desktop without a dialog for it.
    FilePath(FileChoice),
    /// The pairs of left and right bones, and what is mirrored.
    MirrorPairs,
    /// Takes of another model for the open one.
    Retarget,
    /// The travel of a take.
    RootMotion,
    /// The gap of a take that repeats.
    Loop,
    /// The unit of length of the model.
    ModelSize,
    /// The reference picture.
    Reference,
}
