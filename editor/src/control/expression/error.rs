//! Limits and errors of expressions.

/// Longest text that is evaluated, bytes. A user never types more, but a clipboard may contain anything.
pub const LONGEST: usize = 4096;
/// Deepest nesting of brackets and signs.
pub const DEEPEST: u32 = 64;

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
