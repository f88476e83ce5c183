//! The point where a second hand holds an attached object.

use crate::axes::Axes;
use crate::data::Transform;
use crate::sample::healthy;
use glam::{Mat4, Quat, Vec3};

/// Two frames to bring together: one on the object, one in the hand that reaches for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Grip space → the object's scene space: the point where the object is held.
    pub on_object: Transform,
    /// Grip space → the hand's bone space: the palm; the identity when the bone itself goes to the grip.
    pub in_hand: Transform,
}

/// A bone's goal, for inverse kinematics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GripTarget {
    /// Origin of the hand's bone in the carrier's scene space.
    pub position: Vec3,
    /// Axes of the hand's bone in the carrier's scene space, a unit quaternion.
    pub rotation: Quat,
}

impl Grip {
    /// Returns the pose that the hand's bone has to reach, given the object's root ([`super::attached_root`]): object's
    /// scene space → carrier's scene space.
    ///
    /// ```text
    /// object * on_object = hand * in_hand        in position and direction; scales are the hand's own
    /// hand rotation      = |object * on_object| * in_hand.rotation⁻¹
    /// hand position      = object * on_object.translation - hand rotation * in_hand.translation
    /// ```
    ///
    /// `|…|` are the axes without their lengths (if they are mirrored, x and y are kept and z is reversed); where they
    /// have no length, the rotation is the identity. `in_hand.translation` is in the carrier's unit, so a hand whose
    /// bone is scaled has to include its scale in `in_hand`. Input numbers that are not finite are replaced by those of
    /// the identity; if the resulting position is not finite, it is the object's origin. Allocates nothing.
    pub fn target(&self, object: Mat4) -> GripTarget {
        let object = if object.is_finite() { object } else { Mat4::IDENTITY };
        let on_object = healthy(self.on_object, Transform::IDENTITY);
        let in_hand = healthy(self.in_hand, Transform::IDENTITY);
        let grip = Mat4::from_rotation_translation(on_object.rotation, on_object.translation);
        let axes = Axes::of(object * grip).map_or(Quat::IDENTITY, |axes| axes.rotation());
        let rotation = (axes * in_hand.rotation.conjugate()).normalize();
        let position = object.transform_point3(on_object.translation) - rotation * in_hand.translation;
        let fallback = object.w_axis.truncate();
        GripTarget { position: if position.is_finite() { position } else { fallback }, rotation }
    }
}
