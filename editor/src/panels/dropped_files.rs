//! Files that were dropped onto a scene: what they are, and where.

use glam::DVec3;
use std::path::PathBuf;

/// The place at which files were dropped.
#[derive(Clone, Debug, PartialEq)]
pub enum DropPlace {
    /// On a bone or its skin: its name in scripts, such as `anna.RightHand`.
    Bone(String),
    /// On the ground or a prop, scene space, to a centimeter.
    At(DVec3),
    /// Neither on a thing nor near the ground.
    Nowhere,
}

/// Files that were dropped, with what is known of the models.
#[derive(Clone, Debug, PartialEq)]
pub struct DroppedModels {
    /// The models as the script names them, and whether each has takes or moves a skin.
    pub models: Vec<(String, bool)>,
    /// The place at which they were dropped.
    pub place: DropPlace,
    /// The sounds as the script names them.
    pub sounds: Vec<String>,
}

/// Files that were dropped, whose models have to be read first.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownModels {
    /// The models: their files, and how the script names them.
    pub models: Vec<(PathBuf, String)>,
    /// The place at which they were dropped.
    pub place: DropPlace,
    /// The sounds as the script names them.
    pub sounds: Vec<String>,
}
