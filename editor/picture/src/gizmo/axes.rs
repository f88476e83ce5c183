//! Axes: which way x, y and z of the gizmo point, and what is dragged.

use super::view::GizmoView;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use glam::{DMat3, DMat4, DQuat, DVec3, Mat4};

/// One of three.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Red by custom.
    X,
    /// Green.
    Y,
    /// Blue.
    Z,
}

impl Axis {
    /// All, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The two others, in the order that makes them right-handed with this one.
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

/// Whose axes a gizmo has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Space {
    /// The bone's own, turned as it is.
    #[default]
    Local,
    /// Those of the bone's parent; a root's are the world's.
    Parent,
    /// The scene's.
    World,
    /// Right, up, and towards the viewer.
    View,
}

impl Space {
    /// What pressing an axis again while dragging changes to: own axes and the world's.
    pub fn other(self) -> Self {
        match self {
            Self::Local | Self::Parent => Self::World,
            Self::World | Self::View => Self::Local,
        }
    }
}

/// What several bones turn and grow about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Pivot {
    /// Each about its own joint, along its own axes (in local and parent space).
    #[default]
    Individual,
    /// The mean of all their joints, along the axes of the active one.
    Median,
    /// The joint of the active one, along its axes.
    Active,
}

/// A bone to be dragged, as it is before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoTarget {
    /// Which.
    pub bone: BoneIndex,
    /// Of the parent: parent space → scene space. The identity for a root.
    pub parent_to_root: Mat4,
    /// Relative to the parent.
    pub to_parent: Transform,
}

impl GizmoTarget {
    /// Bone `bone` of a pose: `poses` relative to the parents, `to_root` of all bones. `None` where there is no such bone or
    /// its numbers are not finite.
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

    /// Where the joint is, scene space.
    pub fn origin(&self) -> DVec3 {
        self.parent().transform_point3(self.to_parent.translation.as_dvec3())
    }

    /// Returns the matrix parent space → scene space in double precision; the identity for a root.
    pub fn parent(&self) -> DMat4 {
        self.parent_to_root.as_dmat4()
    }

    /// Right-angled axes of the parent.
    pub fn parent_frame(&self) -> GizmoAxes {
        GizmoAxes::of(DMat3::from_mat4(self.parent()))
    }

    /// The axes that the bone has in `space`, scene space.
    pub fn frame(&self, space: Space, view: &GizmoView) -> GizmoAxes {
        match space {
            Space::Local => {
                let parent = self.parent_frame();
                let own = DMat3::from_quat(unit(self.to_parent.rotation.as_dquat()));
                GizmoAxes { axes: parent.axes * own, ..parent }
            }
            Space::Parent => self.parent_frame(),
            Space::World => GizmoAxes { axes: DMat3::IDENTITY, sign: 1.0 },
            Space::View => GizmoAxes { axes: DMat3::from_cols(view.right, view.up, view.back), sign: 1.0 },
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
    /// -1 where the axes are left-handed because a parent is mirrored, else 1. A rotation by an angle about such an axis is a
    /// rotation by the opposite angle in scene space.
    pub sign: f64,
}

impl GizmoAxes {
    /// Those nearest to the columns: x keeps its direction, y its plane with x, z its side. The identity for columns without
    /// length or in one plane.
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
    pub fn axis(&self, axis: Axis) -> DVec3 {
        self.axes.col(axis as usize)
    }

    /// The rotation that the proper one of these axes and their opposites makes.
    pub fn rotation(&self) -> DQuat {
        unit(DQuat::from_mat3(&(self.axes * self.sign)))
    }
}
