//! Attachment points on a skeleton.

use crate::axes::Axes;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::healthy;
use glam::{Mat4, Vec3};

/// The source of an attached object's scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ScaleOf {
    /// The bone: the object is scaled, stretched and mirrored with it.
    #[default]
    Bone,
    /// The object: it keeps its size whatever the bone does, and only the position and rotation follow. Of a mirrored
    /// bone the x and y axes are kept, and z is reversed.
    Object,
}

/// An attachment point on a bone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(alias = "attachment point")]
pub struct Socket {
    /// The bone that carries the socket.
    pub bone: BoneIndex,
    /// Socket space → bone space.
    pub offset: Transform,
    /// The source of the attached object's scale.
    pub scale: ScaleOf,
}

/// Error for a socket on a bone that the skeleton does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the socket needs a bone called {name:?}; the skeleton ({bones} bones) has none")]
pub struct NoSuchSocketBone {
    /// The name that was given.
    pub name: String,
    /// Number of bones of the skeleton.
    pub bones: usize,
}

impl Socket {
    /// Creates a socket at the origin of `bone`, with its axes and scale.
    pub fn at(bone: BoneIndex) -> Self {
        Self { bone, offset: Transform::IDENTITY, scale: ScaleOf::Bone }
    }

    /// Creates a socket at the origin of the first bone called `name`, as [`Self::at`].
    pub fn on(skeleton: &Skeleton, name: &str) -> Result<Self, NoSuchSocketBone> {
        let bone = skeleton.find(name);
        bone.map(Self::at).ok_or_else(|| NoSuchSocketBone { name: name.to_owned(), bones: skeleton.len() })
    }

    /// Returns the socket's pose, socket space → scene space, from the carrier's `to_root`
    /// ([`crate::animation::to_root`](crate::animation::to_root())).
    ///
    /// ```text
    /// scale of the bone:    to_root * offset
    /// scale of the object:  position = to_root * offset.translation
    ///                       axes     = rotation of to_root without its scale * offset.rotation, * offset.scale
    /// ```
    ///
    /// Total: a bone that does not exist, or whose to-root is not finite, counts as the scene's origin. Numbers of the
    /// offset that are not finite are replaced by those of the identity. Where the product is not finite, the result is
    /// the bone's to-root alone. A bone whose axes have no length has no rotation of its own. Allocates nothing.
    pub fn to_root(&self, to_root: &[Mat4]) -> Mat4 {
        let bone = to_root.get(self.bone as usize).copied().filter(|matrix| matrix.is_finite());
        let bone = bone.unwrap_or(Mat4::IDENTITY);
        let offset = healthy(self.offset, Transform::IDENTITY);
        let socket = match self.scale {
            ScaleOf::Bone => bone * offset.to_matrix(),
            ScaleOf::Object => unscaled(bone, offset.translation) * turned(offset),
        };
        if socket.is_finite() { socket } else { bone }
    }
}

/// Returns the axes of `bone` without their lengths, with the origin at the point `place` of the bone's space.
fn unscaled(bone: Mat4, place: Vec3) -> Mat4 {
    let place = bone.transform_point3(place);
    match Axes::of(bone) {
        Some(axes) => Mat4::from_rotation_translation(axes.rotation(), place),
        None => Mat4::from_translation(place),
    }
}

/// Returns the matrix of the offset without its translation.
fn turned(offset: Transform) -> Mat4 {
    Transform { translation: Vec3::ZERO, ..offset }.to_matrix()
}
