//! Single tokens: where they end, decoding of strings, formatting of strings and numbers.

use std::borrow::Cow;

/// Returns the end of the string whose opening quote is at `from`: the byte after its closing quote.
///
/// `None` if it has no end, contains an unescaped control character, or an invalid escape.
pub(super) fn string_end(text: &[u8], from: usize) -> Option<usize> {
    let mut at = from + 1;
    loop {
        match *text.get(at)? {
            b'"' => return Some(at + 1),
            b'\\' => at += escape_length(&text[at..])?,
            0..0x20 => return None,
            _ => at += 1,
        }
    }
}

/// Returns the length of the escape at the start of `text`.
fn escape_length(text: &[u8]) -> Option<usize> {
    match text.get(1)? {
        b'"' | b'\\' | b'/' | b'b' | b'f' | b'n' | b'r' | b't' => Some(2),
        b'u' => text.get(2..6)?.iter().all(u8::is_ascii_hexdigit).then_some(6),
        _ => None,
    }
}

/// Returns the end of the number at `from` (RFC 8259 §6); `None` if it is not a number.
pub(super) fn number_end(text: &[u8], from: usize) -> Option<usize> {
    let digits =
        |at: usize| text.get(at..).map_or(0, |rest| rest.iter().take_while(|b| b.is_ascii_digit()).count());
    let mut at = from + usize::from(text.get(from) == Some(&b'-'));
    let whole = digits(at);
    if whole == 0 || (whole > 1 && text[at] == b'0') {
        return None;
    }
    at += whole;
    if text.get(at) == Some(&b'.') {
        let fraction = digits(at + 1);
        at += 1 + fraction;
        if fraction == 0 {
            return None;
        }
    }
    if matches!(text.get(at), Some(b'e' | b'E')) {
        at += 1 + usize::from(matches!(text.get(at + 1), Some(b'+' | b'-')));
        let exponent = digits(at);
        at += exponent;
        if exponent == 0 {
            return None;
        }
    }
    Some(at)
}

/// Decodes a string token with its quotes. Half of a surrogate pair becomes U+FFFD.
pub(in super::super) fn unquoted(token: &[u8]) -> Cow<'_, str> {
    let inner = token.get(1..token.len().saturating_sub(1)).unwrap_or_default();
    if !inner.contains(&b'\\') {
        return String::from_utf8_lossy(inner);
    }
    let mut decoded = Vec::with_capacity(inner.len());
    let mut at = 0;
    while at < inner.len() {
        let (unit, length) = unit(&inner[at..]);
        match unit {
            StringUnit::Byte(byte) => decoded.push(byte),
            StringUnit::Character(character) => decoded.extend(character.encode_utf8(&mut [0; 4]).as_bytes()),
        }
        at += length;
    }
    Cow::Owned(String::from_utf8_lossy(&decoded).into_owned())
}

/// One character or escape of a string.
enum StringUnit {
    Byte(u8),
    Character(char),
}

/// Returns the first unit of `inner`, which is not empty, and the number of bytes that spell it.
fn unit(inner: &[u8]) -> (StringUnit, usize) {
    if inner[0] != b'\\' {
        return (StringUnit::Byte(inner[0]), 1);
    }
    let plain = match inner.get(1) {
        Some(b'b') => 8,
        Some(b'f') => 12,
        Some(b'n') => b'\n',
        Some(b'r') => b'\r',
        Some(b't') => b'\t',
        Some(b'u') => return escaped_unit(inner),
        Some(&byte) => byte,
        None => return (StringUnit::Byte(b'\\'), 1),
    };
    (StringUnit::Byte(plain), 2)
}

fn escaped_unit(inner: &[u8]) -> (StringUnit, usize) {
    let code = |at: usize| {
        let digits = std::str::from_utf8(inner.get(at + 2..at + 6)?).ok()?;
        (inner.get(at..at + 2)? == b"\\u").then(|| u16::from_str_radix(digits, 16).ok())?
    };
    let Some(first) = code(0) else { return (StringUnit::Character('\u{fffd}'), inner.len().min(2)) };
    if let Some(second) = code(6)
        && let Some(Ok(character)) = char::decode_utf16([first, second]).next()
        && character as u32 > 0xffff
    {
        return (StringUnit::Character(character), 12);
    }
    (StringUnit::Character(char::from_u32(first.into()).unwrap_or('\u{fffd}')), 6)
}

/// Returns where in a string token the byte number `byte` of the decoded string is spelled, counted in the result of
/// [`unquoted`].
///
/// The position of the closing quote if the decoded string is shorter.
pub(in super::super) fn written_at(token: &[u8], byte: usize) -> usize {
    let end = token.len().saturating_sub(1);
    let (mut at, mut count) = (1, 0);
    if !token.contains(&b'\\') {
        return (1 + byte).min(end);
    }
    while at < end && count < byte {
        let (unit, length) = unit(&token[at..end]);
        count += match unit {
            StringUnit::Byte(_) => 1,
            StringUnit::Character(character) => character.len_utf8(),
        };
        at += length;
    }
    at.min(end)
}

/// Returns `text` as a string token.
pub(in super::super) fn quoted(text: &str) -> String {
    let mut token = String::with_capacity(text.len() + 2);
    token.push('"');
    for character in text.chars() {
        match character {
            '"' => token.push_str("\\\""),
            '\\' => token.push_str("\\\\"),
            '\n' => token.push_str("\\n"),
            '\r' => token.push_str("\\r"),
            '\t' => token.push_str("\\t"),
            '\0'..='\u{1f}' => token.push_str(&format!("\\u{:04x}", character as u32)),
            _ => token.push(character),
        }
    }
    token.push('"');
    token
}

/// Formats a finite number so that it is the same in single and in double precision.
pub(in super::super) fn number(value: f32) -> String {
    debug_assert!(value.is_finite());
    format!("{}", f64::from(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_of_a_string_are_decoded() {
        assert_eq!(unquoted(br#""\u0061n\/\"\\ \ud83d\ude00 \ud83d x""#), "an/\"\\ \u{1f600} \u{fffd} x");
        assert_eq!(unquoted(b"\"plain\""), "plain");
        assert_eq!(unquoted(b"\""), "");
    }

    #[test]
    fn a_quoted_text_decodes_to_the_same_text() {
        for text in ["", "a\"b\\c", "line\nend\r\t\u{1}", "\u{1f600} é", "\u{7f}"] {
            let token = quoted(text);
            assert_eq!(string_end(token.as_bytes(), 0), Some(token.len()), "{token}");
            assert_eq!(unquoted(token.as_bytes()), text);
        }
    }

    #[test]
    fn a_decoded_byte_is_found_at_its_position_in_the_token() {
        let token = br#""a\/b\u00e9c""#;
        assert_eq!(token[written_at(token, 0)], b'a');
        assert_eq!(written_at(token, 1), 2);
        assert_eq!(token[written_at(token, 2)], b'b');
        assert_eq!(token[written_at(token, 5)], b'c');
        assert_eq!(token[written_at(token, 99)], b'"');
    }

    #[test]
    fn numbers_end_according_to_the_grammar_of_json() {
        for number in ["0", "-0", "10", "1.5", "1e0", "-1.25E+7", "1e-9"] {
            assert_eq!(number_end(format!("{number},").as_bytes(), 0), Some(number.len()), "{number}");
        }
        for broken in ["01", "1.", "-", ".5", "1e", "+1", "", "1e+"] {
            assert_eq!(number_end(broken.as_bytes(), 0), None, "{broken}");
        }
    }

    #[test]
    fn a_formatted_number_is_the_same_in_both_precisions() {
        for value in [0.1_f32, 1e-40, f32::MAX, f32::MIN_POSITIVE, 16_777_217.0, -0.0, 1.0 / 3.0] {
            let written = number(value);
            assert_eq!(number_end(written.as_bytes(), 0), Some(written.len()), "{written}");
            assert_eq!(written.parse::<f64>().unwrap(), f64::from(value), "{written}");
            assert_eq!(written.parse::<f32>().unwrap().to_bits(), value.to_bits(), "{written}");
        }
    }
}
