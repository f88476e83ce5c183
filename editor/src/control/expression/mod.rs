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

mod error;
mod lexer;
mod name;
mod parser;
mod quantity;

pub use error::{DEEPEST, ExpressionError, ExpressionFault, LONGEST};
pub use quantity::Quantity;

use lexer::Lexer;
use parser::Parser;

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
