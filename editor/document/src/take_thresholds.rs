//! Thresholds for the check of takes, as JSON files that users keep next to a model.
//!
//! ```json
//! {"pop": 80, "floor": null, "meters_per_unit": 0.01, "up": "y", "floor_height": 0, "rate": 30,
//!  "joints": {"Shin.L": {"hinge": {"axis": "x", "range": [0, 150]}},
//!             "Head": {"ball": {"axis": "y", "swing": [60, 40], "twist": [-70, 70]}},
//!             "Spine": {"euler": {"order": "xyz", "x": [-30, 30], "y": [-40, 40]}}}}
//! ```
//!
//! A rule that is missing has its usual threshold; `null` switches it off. Angles are in degrees, from the rest pose, about the rest
//! axes of the bone. Of `Fox.glb`, the file is `Fox.check.json`.

use super::folder::read_file;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take};
use dragonfly_anim::joint::{AngleRange, Ball, Euler, EulerOrder, Hinge, JointLimit};
use dragonfly_anim::lint::{LintFinding, LintRule, LintThresholds, lint_take};
use dragonfly_anim::model_unit::ModelUnit;
use dragonfly_anim::motion::Axis;
use glam::Vec3;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use crate::adapter::stored_contacts;

/// The largest file that is read, bytes.
const MOST_BYTES: u64 = 4 << 20;

/// Number of unknown bones that a message names.
const NAMED: usize = 3;

/// Thresholds for the check of takes.
#[derive(Clone, Debug, Default)]
pub struct TakeThresholds {
    rate: Option<f32>,
    meters_per_unit: Option<f32>,
    limits: LintThresholds,
    /// Limits of joints by the names of their bones.
    joints: Vec<(String, JointLimit)>,
}

/// The limit of a joint as it is written in a file.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum JointText {
    /// About one axis.
    Hinge { axis: AxisText, range: [f32; 2] },
    /// Swing within a cone, and twist.
    Ball { axis: AxisText, side: Option<AxisText>, swing: SwingText, twist: Option<[f32; 2]> },
    /// Three angles; an axis without a range turns freely.
    Euler { order: Option<OrderText>, x: Option<[f32; 2]>, y: Option<[f32; 2]>, z: Option<[f32; 2]> },
}

/// An axis by its letter, or any direction.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
enum AxisText {
    /// One of the axes of the bone.
    Letter(LetterText),
    /// A direction.
    Direction([f32; 3]),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum LetterText {
    X,
    Y,
    Z,
}

/// The largest swing: one for all directions, or about the side and across it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
enum SwingText {
    /// A round cone.
    Round(f32),
    /// An elliptic cone.
    Elliptic([f32; 2]),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum OrderText {
    Xyz,
    Xzy,
    Yxz,
    Yzx,
    Zxy,
    Zyx,
}

impl TakeThresholds {
    /// Returns the path of the thresholds of a model.
    pub fn beside(model: &Path) -> PathBuf {
        model.with_extension("check.json")
    }

    /// Reads the thresholds next to a model; the usual ones where there are none.
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub fn of_model(model: &Path) -> Result<Self, String> {
        let path = Self::beside(model);
        if path.exists() { Self::read(&path) } else { Ok(Self::default()) }
    }

    /// Reads a file of thresholds.
    ///
    /// # Errors
    ///
    /// The path, and why the file cannot be read or which value in it is wrong.
    pub fn read(path: &Path) -> Result<Self, String> {
        let told = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let bytes = read_file(path, MOST_BYTES).map_err(|error| told(&error))?;
        let value: Value = serde_json::from_slice(&bytes).map_err(|error| told(&error))?;
        Self::of(&value).map_err(|reason| told(&reason))
    }

    /// Returns them with the meters in one unit of length, where they do not have them.
    #[must_use]
    pub fn with_unit(self, meters_per_unit: f32) -> Self {
        Self { meters_per_unit: self.meters_per_unit.or(Some(meters_per_unit)), ..self }
    }

    /// Returns the meters in one unit of a model with this skeleton; where they are not given, they are guessed from the size of
    /// the figure.
    pub fn unit_of(&self, skeleton: &Skeleton) -> f32 {
        self.meters_per_unit.unwrap_or_else(|| ModelUnit::of(skeleton).meters)
    }

    /// Returns the defects of a take, sampled at `rate` frames per second unless the thresholds have a rate. The contacts stored
    /// with the take are used for foot slide. Limits of joints whose bones the skeleton does not have are left out, see
    /// [`Self::unknown_joints`].
    ///
    /// # Errors
    ///
    /// The reason why the take cannot be checked: a rate.
    pub fn check(&self, take: &Take, skeleton: &Skeleton, rate: f32) -> Result<Vec<LintFinding>, String> {
        let mut limits = self.limits.clone();
        limits.given = stored_contacts(&take.extras, skeleton);
        limits.contacts.meters_per_unit = self.unit_of(skeleton);
        if !self.joints.is_empty() {
            let joints: HashMap<&str, JointLimit> =
                self.joints.iter().map(|(name, limit)| (name.as_str(), *limit)).collect();
            for (bone, own) in skeleton.bones.iter().enumerate() {
                if let Some(limit) = joints.get(own.name.as_str()) {
                    limits.joints.set(bone as BoneIndex, *limit);
                }
            }
        }
        let rate = self.rate.unwrap_or(rate);
        lint_take(take, skeleton, rate, &limits).map_err(|error| error.to_string())
    }

    /// Returns a sentence about the limits of joints whose bones a skeleton does not have; `None` where it has all of them.
    pub fn unknown_joints(&self, skeleton: &Skeleton) -> Option<String> {
        let known: HashSet<&str> = skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
        let mut unknown = self.joints.iter().filter(|(name, _)| !known.contains(name.as_str()));
        let named: Vec<String> = unknown.by_ref().take(NAMED).map(|(name, _)| format!("{name:?}")).collect();
        let more = match unknown.count() {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        let names = named.join(", ");
        (!named.is_empty())
            .then(|| format!("\"joints\" names bones that the model does not have: {names}{more}"))
    }

    fn of(value: &Value) -> Result<Self, String> {
        let object = value.as_object().ok_or("an object with thresholds is expected")?;
        let mut thresholds = Self::default();
        for (name, value) in object {
            if let Some(rule) = LintRule::ALL.into_iter().find(|rule| rule.name() == name) {
                let limit = if value.is_null() { None } else { Some(number(name, value)?) };
                thresholds.limits = thresholds.limits.with(rule, limit);
                continue;
            }
            match name.as_str() {
                "rate" => thresholds.rate = Some(positive(name, value)?),
                "meters_per_unit" => thresholds.meters_per_unit = Some(positive(name, value)?),
                "floor_height" => thresholds.limits.floor = number(name, value)?,
                "up" => thresholds.limits.contacts.up = axis(value)?,
                "joints" => thresholds.joints = joints(value)?,
                _ => {
                    let names = LintRule::ALL.map(LintRule::name).join(", ");
                    return Err(format!(
                        "there is no threshold {name:?}; there are {names}, and rate, meters_per_unit, floor_height, up, joints"
                    ));
                }
            }
        }
        Ok(thresholds)
    }
}

fn number(name: &str, value: &Value) -> Result<f32, String> {
    let number = value.as_f64().map(|number| number as f32).filter(|number| number.is_finite());
    number.ok_or_else(|| format!("{name:?} has to be a number, not {value}"))
}

fn positive(name: &str, value: &Value) -> Result<f32, String> {
    let number = number(name, value)?;
    if number > 0.0 { Ok(number) } else { Err(format!("{name:?} has to be above 0")) }
}

fn axis(value: &Value) -> Result<Axis, String> {
    match LetterText::deserialize(value) {
        Ok(LetterText::X) => Ok(Axis::X),
        Ok(LetterText::Y) => Ok(Axis::Y),
        Ok(LetterText::Z) => Ok(Axis::Z),
        Err(_) => Err(format!("\"up\" has to be \"x\", \"y\" or \"z\", not {value}")),
    }
}

fn joints(value: &Value) -> Result<Vec<(String, JointLimit)>, String> {
    let none = Map::new();
    let object = if value.is_null() { Some(&none) } else { value.as_object() };
    let object = object.ok_or("\"joints\" has to be an object with the limit of each bone")?;
    let joint = |(name, value): (&String, &Value)| {
        let limit =
            JointText::deserialize(value).map_err(|error| error.to_string()).and_then(JointText::limit);
        Ok((name.clone(), limit.map_err(|reason| format!("the joint of {name:?}: {reason}"))?))
    };
    object.iter().map(joint).collect()
}

/// Returns a range of angles, given in degrees.
fn range([min, max]: [f32; 2]) -> Result<AngleRange, String> {
    if min > max {
        return Err(format!("the range [{min}, {max}] ends before it begins"));
    }
    Ok(AngleRange::degrees(finite(min)?, finite(max)?))
}

/// Returns a range of angles, given in degrees; all angles where there is none.
fn range_or_free(angles: Option<[f32; 2]>) -> Result<AngleRange, String> {
    angles.map_or(Ok(AngleRange::FREE), range)
}

/// Returns the number, unless it was too large for single precision.
fn finite(number: f32) -> Result<f32, String> {
    if number.is_finite() { Ok(number) } else { Err("a number is too large".to_owned()) }
}

impl JointText {
    /// Returns the limit.
    ///
    /// # Errors
    ///
    /// The reason why no joint can have it: an axis without a direction, a range or a swing that is none.
    fn limit(self) -> Result<JointLimit, String> {
        Ok(match self {
            Self::Hinge { axis, range: angles } => {
                JointLimit::Hinge(Hinge { axis: axis.direction()?, range: range(angles)? })
            }
            Self::Ball { axis, side, swing, twist } => {
                let side = side.map_or(Ok(Vec3::ZERO), AxisText::direction)?;
                let [swing_side, swing_up] = swing.angles()?.map(f32::to_radians);
                let (axis, twist) = (axis.direction()?, range_or_free(twist)?);
                JointLimit::Ball(Ball { axis, side, swing_side, swing_up, twist })
            }
            Self::Euler { order, x, y, z } => {
                let order = order.map_or(EulerOrder::Xyz, OrderText::order);
                let ranges = [range_or_free(x)?, range_or_free(y)?, range_or_free(z)?];
                JointLimit::Euler(Euler { order, ranges })
            }
        })
    }
}

impl AxisText {
    /// Returns the direction.
    ///
    /// # Errors
    ///
    /// It has none.
    fn direction(self) -> Result<Vec3, String> {
        let direction = match self {
            Self::Letter(LetterText::X) => Vec3::X,
            Self::Letter(LetterText::Y) => Vec3::Y,
            Self::Letter(LetterText::Z) => Vec3::Z,
            Self::Direction(direction) => Vec3::from_array(direction),
        };
        direction.try_normalize().ok_or_else(|| "an axis has no direction".to_owned())
    }
}

impl SwingText {
    /// Returns the angles about the side and across it, degrees.
    ///
    /// # Errors
    ///
    /// One of them is below zero or too large.
    fn angles(self) -> Result<[f32; 2], String> {
        let angles = match self {
            Self::Round(angle) => [angle; 2],
            Self::Elliptic(angles) => angles,
        };
        match angles.into_iter().find(|angle| *angle < 0.0) {
            Some(angle) => Err(format!("the swing {angle} is below 0")),
            None => Ok([finite(angles[0])?, finite(angles[1])?]),
        }
    }
}

impl OrderText {
    fn order(self) -> EulerOrder {
        match self {
            Self::Xyz => EulerOrder::Xyz,
            Self::Xzy => EulerOrder::Xzy,
            Self::Yxz => EulerOrder::Yxz,
            Self::Yzx => EulerOrder::Yzx,
            Self::Zxy => EulerOrder::Zxy,
            Self::Zyx => EulerOrder::Zyx,
        }
    }
}
