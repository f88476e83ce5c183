//! Units and axes of the file, and the way from its numbers to those of the model.

use crate::code::FBX_NUMBER;
use dragonfly_anim::data::Transform;
use dragonfly_anim::format::{AxisMap, Conversion, Found, Handedness, ImportContext, Place, UpAxis};
use glam::{DMat4, DQuat, DVec3, DVec4, Mat4, Quat, Vec3};
use ufbx::CoordinateAxis;

/// Length of a unit of files that state none: FBX counts in centimeters.
const USUAL_UNIT: f32 = 0.01;

/// Converts numbers of the file.
pub(super) struct FbxSpace {
    map: AxisMap,
    /// Rotation of everything about the up axis of the model, so that what faces front in the file faces +Z. The identity
    /// for the usual files.
    turn: Quat,
}

/// Direction of an axis of the file; `None` where the file gives none.
fn direction(axis: CoordinateAxis) -> Option<Vec3> {
    match axis {
        CoordinateAxis::PositiveX => Some(Vec3::X),
        CoordinateAxis::NegativeX => Some(Vec3::NEG_X),
        CoordinateAxis::PositiveY => Some(Vec3::Y),
        CoordinateAxis::NegativeY => Some(Vec3::NEG_Y),
        CoordinateAxis::PositiveZ => Some(Vec3::Z),
        CoordinateAxis::NegativeZ => Some(Vec3::NEG_Z),
        CoordinateAxis::Unknown => None,
    }
}

impl FbxSpace {
    /// Finds out what the file means, lets the choices of the user take precedence, and records both.
    pub(super) fn new(settings: &ufbx::SceneSettings, context: &ImportContext<'_>) -> Self {
        let unit = settings.unit_meters as f32;
        let is_length = unit.is_finite() && unit > 0.0;
        let axes = [settings.axes.right, settings.axes.up, settings.axes.front].map(direction);
        let frame = match axes {
            [Some(right), Some(up), Some(front)] if right.cross(up).dot(front).abs() == 1.0 => {
                Some([right, up, front])
            }
            _ => None,
        };
        let (up, handedness) = match frame {
            Some([right, up, front]) => {
                let axis = if up.x != 0.0 {
                    UpAxis::X
                } else if up.y != 0.0 {
                    UpAxis::Y
                } else {
                    UpAxis::Z
                };
                let is_right = right.cross(up).dot(front) > 0.0;
                let hand = if is_right { Handedness::Right } else { Handedness::Left };
                (Found::in_file(axis), Found::in_file(hand))
            }
            None => (Found::guessed(UpAxis::Y), Found::guessed(Handedness::Right)),
        };
        let found = Conversion {
            meters_per_unit: if is_length { Found::in_file(unit) } else { Found::guessed(USUAL_UNIT) },
            up,
            handedness,
            // The format counts time in parts of a second.
            frame_rate: None,
        };
        let conversion = found.with(context.conventions());
        context.converted(conversion);
        let map = conversion.axes();
        let is_chosen = conversion.up != found.up || conversion.handedness != found.handedness;
        let turn = frame.filter(|_| !is_chosen).map_or(Quat::IDENTITY, |frame| turn(&map, frame));
        Self { map, turn }
    }

    /// Returns whether the order of the corners of a triangle must be reversed.
    pub(super) fn mirrors(&self) -> bool {
        self.map.mirrors()
    }

    /// Returns the number of meters per unit of the file.
    pub(super) fn meters(&self) -> f64 {
        f64::from(self.map.scale())
    }

    /// Converts a position inside a node, or a difference of two.
    pub(super) fn position(&self, position: ufbx::Vec3) -> Vec3 {
        self.map.position(vec3(position))
    }

    /// Converts a direction.
    pub(super) fn direction(&self, direction: ufbx::Vec3) -> Vec3 {
        self.map.direction(vec3(direction))
    }

    /// Converts a matrix between two spaces of the file.
    pub(super) fn matrix(&self, matrix: DMat4) -> Mat4 {
        self.map.matrix(matrix.as_mat4())
    }

    /// Converts the translation of a node; `is_top`: whether its parent is the scene.
    pub(super) fn translation(&self, translation: DVec3, is_top: bool) -> Vec3 {
        let translation = self.map.position(translation.as_vec3());
        if is_top && self.turn != Quat::IDENTITY { self.turn * translation } else { translation }
    }

    /// Converts the rotation of a node, or a tangent of one.
    pub(super) fn rotation(&self, rotation: DQuat, is_top: bool) -> Quat {
        let rotation = self.map.rotation(rotation.as_quat());
        if is_top && self.turn != Quat::IDENTITY { self.turn * rotation } else { rotation }
    }

    /// Converts the scale of a node.
    pub(super) fn factors(&self, scale: DVec3) -> Vec3 {
        self.map.factors(scale.as_vec3())
    }

    /// Converts the transform of a node relative to its parent.
    pub(super) fn local(&self, pose: &Pose64, is_top: bool) -> Transform {
        Transform {
            translation: self.translation(pose.translation, is_top),
            rotation: self.rotation(pose.rotation, is_top).normalize(),
            scale: self.factors(pose.scale),
        }
    }

    /// Converts the matrix of a node in the scene.
    pub(super) fn in_scene(&self, matrix: DMat4) -> Mat4 {
        Mat4::from_quat(self.turn) * self.matrix(matrix)
    }
}

/// Returns the rotation that brings the axes of the file, converted, to right = +X, up = +Y, front = +Z.
fn turn(map: &AxisMap, [right, up, front]: [Vec3; 3]) -> Quat {
    let converted = glam::Mat3::from_cols(map.direction(right), map.direction(up), map.direction(front));
    // The columns are axes, so that the inverse is the transposed matrix; a mirrored frame stays as it is.
    if converted.determinant() < 0.0 || converted == glam::Mat3::IDENTITY {
        return Quat::IDENTITY;
    }
    Quat::from_mat3(&converted.transpose()).normalize()
}

/// A transform in the precision and the units of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose64 {
    pub(super) translation: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: DVec3,
}

impl Pose64 {
    /// Returns a transform of the parser. Numbers that no model may contain are replaced; the second value is whether
    /// there were any.
    pub(super) fn of(transform: &ufbx::Transform) -> (Self, bool) {
        let mut is_fixed = false;
        let mut finite = |value: DVec3, other: DVec3| {
            let is_good = value.is_finite() && value.abs().max_element() < LARGEST;
            is_fixed |= !is_good;
            if is_good { value } else { other }
        };
        let translation = finite(dvec3(transform.translation), DVec3::ZERO);
        let scale = finite(dvec3(transform.scale), DVec3::ONE);
        let raw = transform.rotation;
        let raw = DQuat::from_xyzw(raw.x, raw.y, raw.z, raw.w);
        let is_unit = raw.is_finite() && raw.length_squared() > 1e-12;
        let rotation = if is_unit { raw.normalize() } else { DQuat::IDENTITY };
        (Self { translation, rotation, scale }, is_fixed || !is_unit)
    }
}

/// Largest number that is taken as it is; products of a chain of larger ones do not fit single precision.
const LARGEST: f64 = 1e12;

/// Returns the position, with a zero for each number that no model may contain.
pub(super) fn vec3(vector: ufbx::Vec3) -> Vec3 {
    let number = |value: f64| if value.is_finite() { value.clamp(-LARGEST, LARGEST) as f32 } else { 0.0 };
    Vec3::new(number(vector.x), number(vector.y), number(vector.z))
}

/// Returns the vector of the other library.
pub(super) fn dvec3(vector: ufbx::Vec3) -> DVec3 {
    DVec3::new(vector.x, vector.y, vector.z)
}

/// Returns the matrix of the other library.
pub(super) fn dmat4(matrix: &ufbx::Matrix) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(matrix.m00, matrix.m10, matrix.m20, 0.0),
        DVec4::new(matrix.m01, matrix.m11, matrix.m21, 0.0),
        DVec4::new(matrix.m02, matrix.m12, matrix.m22, 0.0),
        DVec4::new(matrix.m03, matrix.m13, matrix.m23, 1.0),
    )
}

/// Adds the warning about numbers that were replaced.
pub(super) fn warn_numbers(place: String, context: &ImportContext<'_>) {
    let text = "numbers that are not finite, or too large, were replaced";
    context.warn(Place::Pointer(place), FBX_NUMBER, text);
}
