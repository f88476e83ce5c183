//! The constants, functions and units there are: one line each.

use super::Quantity;
use std::f64::consts::{E, PI, TAU};

/// What angles inside and results outside of a function are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Numbers in, number out, in the unit around it.
    Plain,
    /// Radians in, unless a unit is written; number out.
    OfAngle,
    /// Number in; an angle out, in the unit around it.
    ToAngle,
}

/// What a function computes.
#[derive(Clone, Copy)]
pub(super) enum Body {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
}

/// A function that can be typed.
pub(super) struct Function {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) body: Body,
}

const fn one(name: &'static str, kind: Kind, body: fn(f64) -> f64) -> Function {
    Function { name, kind, body: Body::One(body) }
}

const fn two(name: &'static str, kind: Kind, body: fn(f64, f64) -> f64) -> Function {
    Function { name, kind, body: Body::Two(body) }
}

const CONSTANTS: &[(&str, f64)] = &[("pi", PI), ("π", PI), ("tau", TAU), ("τ", TAU), ("e", E)];

const FUNCTIONS: &[Function] = &[
    one("sqrt", Kind::Plain, f64::sqrt),
    one("√", Kind::Plain, f64::sqrt),
    one("abs", Kind::Plain, f64::abs),
    one("floor", Kind::Plain, f64::floor),
    one("ceil", Kind::Plain, f64::ceil),
    one("round", Kind::Plain, f64::round),
    one("exp", Kind::Plain, f64::exp),
    one("ln", Kind::Plain, f64::ln),
    one("log", Kind::Plain, f64::log10),
    one("sin", Kind::OfAngle, f64::sin),
    one("cos", Kind::OfAngle, f64::cos),
    one("tan", Kind::OfAngle, f64::tan),
    one("asin", Kind::ToAngle, f64::asin),
    one("acos", Kind::ToAngle, f64::acos),
    one("atan", Kind::ToAngle, f64::atan),
    two("atan2", Kind::ToAngle, f64::atan2),
    two("min", Kind::Plain, f64::min),
    two("max", Kind::Plain, f64::max),
    two("pow", Kind::Plain, f64::powf),
];

/// Name, metres.
const LENGTHS: &[(&str, f64)] =
    &[("mm", 0.001), ("cm", 0.01), ("dm", 0.1), ("m", 1.0), ("km", 1000.0), ("in", 0.0254), ("ft", 0.3048)];

/// Name, how many make a turn. So degrees in degrees are multiplied by exactly 1.
const ANGLES: &[(&str, f64)] = &[("deg", 360.0), ("°", 360.0), ("rad", TAU), ("turn", 1.0)];

/// What numbers are in, in some part of an expression.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    Number,
    Metres,
    Degrees,
    Radians,
}

impl Unit {
    pub(super) fn of(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Number => Self::Number,
            Quantity::Length => Self::Metres,
            Quantity::Angle => Self::Degrees,
        }
    }

    /// What one `name` is in this unit.
    pub(super) fn one(self, name: &str) -> Option<f64> {
        let find = |list: &[(&str, f64)]| list.iter().find(|entry| entry.0 == name).map(|entry| entry.1);
        match self {
            Self::Number => None,
            Self::Metres => find(LENGTHS),
            Self::Degrees => find(ANGLES).map(|turn| 360.0 / turn),
            Self::Radians => find(ANGLES).map(|turn| TAU / turn),
        }
    }

    /// An angle in radians as this unit writes it.
    pub(super) fn of_radians(self, angle: f64) -> f64 {
        if self == Self::Degrees { angle.to_degrees() } else { angle }
    }
}

pub(super) fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|constant| constant.0.eq_ignore_ascii_case(name)).map(|constant| constant.1)
}

pub(super) fn function(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name.eq_ignore_ascii_case(name))
}
