//! Files and folders that the user chooses with the system's dialog, apart from models.

use dragonfly_document::formats;
use dragonfly_sound::SOUND_FORMATS;

/// The purpose of a file or folder that the user chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileChoice {
    /// The folder of the pose library.
    PoseFolder,
    /// The reference picture.
    Reference,
    /// The sound in the timeline.
    Sound,
    /// The model whose takes are wanted in the dialog for retargeting.
    RetargetSource,
    /// Files whose takes are imported; several can be chosen.
    Takes,
    /// The model of a new scene.
    NewScene,
    /// The folder of a new scene of two built-in figures.
    DemoScene,
    /// The model of a new role of the scene.
    Role,
    /// The model of a new prop of the scene.
    Prop,
    /// The file of a new sound of the scene.
    SceneSound,
    /// The file in place of a missing model of the scene.
    MissingModel,
    /// The file in place of a missing sound of the scene.
    MissingSound,
    /// Files whose takes are imported with the map of the dialog for retargeting; several can be chosen.
    MappedTakes,
}

impl FileChoice {
    /// Returns the title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::PoseFolder => "Choose the folder of poses",
            Self::Reference => "Choose a reference picture",
            Self::Sound | Self::SceneSound => "Choose a sound",
            Self::RetargetSource => "Choose the model with the take",
            Self::NewScene => {
                "New scene: choose the model of its two roles. A project with the scene is written next to it"
            }
            Self::DemoScene => {
                "New scene: choose a folder. Two figures and a scene with them are written there"
            }
            Self::Role => "Choose the model of the role",
            Self::Prop => "Choose the model of the prop",
            Self::MissingModel => "Find the missing model",
            Self::MissingSound => "Find the missing sound",
            Self::Takes | Self::MappedTakes => "Import takes",
        }
    }

    /// Returns the name and the extensions of the files that are proposed; `None` for a folder.
    pub fn filter(self) -> Option<(&'static str, Vec<&'static str>)> {
        match self {
            Self::PoseFolder | Self::DemoScene => None,
            Self::Reference => Some(("Pictures", vec!["png", "jpg", "jpeg", "webp", "gif"])),
            Self::Sound | Self::SceneSound | Self::MissingSound => Some((
                "Sounds",
                SOUND_FORMATS.iter().flat_map(|format| format.extensions.iter().copied()).collect(),
            )),
            Self::RetargetSource
            | Self::NewScene
            | Self::Role
            | Self::Prop
            | Self::MissingModel
            | Self::Takes
            | Self::MappedTakes => Some(("Models", formats().extensions())),
        }
    }

    /// Returns the message for a desktop without such a dialog.
    pub fn no_dialog(self) -> &'static str {
        match self.filter() {
            None => "This desktop has no dialog for choosing folders; type the path instead",
            Some(_) => "This desktop has no dialog for choosing files; type the path instead",
        }
    }

    /// Returns whether the place where the choice begins has a field for the path, so that no other one is shown on a desktop without such a
    /// dialog.
    pub fn has_field(self) -> bool {
        match self {
            Self::PoseFolder
            | Self::Reference
            | Self::RetargetSource
            | Self::MissingModel
            | Self::MissingSound => true,
            Self::Sound
            | Self::Takes
            | Self::NewScene
            | Self::DemoScene
            | Self::Role
            | Self::Prop
            | Self::SceneSound
            | Self::MappedTakes => false,
        }
    }
}
