//! Choices of the user for a file.

use super::preset::ExportPreset;

/// The place of the images of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexturePlacement {
    /// Images are in the file itself.
    #[default]
    Embedded,
    /// Images are files of their own in the folder of the file.
    Beside,
}

impl TexturePlacement {
    /// Both placements, the usual one first.
    pub const ALL: [Self; 2] = [Self::Embedded, Self::Beside];

    /// Returns the name on a command line, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Embedded => "embedded",
            Self::Beside => "beside",
        }
    }

    /// Returns the text of a list.
    pub fn title(self) -> &'static str {
        match self {
            Self::Embedded => "In the file",
            Self::Beside => "Files beside it",
        }
    }
}

/// Options of a file that is written. The default is a file for any program, in centimeters with Y up, with its images.
#[derive(Clone, Copy, Debug, Default)]
pub struct FbxOptions {
    /// Settings of another program.
    pub preset: Option<&'static ExportPreset>,
    /// The place of the images.
    pub textures: TexturePlacement,
}
