//! The identifier of a curve: a channel of a bone, or a shape key of a mesh.

use crate::panels::keys::intervals::Intervals;
use crate::panels::keys::{ChannelId, KeySelection};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::edit::Property;

/// Identifies a curve of a take.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::panels) enum CurveId {
    /// A channel of a bone.
    Bone(BoneIndex, Property),
    /// The weight of a shape key.
    Shape {
        /// Index of its mesh in the list of mesh instances of the model.
        instance: u32,
        /// Index of the shape key in the mesh.
        shape: u32,
    },
}

/// Returns the bit of a property in a set of kinds of curves.
pub(super) fn bit(property: Property) -> u8 {
    1 << property as u8
}

/// The bit of shape keys in a set of kinds of curves, after those of the properties.
pub(super) const SHAPES: u8 = 1 << 3;

impl CurveId {
    /// Returns the channel of a bone; `None` for a shape key.
    pub(super) fn channel(self) -> Option<ChannelId> {
        match self {
            Self::Bone(bone, property) => Some((bone, property)),
            Self::Shape { .. } => None,
        }
    }

    /// Returns whether it is a shape key.
    pub(super) fn is_shape(self) -> bool {
        matches!(self, Self::Shape { .. })
    }

    /// Returns whether it is a rotation.
    pub(super) fn is_rotation(self) -> bool {
        matches!(self, Self::Bone(_, Property::Rotation))
    }

    /// Returns the bit of its kind in a set of kinds: its property, or [`SHAPES`].
    pub(super) fn bit(self) -> u8 {
        match self {
            Self::Bone(_, property) => bit(property),
            Self::Shape { .. } => SHAPES,
        }
    }

    /// Returns whether both are curves of one bone, or the same shape key. Their colors are those of their axes.
    pub(super) fn shares_color(self, other: Self) -> bool {
        match (self, other) {
            (Self::Bone(bone, _), Self::Bone(other, _)) => bone == other,
            (Self::Bone(..) | Self::Shape { .. }, _) => self == other,
        }
    }

    /// Returns the selected intervals of its keys.
    pub(super) fn selected(self, selection: &KeySelection) -> &Intervals {
        match self {
            Self::Bone(bone, property) => selection.of((bone, property)),
            Self::Shape { .. } => selection.shapes(),
        }
    }
}

impl From<ChannelId> for CurveId {
    fn from((bone, property): ChannelId) -> Self {
        Self::Bone(bone, property)
    }
}
