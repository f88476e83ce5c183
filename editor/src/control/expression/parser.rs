//! Parses tokens into one number by recursive descent, at most [`DEEPEST`] levels deep.

use super::error::{DEEPEST, ExpressionError, ExpressionFault};
use super::lexer::{Lexer, Token};
use super::name::{Function, FunctionKind, MOST_ARGUMENTS, Unit, constant, function};
use super::quantity::Quantity;

type ParseResult = Result<f64, ExpressionError>;

pub(super) struct Parser<'a> {
    lexer: Lexer<'a>,
    /// The next token, and its position.
    token: Token<'a>,
    at: usize,
    depth: u32,
    /// Unit of a number without a unit, in this part of the expression.
    unit: Unit,
    /// Unit of the value that was read last, if it had one.
    given: Option<f64>,
}

impl<'a> Parser<'a> {
    pub(super) fn new(lexer: Lexer<'a>, quantity: Quantity) -> Self {
        Self { lexer, token: Token::End, at: 0, depth: 0, unit: Unit::of(quantity), given: None }
    }

    /// Returns the value of the whole text.
    pub(super) fn whole(&mut self) -> ParseResult {
        self.next()?;
        if self.token == Token::End {
            return self.fault(ExpressionFault::Empty);
        }
        let value = self.sum()?;
        if self.token == Token::End { Ok(value) } else { self.unexpected() }
    }

    fn sum(&mut self) -> ParseResult {
        let mut value = self.product()?;
        while let Token::Sign(sign @ ('+' | '-')) = self.token {
            let at = self.at;
            self.next()?;
            let other = self.product()?;
            value = finite(if sign == '+' { value + other } else { value - other }, at)?;
        }
        Ok(value)
    }

    fn product(&mut self) -> ParseResult {
        let mut value = self.sign()?;
        let mut has_unit = self.given.is_some();
        while let Token::Sign(sign @ ('*' | '/' | '%')) = self.token {
            let at = self.at;
            self.next()?;
            // `%` is a unit of factors (`150%`) only at the end of the text; elsewhere it is the remainder.
            if sign == '%' && self.token == Token::End && self.unit == Unit::Number {
                return Ok(value / 100.0);
            }
            let other = self.sign()?;
            let result = match sign {
                '*' => value * other,
                // `pi/4 rad` and `1/2 m`: the unit applies to the fraction, since no field is in a unit per meter.
                '/' => match self.given {
                    Some(one) if !has_unit => value / (other / one) * one,
                    _ => value / other,
                },
                // The remainder has the sign of the divisor, which is useful for angles.
                _ => value - other * (value / other).floor(),
            };
            value = finite(result, at)?;
            has_unit |= self.given.is_some();
        }
        Ok(value)
    }

    fn sign(&mut self) -> ParseResult {
        match self.token {
            Token::Sign(sign @ ('+' | '-')) => {
                self.deeper()?;
                self.next()?;
                let value = self.sign()?;
                self.depth -= 1;
                Ok(if sign == '-' { -value } else { value })
            }
            _ => self.power(),
        }
    }

    fn power(&mut self) -> ParseResult {
        let value = self.with_unit()?;
        if self.token != Token::Power {
            return Ok(value);
        }
        let at = self.at;
        self.deeper()?;
        self.next()?;
        let exponent = self.sign()?;
        self.depth -= 1;
        finite(libm::pow(value, exponent), at)
    }

    fn with_unit(&mut self) -> ParseResult {
        let bracket = self.token == Token::Sign('(');
        let value = self.primary()?;
        let Token::Name(name) = self.token else {
            // An expression in brackets may have a unit of its own.
            self.given = self.given.filter(|_| bracket);
            return Ok(value);
        };
        let Some(one) = self.unit.one(name) else { return self.fault(ExpressionFault::Name) };
        let at = self.at;
        self.next()?;
        self.given = Some(one);
        finite(value * one, at)
    }

    fn primary(&mut self) -> ParseResult {
        match self.token {
            Token::Number(value) => {
                self.next()?;
                Ok(value)
            }
            Token::Sign('(') => {
                self.deeper()?;
                let parts = std::mem::replace(&mut self.lexer.comma_parts, false);
                self.next()?;
                let value = self.sum()?;
                self.lexer.comma_parts = parts;
                self.close()?;
                self.depth -= 1;
                Ok(value)
            }
            Token::Name(name) => match (constant(name), function(name)) {
                (Some(value), _) => {
                    self.next()?;
                    Ok(value)
                }
                (None, Some(function)) => self.call(function),
                (None, None) => self.fault(ExpressionFault::Name),
            },
            _ => self.unexpected(),
        }
    }

    /// Parses a function and its arguments.
    fn call(&mut self, function: &Function) -> ParseResult {
        let at = self.at;
        let outer = self.unit;
        let count = function.arguments;
        self.deeper()?;
        self.next()?;
        if self.token != Token::Sign('(') {
            return self.unexpected();
        }
        let parts = std::mem::replace(&mut self.lexer.comma_parts, count > 1);
        self.unit = match function.kind {
            FunctionKind::Plain => outer,
            FunctionKind::OfAngle => Unit::Radians,
            FunctionKind::ToAngle => Unit::Number,
        };
        let mut arguments = [0.0; MOST_ARGUMENTS];
        for (index, argument) in arguments.iter_mut().enumerate().take(count) {
            if index > 0 && !matches!(self.token, Token::Sign(',' | ';')) {
                return self.fault(ExpressionFault::Parts(count));
            }
            self.next()?;
            *argument = self.sum()?;
        }
        if matches!(self.token, Token::Sign(',' | ';')) {
            return self.fault(ExpressionFault::Parts(count));
        }
        let result = (function.compute)(&arguments[..count]);
        self.lexer.comma_parts = parts;
        self.unit = outer;
        self.close()?;
        self.depth -= 1;
        finite(if function.kind == FunctionKind::ToAngle { outer.of_radians(result) } else { result }, at)
    }

    fn close(&mut self) -> Result<(), ExpressionError> {
        if self.token == Token::Sign(')') { self.next() } else { self.unexpected().map(|_| ()) }
    }

    fn deeper(&mut self) -> Result<(), ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST { self.fault(ExpressionFault::TooDeep).map(|_| ()) } else { Ok(()) }
    }

    fn next(&mut self) -> Result<(), ExpressionError> {
        (self.token, self.at) = self.lexer.next()?;
        Ok(())
    }

    fn fault(&self, reason: ExpressionFault) -> ParseResult {
        Err(ExpressionError { at: self.at, reason })
    }

    fn unexpected(&self) -> ParseResult {
        self.fault(match self.token {
            Token::End => ExpressionFault::Unfinished,
            Token::Sign(sign) => ExpressionFault::Unexpected(sign),
            Token::Power => ExpressionFault::Unexpected('^'),
            Token::Name(_) => ExpressionFault::Name,
            Token::Number(_) => ExpressionFault::Number,
        })
    }
}

fn finite(value: f64, at: usize) -> ParseResult {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ExpressionError { at, reason: ExpressionFault::NotFinite })
    }
}
