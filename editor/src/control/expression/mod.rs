//! Expressions that can be typed into number fields: `45/2`, `sqrt(2)`, `10cm`, `90deg`, `1e-3`, `1,5`.
//!
//! ```text
//! sum     = product (("+" | "-") product)*
//! product = sign (("*" | "/" | "%") sign)*           % is the remainder, with the sign of the divisor
//! sign    = ("+" | "-") sign | power
//! power   = unit (("^" | "**") sign)?                 binds to the right: 2^3^2 = 2^9, -2^2 = -4
//! unit    = primary name?                             a unit that fits the quantity: cm, deg …
//! primary = number | name | name "(" sum (("," | ";") sum)* ")" | "(" sum ")"
//! ```
//!
//! A comma is a decimal separator too, where it is unambiguous: not between the arguments of a function, and not in `1,234`,
//! which some read as a thousand and others as one. `pi/4 rad` is a quarter of pi radians. A number without a unit is in the
//! unit of the field: meters (scene units), degrees. Every text has a result: a finite number, or an error with its position.

mod lexer;
mod name;
mod parser;

use lexer::Lexer;
use parser::Parser;

/// Longest text that is evaluated, bytes. A user never types more, but a clipboard may contain anything.
pub const LONGEST: usize = 4096;
/// Deepest nesting of brackets and signs.
pub const DEEPEST: u32 = 64;

/// Quantity of a number, which decides its units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// A plain number or factor: the only unit is `%`, at the end of the text.
    #[default]
    Number,
    /// Meters, which are scene units: `mm`, `cm`, `dm`, `m`, `km`, `in`, `ft`.
    Length,
    /// Degrees: `deg`, `°`, `rad`, `turn`.
    Angle,
}

/// Why a text is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("at character {}: {reason}", at + 1)]
pub struct ExpressionError {
    /// Position in the text, in characters from 0.
    pub at: usize,
    /// The error at that position.
    pub reason: ExpressionFault,
}

/// An error in an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionFault {
    /// The text is empty.
    #[error("a number is missing")]
    Empty,
    /// More than [`LONGEST`] bytes.
    #[error("the text is too long for a number")]
    TooLong,
    /// More than [`DEEPEST`] nested brackets or signs.
    #[error("brackets are nested too deeply")]
    TooDeep,
    /// A letter or sign without a meaning.
    #[error("`{0}` has no meaning here")]
    Unexpected(char),
    /// The text ends too early.
    #[error("the expression is incomplete")]
    Unfinished,
    /// Digits that are not a number, such as `1.2.3`.
    #[error("this is not a number")]
    Number,
    /// A comma that is either decimal or for thousands, as in `1,234`.
    #[error("a comma before three digits is ambiguous; write a point, or leave the comma out")]
    Comma,
    /// No constant, function or unit has this name.
    #[error("unknown constant, function or unit")]
    Name,
    /// A function with the wrong number of arguments.
    #[error("this function takes {0} argument(s)")]
    Parts(usize),
    /// The result, or an intermediate result, is infinite or undefined.
    #[error("the result is not a finite number")]
    NotFinite,
}

/// Returns the value of `text`, in the unit of `quantity`. Always finite.
pub fn evaluate(text: &str, quantity: Quantity) -> Result<f64, ExpressionError> {
    if text.len() > LONGEST {
        return Err(ExpressionError { at: 0, reason: ExpressionFault::TooLong });
    }
    let mut parser = Parser::new(Lexer::new(text), quantity);
    parser.whole()
}

/// Returns [`evaluate`] as the `f32` that fields contain; an error if it does not fit.
pub fn evaluate_f32(text: &str, quantity: Quantity) -> Result<f32, ExpressionError> {
    let value = evaluate(text, quantity)? as f32;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ExpressionError { at: 0, reason: ExpressionFault::NotFinite })
    }
}
