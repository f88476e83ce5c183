//! The option `--textures`.

use dragonfly_fbx::TexturePlacement;

/// Place of the images, as the command line names it.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(in super::super) enum TextureChoice {
    /// Into the file
    Embedded,
    /// Into files next to it
    Beside,
}

impl TextureChoice {
    /// Returns the placement of this name.
    pub(in super::super) fn placement(self) -> TexturePlacement {
        match self {
            Self::Embedded => TexturePlacement::Embedded,
            Self::Beside => TexturePlacement::Beside,
        }
    }
}
