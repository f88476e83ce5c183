//! Units, axes and frame rates of files, and their conversion to those of this library: meters, Y up, right-handed.
//!
//! This is the only place where a format converts coordinates. A reader finds out what its file means, lets the user's
//! [`Conventions`] take precedence, makes a [`Conversion`], converts every number with its [`AxisMap`], and hands the
//! conversion to [`ImportContext::converted`](super::ImportContext::converted), so that programs can show what was found
//! and what was done.

use crate::data::Transform;
use glam::{Mat3, Mat4, Quat, Vec3, Vec4};
use std::fmt;

/// Axis of a file that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum UpAxis {
    /// The x axis.
    X,
    /// The y axis, as in this library.
    #[default]
    Y,
    /// The z axis.
    Z,
}

impl UpAxis {
    /// All axes. The position of an axis is its number where it is stored.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

/// Sense of the axes of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Handedness {
    /// Left-handed: with x to the right and y up, z points away from the viewer.
    Left,
    /// Right-handed, as in this library.
    #[default]
    Right,
}

impl Handedness {
    /// Returns the sense of left-handed or right-handed axes.
    pub const fn of_left(is_left: bool) -> Self {
        if is_left { Self::Left } else { Self::Right }
    }
}

/// What the user says about a file, where it does not say so itself or is wrong. The default says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Conventions {
    /// Length of a unit of the file in meters; finite and greater than zero, anything else is ignored.
    pub meters_per_unit: Option<f32>,
    /// Axis that points up.
    pub up: Option<UpAxis>,
    /// Sense of the axes.
    pub handedness: Option<Handedness>,
    /// Frames or ticks per second, for formats that count time; finite and greater than zero, anything else is ignored.
    pub frame_rate: Option<f32>,
}

/// Where a convention of a file comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ConventionSource {
    /// The format prescribes it.
    Format,
    /// The file contains it.
    File,
    /// The reader derived it from the content, or took the usual value.
    Guess,
    /// The user chose it.
    User,
}

/// A convention of a file, and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<T> {
    /// The value.
    pub value: T,
    /// Origin of the value.
    pub source: ConventionSource,
}

impl<T> Found<T> {
    /// Returns a convention that the format prescribes.
    pub const fn by_format(value: T) -> Self {
        Self { value, source: ConventionSource::Format }
    }

    /// Returns a convention that the file contains.
    pub const fn in_file(value: T) -> Self {
        Self { value, source: ConventionSource::File }
    }

    /// Returns a convention that the reader assumes.
    pub const fn guessed(value: T) -> Self {
        Self { value, source: ConventionSource::Guess }
    }

    /// Returns the value if the user chose it.
    fn chosen(self) -> Option<T> {
        (self.source == ConventionSource::User).then_some(self.value)
    }

    /// Returns the user's choice, or this where the user chose nothing.
    pub fn or_chosen(self, chosen: Option<T>) -> Self {
        chosen.map_or(self, |value| Self { value, source: ConventionSource::User })
    }
}

/// The conventions that an import found, and so what it converted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// Length of a unit of the file in meters.
    pub meters_per_unit: Found<f32>,
    /// Axis of the file that points up.
    pub up: Found<UpAxis>,
    /// Sense of the axes of the file.
    pub handedness: Found<Handedness>,
    /// Frames or ticks per second of the file; `None` where the format counts seconds.
    pub frame_rate: Option<Found<f32>>,
}

impl Default for Conversion {
    /// Returns the conventions of this library, prescribed by the format: nothing is converted.
    fn default() -> Self {
        Self {
            meters_per_unit: Found::by_format(1.0),
            up: Found::by_format(UpAxis::Y),
            handedness: Found::by_format(Handedness::Right),
            frame_rate: None,
        }
    }
}

impl Conversion {
    /// Replaces what the user chose. Numbers that are not finite and greater than zero are ignored.
    pub fn with(self, chosen: &Conventions) -> Self {
        let positive = |number: Option<f32>| number.filter(|number| number.is_finite() && *number > 0.0);
        Self {
            meters_per_unit: self.meters_per_unit.or_chosen(positive(chosen.meters_per_unit)),
            up: self.up.or_chosen(chosen.up),
            handedness: self.handedness.or_chosen(chosen.handedness),
            frame_rate: self.frame_rate.map(|rate| rate.or_chosen(positive(chosen.frame_rate))),
        }
    }

    /// Returns what the user chose: a file that is read with these conventions has this conversion.
    pub fn chosen(&self) -> Conventions {
        Conventions {
            meters_per_unit: self.meters_per_unit.chosen(),
            up: self.up.chosen(),
            handedness: self.handedness.chosen(),
            frame_rate: self.frame_rate.and_then(|rate| rate.chosen()),
        }
    }

    /// Returns the map from the space of the file to the space of the model.
    pub fn axes(&self) -> AxisMap {
        AxisMap::new(self.up.value, self.handedness.value, self.meters_per_unit.value)
    }
}

impl fmt::Display for Conversion {
    /// Writes one line: `1 unit = 0.01 m (guessed), Z up (file), right-handed (format), 30 per second (file)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "1 unit = {} m ({})", self.meters_per_unit.value, self.meters_per_unit.source)?;
        write!(f, ", {:?} up ({})", self.up.value, self.up.source)?;
        let hand = match self.handedness.value {
            Handedness::Left => "left-handed",
            Handedness::Right => "right-handed",
        };
        write!(f, ", {hand} ({})", self.handedness.source)?;
        match self.frame_rate {
            Some(rate) => write!(f, ", {} per second ({})", rate.value, rate.source),
            None => Ok(()),
        }
    }
}

impl fmt::Display for ConventionSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Format => "format",
            Self::File => "file",
            Self::Guess => "guessed",
            Self::User => "chosen",
        })
    }
}

/// Converts numbers from the space of a file to the space of the model: axes are exchanged and reversed, lengths are
/// multiplied. Numbers that need no conversion stay bit for bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMap {
    /// Axis of the file for each axis of the model, 0 to 2.
    from: [usize; 3],
    /// 1 or -1 for each axis of the model.
    sign: Vec3,
    /// Meters per unit of the file.
    scale: f32,
    /// Whether the map mirrors.
    mirrors: bool,
}

impl AxisMap {
    /// Returns the map of a file with these conventions. `scale` is the number of meters per unit of the file.
    ///
    /// The up axis becomes y by a quarter turn about a horizontal axis of the file, and left-handed axes are mirrored in
    /// the horizontal axis of the file that is not x (for X up: z), so that what faces x in the file still faces x.
    pub fn new(up: UpAxis, handedness: Handedness, scale: f32) -> Self {
        let (from, mut sign) = match up {
            UpAxis::X => ([1, 0, 2], Vec3::new(-1.0, 1.0, 1.0)),
            UpAxis::Y => ([0, 1, 2], Vec3::ONE),
            UpAxis::Z => ([0, 2, 1], Vec3::new(1.0, 1.0, -1.0)),
        };
        let mirrors = handedness == Handedness::Left;
        if mirrors {
            sign.z = -sign.z;
        }
        Self { from, sign, scale, mirrors }
    }

    /// Returns the map from the space of the model to the space of the file.
    pub fn inverse(&self) -> Self {
        let (mut from, mut sign) = ([0; 3], Vec3::ONE);
        for (axis, &source) in self.from.iter().enumerate() {
            (from[source], sign[source]) = (axis, self.sign[axis]);
        }
        Self { from, sign, scale: 1.0 / self.scale, mirrors: self.mirrors }
    }

    /// Returns whether the map changes nothing.
    pub fn is_identity(&self) -> bool {
        self.from == [0, 1, 2] && self.sign == Vec3::ONE && self.scale == 1.0
    }

    /// Returns whether the map mirrors, so that the order of the corners of every triangle must be reversed.
    pub fn mirrors(&self) -> bool {
        self.mirrors
    }

    /// Returns the number of meters per unit of the file.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// Converts a direction or a normal; its length stays.
    pub fn direction(&self, direction: Vec3) -> Vec3 {
        let [x, y, z] = self.from;
        Vec3::new(direction[x], direction[y], direction[z]) * self.sign
    }

    /// Converts a position or a translation.
    pub fn position(&self, position: Vec3) -> Vec3 {
        self.direction(position) * self.scale
    }

    /// Converts a tangent whose `w` is the sense of the bitangent.
    pub fn tangent(&self, tangent: Vec4) -> Vec4 {
        self.direction(tangent.truncate()).extend(if self.mirrors { -tangent.w } else { tangent.w })
    }

    /// Converts factors of a scale along the axes.
    pub fn factors(&self, scale: Vec3) -> Vec3 {
        let [x, y, z] = self.from;
        Vec3::new(scale[x], scale[y], scale[z])
    }

    /// Converts a rotation. The sign of `w` stays, so that neighboring keys stay neighbors.
    pub fn rotation(&self, rotation: Quat) -> Quat {
        let axis = self.direction(Vec3::new(rotation.x, rotation.y, rotation.z));
        let axis = if self.mirrors { -axis } else { axis };
        Quat::from_xyzw(axis.x, axis.y, axis.z, rotation.w)
    }

    /// Converts a transform between two spaces of the file.
    pub fn transform(&self, transform: Transform) -> Transform {
        Transform {
            translation: self.position(transform.translation),
            rotation: self.rotation(transform.rotation),
            scale: self.factors(transform.scale),
        }
    }

    /// Converts a matrix between two spaces of the file: `M · matrix · M⁻¹` for this map `M`.
    pub fn matrix(&self, matrix: Mat4) -> Mat4 {
        let column = |axis: Vec4| self.direction(axis.truncate());
        let columns = [column(matrix.x_axis), column(matrix.y_axis), column(matrix.z_axis)];
        let [x, y, z] = self.from;
        let linear =
            Mat3::from_cols(columns[x] * self.sign.x, columns[y] * self.sign.y, columns[z] * self.sign.z);
        let translation = self.position(matrix.w_axis.truncate());
        Mat4::from_cols(
            linear.x_axis.extend(0.0),
            linear.y_axis.extend(0.0),
            linear.z_axis.extend(0.0),
            translation.extend(1.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPS: [UpAxis; 3] = [UpAxis::X, UpAxis::Y, UpAxis::Z];
    const HANDS: [Handedness; 2] = [Handedness::Left, Handedness::Right];

    fn maps() -> impl Iterator<Item = (UpAxis, Handedness, AxisMap)> {
        UPS.into_iter().flat_map(|up| HANDS.map(|hand| (up, hand, AxisMap::new(up, hand, 0.01))))
    }

    fn axis(up: UpAxis) -> Vec3 {
        match up {
            UpAxis::X => Vec3::X,
            UpAxis::Y => Vec3::Y,
            UpAxis::Z => Vec3::Z,
        }
    }

    #[test]
    fn up_becomes_y_and_the_sense_of_the_axes_becomes_right_handed() {
        for (up, hand, map) in maps() {
            assert_eq!(map.direction(axis(up)), Vec3::Y, "{up:?} {hand:?}");
            let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| map.direction(axis));
            // The axes of the file, as an observer with right-handed axes sees them.
            let determinant = x.cross(y).dot(z);
            assert_eq!(determinant < 0.0, hand == Handedness::Left, "{up:?} {hand:?}");
            assert_eq!(map.mirrors(), determinant < 0.0);
        }
    }

    #[test]
    fn rotations_transforms_and_matrices_move_points_as_in_the_file() {
        let transform = Transform {
            translation: Vec3::new(1.0, -2.0, 3.0),
            rotation: Quat::from_xyzw(0.3, -0.5, 0.1, 0.8).normalize(),
            scale: Vec3::new(0.5, 2.0, 3.0),
        };
        let point = Vec3::new(0.7, 0.2, -1.1);
        for (up, hand, map) in maps() {
            let moved = map.position(transform.to_matrix().transform_point3(point));
            let by_transform = map.transform(transform).to_matrix().transform_point3(map.position(point));
            let by_matrix = map.matrix(transform.to_matrix()).transform_point3(map.position(point));
            assert!(moved.distance(by_transform) < 1e-7, "{up:?} {hand:?}");
            assert!(moved.distance(by_matrix) < 1e-7, "{up:?} {hand:?}");
        }
    }

    #[test]
    fn the_inverse_of_a_map_leads_back_to_the_file() {
        let (point, turn) = (Vec3::new(1.0, -2.0, 3.0), Quat::from_xyzw(0.3, -0.5, 0.1, 0.8));
        for (up, hand, map) in maps() {
            let back = map.inverse();
            assert!(back.position(map.position(point)).distance(point) < 1e-6, "{up:?} {hand:?}");
            assert_eq!(back.rotation(map.rotation(turn)), turn, "{up:?} {hand:?}");
        }
    }

    #[test]
    fn the_conventions_of_the_library_change_no_bit() {
        let map = Conversion::default().axes();
        assert!(map.is_identity());
        let numbers = [0.1_f32, -0.0, 1e-40, 3.3e38];
        for number in numbers {
            let vector = Vec3::splat(number);
            assert_eq!(map.position(vector).to_array().map(f32::to_bits), [number.to_bits(); 3]);
            assert_eq!(map.factors(vector).to_array().map(f32::to_bits), [number.to_bits(); 3]);
            let rotation = Quat::from_xyzw(number, number, number, number);
            assert_eq!(map.rotation(rotation).to_array().map(f32::to_bits), [number.to_bits(); 4]);
        }
    }

    #[test]
    fn the_user_takes_precedence_over_the_file_except_with_impossible_numbers() {
        let found = Conversion { frame_rate: Some(Found::in_file(30.0)), ..Conversion::default() };
        let chosen = Conventions {
            meters_per_unit: Some(0.01),
            up: Some(UpAxis::Z),
            frame_rate: Some(f32::NAN),
            ..Conventions::default()
        };
        let conversion = found.with(&chosen);
        assert_eq!(
            conversion.to_string(),
            "1 unit = 0.01 m (chosen), Z up (chosen), right-handed (format), 30 per second (file)"
        );
        assert_eq!(found.with(&Conventions::default()), found);
        let seconds =
            Conversion::default().with(&Conventions { frame_rate: Some(24.0), ..Conventions::default() });
        assert_eq!(seconds.frame_rate, None);
    }
}
