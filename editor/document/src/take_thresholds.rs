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
use std::path::{Path, PathBuf};

use crate::adapter::stored_contacts;

/// The largest file that is read, bytes.
const MOST_BYTES: u64 = 4 << 20;

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
    /// with the take are used for foot slide.
    ///
    /// # Errors
    ///
    /// The reason why the take cannot be checked: a joint of a bone that is missing, or a rate.
    pub fn check(&self, take: &Take, skeleton: &Skeleton, rate: f32) -> Result<Vec<LintFinding>, String> {
        let mut limits = self.limits.clone();
        limits.given = stored_contacts(&take.extras, skeleton);
        limits.contacts.meters_per_unit = self.unit_of(skeleton);
        for (name, limit) in &self.joints {
            let named = skeleton.bones.iter().enumerate().filter(|(_, bone)| bone.name == *name);
            let mut found = named.peekable();
            if found.peek().is_none() {
                return Err(format!("\"joints\" has a bone {name:?} that the model does not have"));
            }
            for (bone, _) in found {
                limits.joints.set(bone as BoneIndex, *limit);
            }
        }
        let rate = self.rate.unwrap_or(rate);
        lint_take(take, skeleton, rate, &limits).map_err(|error| error.to_string())
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
        let text =
            JointText::deserialize(value).map_err(|error| format!("the joint of {name:?}: {error}"))?;
        let limit = text.limit().ok_or_else(|| format!("the joint of {name:?}: an axis has no direction"))?;
        Ok((name.clone(), limit))
    };
    object.iter().map(joint).collect()
}

impl JointText {
    /// Returns the limit; `None` where an axis has no direction.
    fn limit(self) -> Option<JointLimit> {
        let range = |[min, max]: [f32; 2]| AngleRange::degrees(min, max);
        Some(match self {
            Self::Hinge { axis, range: angles } => {
                JointLimit::Hinge(Hinge { axis: axis.direction()?, range: range(angles) })
            }
            Self::Ball { axis, side, swing, twist } => {
                let side = side.map_or(Some(Vec3::ZERO), AxisText::direction)?;
                let [swing_side, swing_up] = swing.angles().map(f32::to_radians);
                let twist = twist.map_or(AngleRange::FREE, range);
                JointLimit::Ball(Ball { axis: axis.direction()?, side, swing_side, swing_up, twist })
            }
            Self::Euler { order, x, y, z } => {
                let order = order.map_or(EulerOrder::Xyz, OrderText::order);
                let ranges = [x, y, z].map(|angles| angles.map_or(AngleRange::FREE, range));
                JointLimit::Euler(Euler { order, ranges })
            }
        })
    }
}

impl AxisText {
    /// Returns the direction; `None` where it has none.
    fn direction(self) -> Option<Vec3> {
        let direction = match self {
            Self::Letter(LetterText::X) => Vec3::X,
            Self::Letter(LetterText::Y) => Vec3::Y,
            Self::Letter(LetterText::Z) => Vec3::Z,
            Self::Direction(direction) => Vec3::from_array(direction),
        };
        direction.try_normalize()
    }
}

impl SwingText {
    /// Returns the angles about the side and across it, degrees.
    fn angles(self) -> [f32; 2] {
        match self {
            Self::Round(angle) => [angle; 2],
            Self::Elliptic(angles) => angles,
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
