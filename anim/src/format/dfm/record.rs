//! Converts numbers to bytes and back, little-endian, and elements made of them.

use glam::{Mat4, Quat, Vec2, Vec3, Vec4};

/// Represents "no index".
pub(super) const NONE: u32 = u32::MAX;

/// Returns `index`, or [`NONE`].
pub(super) fn or_none(index: Option<u32>) -> u32 {
    index.unwrap_or(NONE)
}

/// Reverses [`or_none`].
pub(super) fn some(index: u32) -> Option<u32> {
    (index != NONE).then_some(index)
}

/// One element of a part, of a fixed size.
pub(super) trait DfmRecord: Sized {
    /// Size in bytes.
    const SIZE: usize;
    /// Appends the element to `out`.
    fn put(&self, out: &mut Vec<u8>);
    /// Reads the element; the error describes the number that is not allowed.
    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String>;
}

/// The bytes of one element, read from the front.
pub(super) struct RecordFields<'a> {
    bytes: &'a [u8],
    /// Whether every float so far was finite.
    pub(super) finite: bool,
}

impl<'a> RecordFields<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, finite: true }
    }

    /// Returns the next bytes; zeros after the end, which cannot happen with the size of the record.
    pub(super) fn take<const N: usize>(&mut self) -> [u8; N] {
        debug_assert!(self.bytes.len() >= N, "a record is smaller than its fields");
        let mut taken = [0; N];
        let (now, rest) = self.bytes.split_at(N.min(self.bytes.len()));
        taken[..now.len()].copy_from_slice(now);
        self.bytes = rest;
        taken
    }

    pub(super) fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    pub(super) fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    pub(super) fn f32(&mut self) -> f32 {
        let number = f32::from_le_bytes(self.take());
        self.finite &= number.is_finite();
        number
    }

    pub(super) fn floats<const N: usize>(&mut self) -> [f32; N] {
        [(); N].map(|()| self.f32())
    }

    pub(super) fn vec2(&mut self) -> Vec2 {
        Vec2::from_array(self.floats())
    }

    pub(super) fn vec3(&mut self) -> Vec3 {
        Vec3::from_array(self.floats())
    }

    pub(super) fn vec4(&mut self) -> Vec4 {
        Vec4::from_array(self.floats())
    }

    pub(super) fn quat(&mut self) -> Quat {
        Quat::from_array(self.floats())
    }

    pub(super) fn mat4(&mut self) -> Mat4 {
        Mat4::from_cols_array(&self.floats())
    }
}

/// Appends numbers.
pub(super) trait Put {
    fn u32(&mut self, number: u32);
    fn floats(&mut self, numbers: &[f32]);
}

impl Put for Vec<u8> {
    fn u32(&mut self, number: u32) {
        self.extend_from_slice(&number.to_le_bytes());
    }

    fn floats(&mut self, numbers: &[f32]) {
        for number in numbers {
            self.extend_from_slice(&number.to_le_bytes());
        }
    }
}

/// Implements records of one field.
macro_rules! plain {
    ($($type:ty, $size:literal, $put:expr, $get:ident;)*) => {$(
        impl DfmRecord for $type {
            const SIZE: usize = $size;

            fn put(&self, out: &mut Vec<u8>) {
                let put: fn(&Self, &mut Vec<u8>) = $put;
                put(self, out);
            }

            fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
                Ok(fields.$get())
            }
        }
    )*};
}

plain! {
    u32, 4, |number, out| out.u32(*number), u32;
    f32, 4, |number, out| out.floats(&[*number]), f32;
    Vec3, 12, |vector, out| out.floats(&vector.to_array()), vec3;
    Vec4, 16, |vector, out| out.floats(&vector.to_array()), vec4;
}

impl DfmRecord for u8 {
    const SIZE: usize = 1;

    fn put(&self, out: &mut Vec<u8>) {
        out.push(*self);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        Ok(fields.take::<1>()[0])
    }
}

/// Returns the value that `number` represents in a list of choices.
pub(super) fn choice<T: Copy>(choices: &[T], number: u8, what: &str) -> Result<T, String> {
    choices
        .get(usize::from(number))
        .copied()
        .ok_or_else(|| format!("{what} {number} is not below {}", choices.len()))
}

/// Returns the number that represents `value` in a list of choices.
pub(super) fn number_of<T: PartialEq>(choices: &[T], value: &T) -> u8 {
    choices.iter().position(|choice| choice == value).unwrap_or(0) as u8
}

/// Refuses unknown bits.
pub(super) fn only_bits(flags: u32, known: u32) -> Result<u32, String> {
    if flags & !known == 0 { Ok(flags) } else { Err(format!("flags {flags:#x} have unknown bits")) }
}
