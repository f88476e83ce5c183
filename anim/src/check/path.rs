//! Paths of elements in a model.

use crate::format::one_line;
use std::fmt;

/// The list that a step of a path indexes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PathKind {
    /// A position in [`ModelData::meshes`](crate::data::ModelData::meshes).
    Mesh,
    /// A position in the mesh's primitives.
    Primitive,
    /// A position in the primitive's columns.
    Vertex,
    /// A third of a position in the primitive's indices.
    Triangle,
    /// A position in the primitive's morph targets.
    MorphTarget,
    /// A position in [`ModelData::instances`](crate::data::ModelData::instances).
    Instance,
    /// A position in [`ModelData::skins`](crate::data::ModelData::skins).
    Skin,
    /// A position in the skin's list of bones.
    Joint,
    /// A position in [`ModelData::materials`](crate::data::ModelData::materials).
    Material,
    /// A position in the skeleton.
    Bone,
    /// A position in [`AnimationData::takes`](crate::data::AnimationData::takes).
    Take,
    /// A position in the take's tracks.
    Track,
    /// A position in the take's morph tracks.
    MorphTrack,
    /// 0 translation, 1 rotation, 2 scale; displayed by these names.
    Channel,
    /// The number of a key in its channel.
    Key,
}

impl PathKind {
    /// Returns the name in messages.
    fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Primitive => "primitive",
            Self::Vertex => "vertex",
            Self::Triangle => "triangle",
            Self::MorphTarget => "morph target",
            Self::Instance => "instance",
            Self::Skin => "skin",
            Self::Joint => "joint",
            Self::Material => "material",
            Self::Bone => "bone",
            Self::Take => "take",
            Self::Track => "track",
            Self::MorphTrack => "morph track",
            Self::Channel => "channel",
            Self::Key => "key",
        }
    }
}

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathStep {
    /// The list that is indexed.
    pub kind: PathKind,
    /// Position in the list, from 0.
    pub number: usize,
    /// Name of the element; empty where it has none.
    pub name: String,
}

/// Path of an element: steps from the model down, `mesh 0 "body", primitive 1, vertex 12`. Without steps: the model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ModelPath {
    /// The outermost first.
    pub steps: Vec<PathStep>,
}

impl ModelPath {
    /// Creates a path of one step.
    pub(crate) fn of(kind: PathKind, number: usize, name: &str) -> Self {
        Self::default().then(kind, number, name)
    }

    /// Returns the path with another step appended.
    pub(crate) fn then(mut self, kind: PathKind, number: usize, name: &str) -> Self {
        self.steps.push(PathStep { kind, number, name: name.to_owned() });
        self
    }

    /// Returns the number of the step of `kind`.
    pub fn number(&self, kind: PathKind) -> Option<usize> {
        self.steps.iter().find(|step| step.kind == kind).map(|step| step.number)
    }
}

impl fmt::Display for ModelPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.steps.is_empty() {
            return f.write_str("model");
        }
        for (index, PathStep { kind, number, name }) in self.steps.iter().enumerate() {
            let separator = if index == 0 { "" } else { ", " };
            match kind {
                PathKind::Channel => write!(f, "{separator}{name}")?,
                _ if name.is_empty() => write!(f, "{separator}{} {number}", kind.name())?,
                _ => write!(f, "{separator}{} {number} \"{}\"", kind.name(), one_line(name))?,
            }
        }
        Ok(())
    }
}
