//! Tokens of the binary encoding.

use super::lexer::XToken;

/// A list of numbers that is being read.
#[derive(Clone, Copy, Default)]
pub(super) struct NumberList {
    left: u32,
    is_float: bool,
}

/// Reads tokens of the binary encoding.
#[derive(Clone, Copy)]
pub(super) struct BinaryTokens<'a> {
    bytes: &'a [u8],
    pub(super) at: usize,
    list: NumberList,
    is_wide: bool,
}

/// Why there is no token: the offset, and a text.
pub(super) type BinaryFault = (usize, &'static str);

const CUT: &str = "the file ends inside of a token";

impl<'a> BinaryTokens<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize, is_wide: bool) -> Self {
        Self { bytes, at, list: NumberList::default(), is_wide }
    }

    /// Returns the next token; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<XToken<'a>>, BinaryFault> {
        while self.list.left == 0 {
            if self.at >= self.bytes.len() {
                return Ok(None);
            }
            let start = self.at;
            let kind = u16::from_le_bytes(self.array()?);
            return Ok(Some(match kind {
                1 => XToken::Word(self.counted()?),
                2 => XToken::Text(self.counted()?),
                3 => XToken::Number(f64::from(u32::from_le_bytes(self.array()?))),
                5 => {
                    self.array::<16>()?;
                    XToken::Other
                }
                6 | 7 => {
                    self.list = NumberList { left: u32::from_le_bytes(self.array()?), is_float: kind == 7 };
                    continue;
                }
                10 => XToken::Open,
                11 => XToken::Close,
                // Separators.
                19 | 20 => continue,
                // Other brackets, and the types of members in templates.
                12..=18 | 40..=52 => XToken::Other,
                31 => XToken::Word(b"template"),
                _ => return Err((start, "a token of an unknown kind")),
            }));
        }
        self.list.left -= 1;
        let number = match (self.list.is_float, self.is_wide) {
            (false, _) => f64::from(u32::from_le_bytes(self.array()?)),
            (true, false) => f64::from(f32::from_le_bytes(self.array()?)),
            (true, true) => f64::from_le_bytes(self.array()?),
        };
        Ok(Some(XToken::Number(number)))
    }

    /// Returns the next `N` bytes.
    fn array<const N: usize>(&mut self) -> Result<[u8; N], BinaryFault> {
        let found = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let array = *found.ok_or((self.at, CUT))?;
        self.at += N;
        Ok(array)
    }

    /// Returns bytes after their number.
    fn counted(&mut self) -> Result<&'a [u8], BinaryFault> {
        let at = self.at;
        let count = u32::from_le_bytes(self.array()?) as usize;
        let text = self.bytes.get(self.at..self.at.saturating_add(count)).ok_or((at, CUT))?;
        self.at += count;
        Ok(text)
    }
}
