//! A place on a skeleton where something can be attached.

use crate::axes::Axes;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::healthy;
use glam::{Mat4, Vec3};

/// Whose scale an attached object has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ScaleOf {
    /// The bone's: it grows, is stretched and mirrored with it.
    #[default]
    Bone,
    /// Its own: it keeps its size whatever the bone does, and only the place follows. Of a mirrored bone the x and y axes
    /// are kept, and z is reversed.
    Object,
}

/// A place on a bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Socket {
    /// Which bone.
    pub bone: BoneIndex,
    /// Socket space → bone space.
    pub offset: Transform,
    /// Whose scale counts.
    pub scale: ScaleOf,
}

/// A socket names a bone that the skeleton does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("socket: no bone of {bones} is called {name:?}")]
pub struct NoSuchSocketBone {
    /// As given.
    pub name: String,
    /// How many bones the skeleton has.
    pub bones: usize,
}

impl Socket {
    /// At the origin of `bone`, with its axes and scale.
    pub fn at(bone: BoneIndex) -> Self {
        Self { bone, offset: Transform::IDENTITY, scale: ScaleOf::Bone }
    }

    /// The same on the first bone called `name`.
    pub fn on(skeleton: &Skeleton, name: &str) -> Result<Self, NoSuchSocketBone> {
        let bone = skeleton.find(name);
        bone.map(Self::at).ok_or_else(|| NoSuchSocketBone { name: name.to_owned(), bones: skeleton.len() })
    }

    /// Socket space → scene space, from the carrier's `to_root` ([`crate::animation::to_root`](crate::animation::to_root())).
    ///
    /// ```text
    /// scale of the bone:    to_root * offset
    /// scale of the object:  place = to_root * offset.translation
    ///                       axes  = rotation of to_root without its scale * offset.rotation, * offset.scale
    /// ```
    ///
    /// Total: a bone that is not there, or whose to-root is not finite, counts as the scene's origin; numbers of the offset
    /// that are not finite as those of the identity; where the product is not finite, the bone's to-root alone. A bone
    /// whose axes have no length has no rotation of its own. Allocates nothing.
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

/// The axes of `bone` without their lengths, at the point `place` of its space.
fn unscaled(bone: Mat4, place: Vec3) -> Mat4 {
    let place = bone.transform_point3(place);
    match Axes::of(bone) {
        Some(axes) => Mat4::from_rotation_translation(axes.rotation(), place),
        None => Mat4::from_translation(place),
    }
}

/// The offset without its translation.
fn turned(offset: Transform) -> Mat4 {
    Transform { translation: Vec3::ZERO, ..offset }.to_matrix()
}
