//! The keys that an edit of a pose is for: those of the frame at the playhead, or many at once.
//!
//! The scope is not remembered between runs or models: an edit that changes a whole take unexpectedly is worse than a switch
//! that has to be set again.

use super::commands::Id;
use dragonfly_document::edit::FadeShape;
use serde::{Deserialize, Serialize};

/// The keys that an edit of a pose is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EditScope {
    /// The pose at the playhead.
    #[default]
    Frame,
    /// The selected keys of the bones.
    Keys,
    /// All keys of the bones in the play range, or in the take if none is set.
    Range,
    /// All keys of the bones.
    Take,
}

impl EditScope {
    /// All scopes, in the order of menus.
    pub const ALL: [Self; 4] = [Self::Frame, Self::Keys, Self::Range, Self::Take];

    /// Returns its name.
    pub fn title(self) -> &'static str {
        match self {
            Self::Frame => "This frame",
            Self::Keys => "Selected keys",
            Self::Range => "Play range",
            Self::Take => "Whole take",
        }
    }

    /// Returns the command that sets it.
    pub(super) fn command(self) -> Id {
        match self {
            Self::Frame => Id::EditFrame,
            Self::Keys => Id::EditSelectedKeys,
            Self::Range => Id::EditPlayRange,
            Self::Take => Id::EditWholeTake,
        }
    }

    /// Returns the scope after this one.
    pub(super) fn next(self) -> Self {
        match self {
            Self::Frame => Self::Keys,
            Self::Keys => Self::Range,
            Self::Range => Self::Take,
            Self::Take => Self::Frame,
        }
    }
}

/// The scope of edits, and whether they fade out around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EditOver {
    /// The keys that edits are for.
    pub scope: EditScope,
    /// Whether edits of selected keys and of the play range fade out over the keys around them.
    pub falloff: bool,
}

impl EditOver {
    /// Returns whether the falloff applies to the scope: a single frame and a whole take have no keys around them.
    pub fn fades(&self) -> bool {
        self.falloff && matches!(self.scope, EditScope::Keys | EditScope::Range)
    }
}

/// The size of the falloff, which is remembered between runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct FalloffSettings {
    /// Number of frames at which nothing of an edit is left.
    pub frames: u32,
    /// The curve by which it fades out.
    pub shape: FadeShape,
}

impl FalloffSettings {
    /// Largest number of frames.
    pub const MOST: u32 = 1000;

    /// Returns the nearest valid numbers.
    pub fn sanitized(self) -> Self {
        Self { frames: self.frames.clamp(1, Self::MOST), ..self }
    }

    /// Returns the settings with the next shape.
    pub(super) fn next_shape(self) -> Self {
        let at = FadeShape::ALL.iter().position(|shape| *shape == self.shape).unwrap_or_default();
        Self { shape: FadeShape::ALL[(at + 1) % FadeShape::ALL.len()], ..self }
    }
}

impl Default for FalloffSettings {
    fn default() -> Self {
        Self { frames: 10, shape: FadeShape::Smooth }
    }
}

/// Returns the name of a shape.
pub(super) fn shape_title(shape: FadeShape) -> &'static str {
    match shape {
        FadeShape::Linear => "Linear",
        FadeShape::Smooth => "Smooth",
        FadeShape::Sphere => "Sphere",
        FadeShape::Sharp => "Sharp",
    }
}
