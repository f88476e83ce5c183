//! Tokens into one number, from the top down, as deep as [`DEEPEST`].

use super::lexer::{Lexer, Token};
use super::name::{Body, Kind, Unit, constant, function};
use super::{DEEPEST, ExpressionError, ExpressionFault, Quantity};

type Answer = Result<f64, ExpressionError>;

pub(super) struct Parser<'a> {
    lexer: Lexer<'a>,
    /// The next token, and where it stands.
    token: Token<'a>,
    at: usize,
    depth: u32,
    /// What a number without unit is in, here.
    unit: Unit,
    /// The unit that the value read last was given, if any.
    given: Option<f64>,
}

impl<'a> Parser<'a> {
    pub(super) fn new(lexer: Lexer<'a>, quantity: Quantity) -> Self {
        Self { lexer, token: Token::End, at: 0, depth: 0, unit: Unit::of(quantity), given: None }
    }

    /// The number that all of the text is.
    pub(super) fn whole(&mut self) -> Answer {
        self.next()?;
        if self.token == Token::End {
            return self.fault(ExpressionFault::Empty);
        }
        let value = self.sum()?;
        if self.token == Token::End { Ok(value) } else { self.unexpected() }
    }

    fn sum(&mut self) -> Answer {
        let mut value = self.product()?;
        while let Token::Sign(sign @ ('+' | '-')) = self.token {
            let at = self.at;
            self.next()?;
            let other = self.product()?;
            value = finite(if sign == '+' { value + other } else { value - other }, at)?;
        }
        Ok(value)
    }

    fn product(&mut self) -> Answer {
        let mut value = self.sign()?;
        let mut has_unit = self.given.is_some();
        while let Token::Sign(sign @ ('*' | '/' | '%')) = self.token {
            let at = self.at;
            self.next()?;
            // `150%` of a factor: only where nothing follows, since in between `%` is the remainder.
            if sign == '%' && self.token == Token::End && self.unit == Unit::Number {
                return Ok(value / 100.0);
            }
            let other = self.sign()?;
            let result = match sign {
                '*' => value * other,
                // `pi/4 rad` and `1/2 m`: the unit is that of the fraction, since no field wants one over metres.
                '/' => match self.given {
                    Some(one) if !has_unit => value / (other / one) * one,
                    _ => value / other,
                },
                // With the sign of the divisor, as angles want it.
                _ => value - other * (value / other).floor(),
            };
            value = finite(result, at)?;
            has_unit |= self.given.is_some();
        }
        Ok(value)
    }

    fn sign(&mut self) -> Answer {
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

    fn power(&mut self) -> Answer {
        let value = self.with_unit()?;
        if self.token != Token::Power {
            return Ok(value);
        }
        let at = self.at;
        self.deeper()?;
        self.next()?;
        let exponent = self.sign()?;
        self.depth -= 1;
        finite(value.powf(exponent), at)
    }

    fn with_unit(&mut self) -> Answer {
        let bracket = self.token == Token::Sign('(');
        let value = self.primary()?;
        let Token::Name(name) = self.token else {
            // What stands in brackets may have brought its own.
            self.given = self.given.filter(|_| bracket);
            return Ok(value);
        };
        let Some(one) = self.unit.one(name) else { return self.fault(ExpressionFault::Name) };
        let at = self.at;
        self.next()?;
        self.given = Some(one);
        finite(value * one, at)
    }

    fn primary(&mut self) -> Answer {
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
                (None, Some(function)) => self.call(function.kind, function.body),
                (None, None) => self.fault(ExpressionFault::Name),
            },
            _ => self.unexpected(),
        }
    }

    /// A function and what stands in its brackets.
    fn call(&mut self, kind: Kind, body: Body) -> Answer {
        let at = self.at;
        let outer = self.unit;
        let two = matches!(body, Body::Two(_));
        self.deeper()?;
        self.next()?;
        if self.token != Token::Sign('(') {
            return self.unexpected();
        }
        let parts = std::mem::replace(&mut self.lexer.comma_parts, two);
        self.unit = match kind {
            Kind::Plain => outer,
            Kind::OfAngle => Unit::Radians,
            Kind::ToAngle => Unit::Number,
        };
        self.next()?;
        let first = self.sum()?;
        let result = match body {
            Body::One(compute) => compute(first),
            Body::Two(compute) => {
                if !matches!(self.token, Token::Sign(',' | ';')) {
                    return self.fault(ExpressionFault::Parts(2));
                }
                self.next()?;
                let second = self.sum()?;
                compute(first, second)
            }
        };
        if matches!(self.token, Token::Sign(',' | ';')) {
            return self.fault(ExpressionFault::Parts(if two { 2 } else { 1 }));
        }
        self.lexer.comma_parts = parts;
        self.unit = outer;
        self.close()?;
        self.depth -= 1;
        finite(if kind == Kind::ToAngle { outer.of_radians(result) } else { result }, at)
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

    fn fault(&self, reason: ExpressionFault) -> Answer {
        Err(ExpressionError { at: self.at, reason })
    }

    fn unexpected(&self) -> Answer {
        self.fault(match self.token {
            Token::End => ExpressionFault::Unfinished,
            Token::Sign(sign) => ExpressionFault::Unexpected(sign),
            Token::Power => ExpressionFault::Unexpected('^'),
            Token::Name(_) => ExpressionFault::Name,
            Token::Number(_) => ExpressionFault::Number,
        })
    }
}

fn finite(value: f64, at: usize) -> Answer {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ExpressionError { at, reason: ExpressionFault::NotFinite })
    }
}
