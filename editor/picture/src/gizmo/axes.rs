//! Axes of a gizmo, and the bones it changes.

use super::view::GizmoView;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use glam::{DMat3, DMat4, DQuat, DVec3, Mat4};

/// One of the three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GizmoAxis {
    /// X, conventionally red.
    X,
    /// Y, conventionally green.
    Y,
    /// Z, conventionally blue.
    Z,
}

impl GizmoAxis {
    /// All axes, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The two other axes, in the order that is right-handed with this one.
    pub fn others(self) -> [Self; 2] {
        match self {
            Self::X => [Self::Y, Self::Z],
            Self::Y => [Self::Z, Self::X],
            Self::Z => [Self::X, Self::Y],
        }
    }

    /// Returns the unit vector of the axis.
    pub fn unit(self) -> DVec3 {
        DVec3::AXES[self as usize]
    }
}

/// Coordinate space that gives a gizmo its axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum GizmoSpace {
    /// The bone's own axes.
    #[default]
    Local,
    /// The axes of the bone's parent; for a root, the world's.
    Parent,
    /// The axes of the scene.
    World,
    /// The axes of the viewport: right, up, and towards the viewer.
    View,
}

impl GizmoSpace {
    /// The space that pressing the axis key again during a drag switches to: local or world.
    pub fn other(self) -> Self {
        match self {
            Self::Local | Self::Parent => Self::World,
            Self::World | Self::View => Self::Local,
        }
    }
}

/// Point about which several bones rotate and scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Pivot {
    /// Each bone about its own joint, along its own axes (in local and parent space).
    #[default]
    Individual,
    /// The mean of their joints, along the axes of the active bone.
    Median,
    /// The joint of the active bone, along its axes.
    Active,
}

/// A bone to be dragged, in its pose before the drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoTarget {
    /// Index of the bone.
    pub bone: BoneIndex,
    /// Matrix of the parent, parent space → scene space; the identity for a root.
    pub parent_to_root: Mat4,
    /// Pose relative to the parent.
    pub to_parent: Transform,
}

impl GizmoTarget {
    /// The target for bone `bone` of a pose: `poses` relative to the parents, `to_root` of all bones. `None` if there
    /// is no such bone or its values are not finite.
    pub fn of(skeleton: &Skeleton, poses: &[Transform], to_root: &[Mat4], bone: BoneIndex) -> Option<Self> {
        let parent = skeleton.bones.get(bone as usize)?.parent;
        let parent_to_root = match parent {
            Some(parent) => *to_root.get(parent as usize)?,
            None => Mat4::IDENTITY,
        };
        let to_parent = *poses.get(bone as usize)?;
        let sound = parent_to_root.is_finite() && to_parent.is_finite();
        sound.then_some(Self { bone, parent_to_root, to_parent })
    }

    /// Position of the joint, scene space.
    pub fn origin(&self) -> DVec3 {
        self.parent().transform_point3(self.to_parent.translation.as_dvec3())
    }

    /// Returns the matrix parent space → scene space in double precision; the identity for a root.
    pub fn parent(&self) -> DMat4 {
        self.parent_to_root.as_dmat4()
    }

    /// Orthonormal axes of the parent.
    pub fn parent_frame(&self) -> GizmoAxes {
        GizmoAxes::of(DMat3::from_mat4(self.parent()))
    }

    /// The axes of the bone in `space`, scene space.
    pub fn frame(&self, space: GizmoSpace, view: &GizmoView) -> GizmoAxes {
        match space {
            GizmoSpace::Local => {
                let parent = self.parent_frame();
                let own = DMat3::from_quat(unit(self.to_parent.rotation.as_dquat()));
                GizmoAxes { axes: parent.axes * own, ..parent }
            }
            GizmoSpace::Parent => self.parent_frame(),
            GizmoSpace::World => GizmoAxes { axes: DMat3::IDENTITY, sign: 1.0 },
            GizmoSpace::View => {
                GizmoAxes { axes: DMat3::from_cols(view.right, view.up, view.back), sign: 1.0 }
            }
        }
    }
}

/// Returns `rotation` normalized, or the identity where its length is zero or not finite.
pub fn unit(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length > 0.0 && length.is_finite() { rotation / length } else { DQuat::IDENTITY }
}

/// Orthonormal axes in scene space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoAxes {
    /// The axes as columns, unit length.
    pub axes: DMat3,
    /// -1 if a mirrored parent makes the axes left-handed, otherwise 1. A rotation by an angle about such an axis is
    /// a rotation by the opposite angle in scene space.
    pub sign: f64,
}

impl GizmoAxes {
    /// The orthonormal axes nearest to the columns: x keeps its direction, y its plane with x, z its side. The
    /// identity for columns of zero length or in one plane.
    fn of(columns: DMat3) -> Self {
        let unit = |axis: DVec3| (axis / axis.abs().max_element()).try_normalize();
        let right_angled = || {
            let (x, y, z) = (unit(columns.x_axis)?, unit(columns.y_axis)?, unit(columns.z_axis)?);
            let y = (y - x * x.dot(y)).try_normalize()?;
            let across = x.cross(y);
            let side = across.dot(z);
            let sign = side.signum();
            let axes = DMat3::from_cols(x, y, across * sign);
            (side != 0.0 && axes.is_finite()).then_some(Self { axes, sign })
        };
        right_angled().unwrap_or(Self { axes: DMat3::IDENTITY, sign: 1.0 })
    }

    /// Returns one axis, scene space, unit length.
    pub fn axis(&self, axis: GizmoAxis) -> DVec3 {
        self.axes.col(axis as usize)
    }

    /// The rotation of the right-handed version of these axes.
    pub fn rotation(&self) -> DQuat {
        unit(DQuat::from_mat3(&(self.axes * self.sign)))
    }
}
