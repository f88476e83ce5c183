//! The constants, functions and units of expressions.
//!
//! A new one is one line here: in [`CONSTANTS`], [`FUNCTIONS`], [`LENGTHS`] or [`ANGLES`]. Nothing else lists them, and a test
//! below checks every line.

use super::quantity::Quantity;
use std::f64::consts::{E, PI, TAU};

/// Units of the arguments and the result of a function.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum FunctionKind {
    /// From numbers to a number, both in the unit around the function.
    Plain,
    /// From an angle, in radians unless a unit is typed, to a number.
    OfAngle,
    /// From a number to an angle in the unit around the function.
    ToAngle,
}

/// A function that can be typed.
pub(super) struct Function {
    pub(super) name: &'static str,
    pub(super) kind: FunctionKind,
    /// Number of arguments, 1 to [`MOST_ARGUMENTS`].
    pub(super) arguments: usize,
    /// Computes the result of exactly that many arguments.
    pub(super) compute: fn(&[f64]) -> f64,
}

/// Largest number of arguments of a function.
pub(super) const MOST_ARGUMENTS: usize = 3;

macro_rules! function {
    ($name:literal, $kind:ident, $function:expr, 1) => {
        Function { name: $name, kind: FunctionKind::$kind, arguments: 1, compute: |x| $function(x[0]) }
    };
    ($name:literal, $kind:ident, $function:expr, 2) => {
        Function { name: $name, kind: FunctionKind::$kind, arguments: 2, compute: |x| $function(x[0], x[1]) }
    };
}

const CONSTANTS: &[(&str, f64)] = &[("pi", PI), ("π", PI), ("tau", TAU), ("τ", TAU), ("e", E)];

const FUNCTIONS: &[Function] = &[
    function!("sqrt", Plain, f64::sqrt, 1),
    function!("√", Plain, f64::sqrt, 1),
    function!("abs", Plain, f64::abs, 1),
    function!("floor", Plain, f64::floor, 1),
    function!("ceil", Plain, f64::ceil, 1),
    function!("round", Plain, f64::round, 1),
    function!("exp", Plain, libm::exp, 1),
    function!("ln", Plain, libm::log, 1),
    function!("log", Plain, libm::log10, 1),
    function!("sin", OfAngle, libm::sin, 1),
    function!("cos", OfAngle, libm::cos, 1),
    function!("tan", OfAngle, libm::tan, 1),
    function!("asin", ToAngle, libm::asin, 1),
    function!("acos", ToAngle, libm::acos, 1),
    function!("atan", ToAngle, libm::atan, 1),
    function!("atan2", ToAngle, libm::atan2, 2),
    function!("min", Plain, f64::min, 2),
    function!("max", Plain, f64::max, 2),
    function!("pow", Plain, libm::pow, 2),
    // Never panics, unlike `f64::clamp`.
    Function {
        name: "clamp",
        kind: FunctionKind::Plain,
        arguments: 3,
        compute: |x| x[0].max(x[1]).min(x[2]),
    },
];

/// Units of length: name, meters.
const LENGTHS: &[(&str, f64)] =
    &[("mm", 0.001), ("cm", 0.01), ("dm", 0.1), ("m", 1.0), ("km", 1000.0), ("in", 0.0254), ("ft", 0.3048)];

/// Units of angles: name, and how many of them are a full turn. As degrees per turn are exact, degrees in a field of
/// degrees are multiplied by exactly 1.
const ANGLES: &[(&str, f64)] = &[("deg", 360.0), ("°", 360.0), ("rad", TAU), ("turn", 1.0)];

/// Unit of numbers in a part of an expression.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    Number,
    Meters,
    Degrees,
    Radians,
}

impl Unit {
    pub(super) fn of(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Number => Self::Number,
            Quantity::Length => Self::Meters,
            Quantity::Angle => Self::Degrees,
        }
    }

    /// Returns the factor from the unit `name` to this unit; `None` if there is no such unit for the quantity.
    pub(super) fn one(self, name: &str) -> Option<f64> {
        let find = |list: &[(&str, f64)]| list.iter().find(|entry| entry.0 == name).map(|entry| entry.1);
        match self {
            Self::Number => None,
            Self::Meters => find(LENGTHS),
            Self::Degrees => find(ANGLES).map(|turn| 360.0 / turn),
            Self::Radians => find(ANGLES).map(|turn| TAU / turn),
        }
    }

    /// Converts an angle from radians to this unit.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::expression::evaluate;

    #[test]
    fn every_function_takes_exactly_its_arguments() {
        for function in FUNCTIONS {
            assert!((1..=MOST_ARGUMENTS).contains(&function.arguments), "{}", function.name);
            let call = |count: usize| {
                let arguments = vec!["0.5"; count].join("; ");
                evaluate(&format!("{}({arguments})", function.name), Quantity::Number)
            };
            assert!(call(function.arguments).is_ok(), "{}", function.name);
            assert!(call(function.arguments + 1).is_err(), "{}", function.name);
        }
    }

    #[test]
    fn every_constant_and_unit_is_understood() {
        for (name, value) in CONSTANTS {
            assert_eq!(evaluate(name, Quantity::Number), Ok(*value), "{name}");
        }
        for (quantity, units) in [(Quantity::Length, LENGTHS), (Quantity::Angle, ANGLES)] {
            for (name, _) in units {
                assert!(evaluate(&format!("2 {name}"), quantity).is_ok(), "{name}");
            }
        }
    }
}
