//! What can be typed where a number is wanted: `45/2`, `sqrt(2)`, `10cm`, `90deg`, `1e-3`, `1,5`.
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
//! A comma is a decimal separator too, where it can mean nothing else: not between the parts of a function of several, and
//! not in `1,234`, which one person reads as a thousand and another as one. `pi/4 rad` is a quarter of pi radians. A number without unit is in the unit of the
//! field: metres (scene units), degrees. Every text has an answer: a finite number, or an error with its place.

mod lexer;
mod name;
mod parser;

use lexer::Lexer;
use parser::Parser;

/// Longest text that is looked at, bytes: nobody types more into a field, and what a clipboard holds may be anything.
pub const LONGEST: usize = 4096;
/// Deepest nesting of brackets and signs.
pub const DEEPEST: u32 = 64;

/// What a number measures, which says what its units are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// A plain number or factor: the only unit is `%`, and that only at the end of the text.
    #[default]
    Number,
    /// Metres, which are scene units: `mm`, `cm`, `dm`, `m`, `km`, `in`, `ft`.
    Length,
    /// Degrees: `deg`, `°`, `rad`, `turn`.
    Angle,
}

/// Why a text is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("at character {}: {reason}", at + 1)]
pub struct ExpressionError {
    /// Place in the text, in characters from 0.
    pub at: usize,
    /// What is wrong there.
    pub reason: ExpressionFault,
}

/// What can be wrong with an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExpressionFault {
    /// Nothing but spaces.
    #[error("a number is missing")]
    Empty,
    /// More than [`LONGEST`] bytes.
    #[error("the text is too long for a number")]
    TooLong,
    /// More than [`DEEPEST`] brackets or signs inside each other.
    #[error("brackets are nested too deeply")]
    TooDeep,
    /// A letter or sign that has no meaning.
    #[error("`{0}` has no meaning here")]
    Unexpected(char),
    /// The text ends where something must follow.
    #[error("the expression is incomplete")]
    Unfinished,
    /// Digits that make no number, such as `1.2.3`.
    #[error("this is not a number")]
    Number,
    /// Such as `1,234`: a decimal comma or thousands?
    #[error("a comma before three digits is ambiguous; write a point, or leave the comma out")]
    Comma,
    /// No constant, function or unit has this name.
    #[error("unknown constant, function or unit")]
    Name,
    /// A function with too few or too many parts.
    #[error("this function takes {0} argument(s)")]
    Parts(usize),
    /// The result, or something on the way to it, is infinite or undefined.
    #[error("the result is not a finite number")]
    NotFinite,
}

/// The number that `text` says, in the unit of `quantity`. Always finite.
pub fn evaluate(text: &str, quantity: Quantity) -> Result<f64, ExpressionError> {
    if text.len() > LONGEST {
        return Err(ExpressionError { at: 0, reason: ExpressionFault::TooLong });
    }
    let mut parser = Parser::new(Lexer::new(text), quantity);
    parser.whole()
}

/// [`evaluate`] as the `f32` that fields hold; refused where it does not fit.
pub fn evaluate_f32(text: &str, quantity: Quantity) -> Result<f32, ExpressionError> {
    let value = evaluate(text, quantity)? as f32;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ExpressionError { at: 0, reason: ExpressionFault::NotFinite })
    }
}
