//! Lines in the form that nearly all have: positions, texture coordinates, normals and polygons, read from the bytes
//! without a list of tokens. All others, such as those with a comment or an exponent, are left to the general reader.

use super::faces::{Corner, FaceParser, NONE};
use crate::format::ImportError;
use crate::format::decimal::{eight_digits, short_decimal, single};
use crate::limits::VERTICES;
use glam::{Vec2, Vec3};

impl FaceParser<'_> {
    /// Reads the next line that is not empty, from `at` on, if it has the usual form. Returns its end; `None`, and nothing
    /// is read, if it has another one.
    pub(super) fn read_quickly(&mut self, bytes: &[u8], at: usize) -> Result<Option<usize>, ImportError> {
        let mut line = LineCursor { bytes, at };
        while line.byte().is_some_and(|byte| byte <= b' ') {
            line.at += 1;
        }
        let start = line.at;
        let (keyword, length) = match bytes.get(start..).unwrap_or_default() {
            [b'v', b' ' | b'\t', ..] => (b'v', 1),
            [b'v', kind @ (b't' | b'n'), b' ' | b'\t', ..] => (*kind, 2),
            [b'f', b' ' | b'\t', ..] => (b'f', 1),
            _ => return Ok(None),
        };
        line.at += length;
        if keyword == b'f' {
            return self.polygon_quickly(line, start);
        }
        self.context().work(4)?;
        let Some((numbers, count)) = line.floats() else { return Ok(None) };
        match (keyword, count) {
            (b'v', 3) => self.add_position(Vec3::from(numbers), start)?,
            (b'n', 3) => self.add_normal(Vec3::from(numbers), start)?,
            (b't', 1..=3) => self.add_texture_coordinate(Vec2::new(numbers[0], numbers[1]), start)?,
            _ => return Ok(None),
        }
        Ok(Some(line.at))
    }

    fn polygon_quickly(&mut self, mut line: LineCursor<'_>, at: usize) -> Result<Option<usize>, ImportError> {
        let first = self.begin_polygon(at)?;
        loop {
            line.skip_blanks();
            if line.is_end() {
                break;
            }
            let Some(corner) = line.corner() else {
                self.text.corners.truncate(first);
                return Ok(None);
            };
            self.add_corner(corner, at)?;
        }
        self.context().work(1 + self.text.corners.len() - first)?;
        self.end_polygon(first, at);
        Ok(Some(line.at))
    }
}

/// A position within a line.
struct LineCursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl LineCursor<'_> {
    fn byte(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn skip_blanks(&mut self) {
        while matches!(self.byte(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    /// Returns whether the line ends here.
    fn is_end(&self) -> bool {
        matches!(self.byte(), None | Some(b'\n' | b'\r'))
    }

    /// Returns whether a value ends here.
    fn is_after_value(&self) -> bool {
        matches!(self.byte(), None | Some(b'\n' | b'\r' | b' ' | b'\t'))
    }

    /// Returns the numbers up to the end of the line, and how many there are; `None` for more than three, and where one
    /// has another form.
    #[inline]
    fn floats(&mut self) -> Option<([f32; 3], usize)> {
        let (mut numbers, mut count) = ([0.0; 3], 0);
        loop {
            self.skip_blanks();
            if self.is_end() {
                return Some((numbers, count));
            }
            let text = self.bytes.get(self.at..)?;
            let (number, length) = short_decimal(text)?;
            self.at += length;
            if !self.is_after_value() {
                return None;
            }
            *numbers.get_mut(count)? = single(number, &text[..length]);
            count += 1;
        }
    }

    /// Returns a corner: `1`, `1/2`, `1//3` or `1/2/3`; `None` for another form.
    #[inline]
    fn corner(&mut self) -> Option<Corner> {
        let mut corner = [NONE; 3];
        for (slot, index) in corner.iter_mut().enumerate() {
            if slot != 1 || self.byte() != Some(b'/') {
                // A ninth digit would be no end of a value.
                let (number, length) = eight_digits(self.bytes, self.at);
                if number == 0 || number > VERTICES as u64 {
                    return None;
                }
                *index = number as u32 - 1;
                self.at += length;
            }
            if slot == 2 || self.byte() != Some(b'/') {
                break;
            }
            self.at += 1;
        }
        self.is_after_value().then_some(corner)
    }
}
