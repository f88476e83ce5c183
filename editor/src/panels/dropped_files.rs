//! Files that a scene is to get: dropped onto it, chosen, or found in the place of missing ones.

use dragonfly_anim::bounds::AxisBox;
use dragonfly_document::{LoadedModel, MissingFile, SceneFiles};
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// The place at which files were dropped.
#[derive(Clone, Debug, PartialEq)]
pub enum DropPlace {
    /// On a bone or its skin: its name in scripts, such as `anna.RightHand`, and the place on the ground below, scene space.
    Bone(String, DVec3),
    /// On the ground or a prop, scene space, to a centimeter.
    At(DVec3),
    /// The window system does not report where; near this place on the ground, which is in the middle of the viewport.
    Near(DVec3),
    /// Neither on a thing nor near the ground.
    Nowhere,
}

/// The kind of a model in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelForm {
    /// It moves a skin: a role.
    Figure,
    /// It has takes but no skin: a role, unless something holds it.
    Moving,
    /// It has neither: a prop.
    Object,
}

impl ModelForm {
    /// Returns what a model is.
    pub fn of(loaded: &LoadedModel) -> Self {
        match (loaded.model.skins.is_empty(), loaded.is_figure()) {
            (false, _) => Self::Figure,
            (true, true) => Self::Moving,
            (true, false) => Self::Object,
        }
    }
}

/// A model that was dropped.
#[derive(Clone, Debug, PartialEq)]
pub struct DroppedModel {
    /// The model as the script names it.
    pub name: String,
    /// Its kind in the scene.
    pub form: ModelForm,
    /// Factor from its lengths to meters.
    pub scale: f64,
    /// The box around it at the start of its first take, in its own lengths; empty where it is not known.
    pub around: AxisBox,
}

impl DroppedModel {
    /// Creates one of a model that was read. A figure that is far from human size is made as high as a human. `is_role` is the choice of the user, if there is one.
    pub fn of(name: String, loaded: &LoadedModel, is_role: Option<bool>) -> Self {
        let form = match (is_role, ModelForm::of(loaded)) {
            (Some(false), _) => ModelForm::Object,
            (Some(true), ModelForm::Object) => ModelForm::Moving,
            (Some(true) | None, form) => form,
        };
        // Things that others hold may be small, and houses large.
        let scale = if form == ModelForm::Figure { loaded.human_scale() } else { 1.0 };
        let around = AxisBox { min: loaded.bounds.min, max: loaded.bounds.max };
        Self { name, form, scale, around }
    }
}

/// Files that were dropped, with what is known of the models.
#[derive(Clone, Debug, PartialEq)]
pub struct DroppedModels {
    /// The models.
    pub models: Vec<DroppedModel>,
    /// The place at which they were dropped.
    pub place: DropPlace,
    /// The sounds as the script names them.
    pub sounds: Vec<String>,
    /// The hashes of the models, as the script names them.
    pub hashes: Vec<(String, u64)>,
    /// Names of the files that were copied into the folder of the scene for them; `None` where none was.
    pub copied: Option<String>,
    /// The scene that gets them.
    pub target: JobScene,
}

/// The scene for which a job works, so that its answer is not used in another one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct JobScene {
    /// A number that grows when another document is opened.
    pub opened: u64,
    /// The script that is shown, of a project; `None` for a script alone.
    pub script: Option<Arc<str>>,
}

/// Files that were dropped, whose models have to be read first.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownModels {
    /// The models: their files, and how the script names them.
    pub models: Vec<(PathBuf, String)>,
    /// Whether they become roles; `None` where the user made no choice.
    pub is_role: Option<bool>,
    /// The place at which they were dropped.
    pub place: DropPlace,
    /// The sounds as the script names them.
    pub sounds: Vec<String>,
    /// The hashes of the models, as the script names them.
    pub hashes: Vec<(String, u64)>,
    /// Names of the files that were copied into the folder of the scene for them; `None` where none was.
    pub copied: Option<String>,
    /// The scene that gets them.
    pub target: JobScene,
}

/// The use of files that a scene gets.
#[derive(Clone, Debug, PartialEq)]
pub enum FileUse {
    /// They were dropped at this place, and are added.
    Add(DropPlace),
    /// The model becomes a role.
    Role,
    /// The model becomes a prop.
    Prop,
    /// They are in the place of missing ones.
    Find,
}

/// Files that a scene is to get, from anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedFiles {
    /// The files.
    pub files: SceneFiles,
    /// Other files that are missing, and may be next to the first one.
    pub others: Vec<MissingFile>,
    /// What they are for.
    pub used: FileUse,
    /// The scene that gets them.
    pub target: JobScene,
}
