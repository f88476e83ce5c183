//! Splits a text into numbers, names and signs. Looks one character ahead and does not allocate.

use super::error::{ExpressionError, ExpressionFault};

/// A token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Sign(char),
    /// `**`, which is `^`.
    Power,
    End,
}

/// Splits a text into tokens; each call of [`Self::next`] returns one.
pub(super) struct Lexer<'a> {
    text: &'a str,
    /// Numbers of bytes and characters that were read.
    byte: usize,
    character: usize,
    /// Whether a comma separates the arguments of a function here, so that it is not a decimal separator.
    pub(super) comma_parts: bool,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, byte: 0, character: 0, comma_parts: false }
    }

    /// Returns the next token and its position, in characters.
    pub(super) fn next(&mut self) -> Result<(Token<'a>, usize), ExpressionError> {
        while let Some(letter) = self.peek().filter(|letter| letter.is_whitespace()) {
            self.advance(letter);
        }
        let at = self.character;
        let Some(letter) = self.peek() else { return Ok((Token::End, at)) };
        let decimal = letter == '.' || (letter == ',' && !self.comma_parts);
        if letter.is_ascii_digit()
            || (decimal && self.after(letter).is_some_and(|next| next.is_ascii_digit()))
        {
            return Ok((Token::Number(self.number(at)?), at));
        }
        if letter.is_alphabetic() {
            let start = self.byte;
            while let Some(letter) = self.peek().filter(|letter| letter.is_alphanumeric()) {
                self.advance(letter);
            }
            return Ok((Token::Name(&self.text[start..self.byte]), at));
        }
        self.advance(letter);
        let token = match letter {
            '−' | '–' => Token::Sign('-'),
            '×' | '·' | '⋅' => Token::Sign('*'),
            '÷' | ':' => Token::Sign('/'),
            '*' if self.peek() == Some('*') => {
                self.advance('*');
                Token::Power
            }
            '^' => Token::Power,
            '°' => Token::Name("°"),
            '√' => Token::Name("√"),
            letter => Token::Sign(letter),
        };
        Ok((token, at))
    }

    /// Reads digits, a separator, digits, an exponent.
    fn number(&mut self, at: usize) -> Result<f64, ExpressionError> {
        let fault = |at, reason| Err(ExpressionError { at, reason });
        let start = self.byte;
        let whole = self.digits();
        let mut separator = None;
        if let Some(sign) = self.peek().filter(|&sign| sign == '.' || (sign == ',' && !self.comma_parts)) {
            separator = Some((sign, self.byte - start));
            let place = self.character;
            self.advance(sign);
            let fraction = self.digits();
            let grouped = (1..=3).contains(&whole) && !self.text[start..].starts_with('0') && fraction == 3;
            if sign == ',' && grouped {
                return fault(place, ExpressionFault::Comma);
            }
            let again = |next: char| next == '.' || (next == ',' && !self.comma_parts);
            if self.peek().is_some_and(again) {
                return fault(self.character, ExpressionFault::Number);
            }
        }
        // `2e` without digits is not an exponent: the parser handles `2exp(1)`.
        let rest = &self.text.as_bytes()[self.byte..];
        let signed = usize::from(matches!(rest.get(1), Some(b'+' | b'-')));
        if matches!(rest.first(), Some(b'e' | b'E')) && rest.get(1 + signed).is_some_and(u8::is_ascii_digit) {
            self.byte += 1 + signed;
            self.character += 1 + signed;
            self.digits();
        }
        let digits = &self.text[start..self.byte];
        let value = match separator {
            Some((',', comma)) => {
                let mut with_point = digits.to_owned();
                with_point.replace_range(comma..=comma, ".");
                with_point.parse::<f64>()
            }
            _ => digits.parse::<f64>(),
        };
        match value {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => fault(at, ExpressionFault::NotFinite),
            Err(_) => fault(at, ExpressionFault::Number),
        }
    }

    /// Reads digits. Returns their number.
    fn digits(&mut self) -> usize {
        let rest = &self.text.as_bytes()[self.byte..];
        let count = rest.iter().take_while(|letter| letter.is_ascii_digit()).count();
        self.byte += count;
        self.character += count;
        count
    }

    fn peek(&self) -> Option<char> {
        self.text[self.byte..].chars().next()
    }

    fn after(&self, letter: char) -> Option<char> {
        self.text[self.byte + letter.len_utf8()..].chars().next()
    }

    fn advance(&mut self, letter: char) {
        self.byte += letter.len_utf8();
        self.character += 1;
    }
}
