//! Original, change and result of a bone as numbers, and back (the rules are those of the document):
//!
//! ```text
//! translation   result = original + change
//! rotation      result = change * original        space of the parent
//! scale         result = original * change        per component
//! ```

use super::turn;
use dragonfly_anim::data::{BoneIndex, Transform};
use dragonfly_anim::joint::EulerOrder;
use dragonfly_document::edit::{BonePose, BoneRef, Property};
use glam::{DQuat, Quat, Vec3};

/// A column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Column {
    /// As read from the file.
    Original,
    /// The change from original to result.
    Change,
    /// The combination of both.
    Result,
}

impl Column {
    /// All columns in their order.
    pub const ALL: [Self; 3] = [Self::Original, Self::Change, Self::Result];

    /// Returns the heading of the column.
    pub fn title(self) -> &'static str {
        match self {
            Self::Original => "Original",
            Self::Change => "Change",
            Self::Result => "Result",
        }
    }
}

/// Form in which the numbers of a channel are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NumberForm {
    /// Three numbers: translation, scale.
    Vector,
    /// Three angles in degrees.
    Euler(EulerOrder),
    /// Four numbers: x, y, z, w.
    Quaternion,
}

impl NumberForm {
    /// Returns how many numbers there are.
    pub fn count(self) -> usize {
        if self == Self::Quaternion { 4 } else { 3 }
    }
}

/// A bone at a time: original and result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// As read from the file.
    pub original: Transform,
    /// As it is now.
    pub result: Transform,
}

/// Numbers of a channel; if there are three, the last is 0.
pub type FieldNumbers = [f64; 4];

/// Returns the numbers of a column; `None` if there are none, such as the change of a scale that was 0.
pub fn numbers(pair: &Pair, property: Property, column: Column, form: NumberForm) -> Option<FieldNumbers> {
    match property {
        Property::Rotation => {
            let [original, result] = [pair.original, pair.result].map(|pose| pose.rotation.as_dquat());
            let rotation = match column {
                Column::Original => original,
                Column::Result => result,
                Column::Change if pair.original.rotation == pair.result.rotation => DQuat::IDENTITY,
                Column::Change => result * original.conjugate(),
            };
            Some(turn_numbers(form, rotation)).filter(finite)
        }
        Property::Translation | Property::Scale => {
            let [original, result] =
                [pair.original, pair.result].map(|pose| vector(&pose, property).to_array().map(f64::from));
            let value = std::array::from_fn(|axis| match (column, original.get(axis), result.get(axis)) {
                (Column::Original, Some(&original), _) => original,
                (Column::Result, _, Some(&result)) => result,
                (Column::Change, Some(original), Some(result)) if property == Property::Translation => {
                    result - original
                }
                (Column::Change, Some(original), Some(result)) if original == result => 1.0,
                (Column::Change, Some(original), Some(result)) => result / original,
                _ => 0.0,
            });
            Some(value).filter(finite)
        }
    }
}

/// Returns the part of a pose for which a column shows these numbers; `None` if there is none: a quaternion of zeros, a
/// change of a scale that was 0.
pub fn part(
    original: &Transform,
    property: Property,
    column: Column,
    form: NumberForm,
    numbers: FieldNumbers,
) -> Option<PosePart> {
    match property {
        Property::Rotation => {
            let rotation = turn_of(form, numbers)?;
            Some(PosePart::Turn(match column {
                // Exact to the bit, as an identity change gives the original.
                Column::Change if rotation == DQuat::IDENTITY => original.rotation,
                Column::Change => (rotation * original.rotation.as_dquat()).normalize().as_quat(),
                Column::Original | Column::Result => rotation.as_quat(),
            }))
            .filter(|part| matches!(part, PosePart::Turn(turn) if turn.is_finite()))
        }
        Property::Translation | Property::Scale => {
            let from = vector(original, property).to_array();
            let value = [0, 1, 2].map(|axis| match (column, property) {
                (Column::Change, Property::Scale) => (f64::from(from[axis]) * numbers[axis]) as f32,
                (Column::Change, _) => (f64::from(from[axis]) + numbers[axis]) as f32,
                _ => numbers[axis] as f32,
            });
            let vanishes =
                property == Property::Scale && (0..3).any(|axis| from[axis] == 0.0 && numbers[axis] != 1.0);
            let stuck = vanishes && column == Column::Change;
            Some(PosePart::Vector(Vec3::from_array(value)))
                .filter(|_| !stuck && value.iter().all(|x| x.is_finite()))
        }
    }
}

/// The part of a pose that belongs to one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PosePart {
    /// Translation or scale.
    Vector(Vec3),
    /// Rotation.
    Turn(Quat),
}

impl PosePart {
    /// Returns the part of a pose.
    pub fn of(pose: &Transform, property: Property) -> Self {
        match property {
            Property::Rotation => Self::Turn(pose.rotation),
            _ => Self::Vector(vector(pose, property)),
        }
    }

    /// Returns the part as edits contain it.
    pub fn pose(self, bone: BoneIndex, property: Property) -> BonePose {
        let mut pose =
            BonePose { bone: BoneRef::Index(bone), translation: None, rotation: None, scale: None };
        match (self, property) {
            (Self::Vector(value), Property::Scale) => pose.scale = Some(value.to_array()),
            (Self::Vector(value), _) => pose.translation = Some(value.to_array()),
            (Self::Turn(value), _) => pose.rotation = Some(value.to_array()),
        }
        pose
    }

    /// Writes the part into a pose.
    pub fn put(self, pose: &mut Transform, property: Property) {
        match (self, property) {
            (Self::Vector(value), Property::Scale) => pose.scale = value,
            (Self::Vector(value), _) => pose.translation = value,
            (Self::Turn(value), _) => pose.rotation = value,
        }
    }

    /// Returns whether both are equal up to rounding errors.
    pub fn is_near(self, other: Self) -> bool {
        match (self, other) {
            (Self::Vector(a), Self::Vector(b)) => {
                let grain = 4.0 * f32::EPSILON * a.abs().max_element().max(b.abs().max_element());
                (a - b).abs().max_element() <= grain
            }
            (Self::Turn(a), Self::Turn(b)) => is_same_turn(a.as_dquat(), b.as_dquat()),
            _ => false,
        }
    }
}

/// Returns the numbers of a rotation.
pub fn turn_numbers(form: NumberForm, rotation: DQuat) -> FieldNumbers {
    match form {
        NumberForm::Euler(order) => {
            let [x, y, z] = turn::degrees(order, rotation);
            [x, y, z, 0.0]
        }
        // Of q and -q, which are the same rotation, the one with a positive w is shown.
        _ if rotation.w < 0.0 => (-rotation).to_array(),
        _ => rotation.to_array(),
    }
}

/// Returns the rotation with these numbers; `None` if they are not a rotation.
pub fn turn_of(form: NumberForm, numbers: FieldNumbers) -> Option<DQuat> {
    match form {
        NumberForm::Euler(_) if numbers[..3] == [0.0; 3] => Some(DQuat::IDENTITY),
        NumberForm::Euler(order) => Some(turn::rotation(order, [numbers[0], numbers[1], numbers[2]])),
        _ => {
            let rotation = DQuat::from_array(numbers);
            let length = rotation.length();
            (length > 1e-6 && length.is_finite()).then(|| rotation / length)
        }
    }
}

/// Whether two rotations are equal up to the rounding error of single precision.
pub fn is_same_turn(a: DQuat, b: DQuat) -> bool {
    (a - b).length().min((a + b).length()) < 2e-6
}

fn vector(pose: &Transform, property: Property) -> Vec3 {
    if property == Property::Scale { pose.scale } else { pose.translation }
}

fn finite(numbers: &FieldNumbers) -> bool {
    numbers.iter().all(|number| number.is_finite())
}
