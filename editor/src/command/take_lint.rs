//! `dragonfly check --takes`: the defects of takes, measured frame by frame.

use super::Failure;
use super::choice::plain;
use dragonfly_anim::data::{AnimationData, Skeleton};
use dragonfly_anim::frames::frame_rate;
use dragonfly_anim::lint::{LintRule, LintThresholds, lint_take};
use dragonfly_anim::model_unit::ModelUnit;
use dragonfly_anim::motion::Axis;
use dragonfly_document::adapter::stored_contacts;
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};
use std::path::Path;

/// One defect of a take.
#[derive(Serialize)]
pub(super) struct TakeDefect {
    take: String,
    rule: &'static str,
    bone: String,
    frame: i64,
    time: f32,
    amount: f32,
    unit: &'static str,
}

impl TakeDefect {
    /// Writes it as one line.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let Self { take, rule, bone, frame, amount, unit, .. } = self;
        let (take, bone) = (plain(take), plain(bone));
        writeln!(out, "  {rule}: take {take}, bone {bone}, frame {frame}: {amount:.1} {unit}")
    }
}

/// Returns the defects of all takes, in their order.
pub(super) fn defects(
    animation: &AnimationData,
    thresholds: &TakeThresholds,
) -> Result<Vec<TakeDefect>, Failure> {
    let skeleton = &animation.skeleton;
    let mut defects = Vec::new();
    for take in &animation.takes {
        let rate = thresholds.rate.unwrap_or_else(|| frame_rate(take));
        let given = stored_contacts(&take.extras, skeleton);
        let mut limits = thresholds.limits.clone();
        limits.given = given;
        limits.contacts.meters_per_unit = thresholds.unit_of(skeleton);
        let found = lint_take(take, skeleton, rate, &limits)
            .map_err(|error| Failure::Input(format!("take {}: {error}", plain(&take.name))))?;
        defects.extend(found.into_iter().map(|finding| TakeDefect {
            take: take.name.clone(),
            rule: finding.rule.name(),
            bone: skeleton.bones[finding.bone as usize].name.clone(),
            frame: finding.frame,
            time: finding.time,
            amount: finding.amount,
            unit: finding.rule.unit(),
        }));
    }
    Ok(defects)
}

/// The thresholds of `--thresholds FILE`, a JSON object. A rule that is missing has its usual threshold; `null` switches it
/// off. Besides the names of rules it may contain `rate`, `meters_per_unit`, `up` and `floor_height`.
#[derive(Clone, Debug, Default)]
pub(super) struct TakeThresholds {
    /// Frames per second; by default the lowest usual rate that fits the keys of a take.
    rate: Option<f32>,
    /// Meters in one unit of the model; by default guessed from the size of the figure.
    meters_per_unit: Option<f32>,
    limits: LintThresholds,
}

impl TakeThresholds {
    /// Reads them from a file.
    pub(super) fn read(file: &Path) -> Result<Self, Failure> {
        let bytes = std::fs::read(file).map_err(|error| Failure::input(file.display(), error))?;
        let value: Value =
            serde_json::from_slice(&bytes).map_err(|error| Failure::input(file.display(), error))?;
        Self::of(&value).map_err(|reason| Failure::input(file.display(), reason))
    }

    /// Returns the meters in one unit of a model with this skeleton.
    pub(super) fn unit_of(&self, skeleton: &Skeleton) -> f32 {
        self.meters_per_unit.unwrap_or_else(|| ModelUnit::of(skeleton).meters)
    }

    fn of(value: &Value) -> Result<Self, String> {
        let object = value.as_object().ok_or("an object with thresholds is expected")?;
        let mut thresholds = Self::default();
        for (name, value) in object {
            let number = || {
                let number = value.as_f64().map(|number| number as f32).filter(|number| number.is_finite());
                number.ok_or_else(|| format!("{name:?} has to be a number, not {value}"))
            };
            let positive = || {
                number().and_then(|number| {
                    if number > 0.0 { Ok(number) } else { Err(format!("{name:?} has to be above 0")) }
                })
            };
            if let Some(rule) = LintRule::ALL.into_iter().find(|rule| rule.name() == name) {
                let limit = if value.is_null() { None } else { Some(number()?) };
                thresholds.limits = thresholds.limits.with(rule, limit);
                continue;
            }
            match name.as_str() {
                "rate" => thresholds.rate = Some(positive()?),
                "meters_per_unit" => thresholds.meters_per_unit = Some(positive()?),
                "floor_height" => thresholds.limits.floor = number()?,
                "up" => thresholds.limits.contacts.up = axis(value)?,
                _ => {
                    let names = LintRule::ALL.map(LintRule::name).join(", ");
                    return Err(format!(
                        "there is no threshold {name:?}; there are {names}, and rate, meters_per_unit, floor_height, up"
                    ));
                }
            }
        }
        Ok(thresholds)
    }
}

fn axis(value: &Value) -> Result<Axis, String> {
    match value.as_str() {
        Some("x") => Ok(Axis::X),
        Some("y") => Ok(Axis::Y),
        Some("z") => Ok(Axis::Z),
        _ => Err(format!("\"up\" has to be \"x\", \"y\" or \"z\", not {value}")),
    }
}
