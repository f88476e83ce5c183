//! Filters: what is done to each element after decoding.
//!
//! The extension allows results that differ by one in the last place; these are rounded to the nearest, half away from
//! zero, in single precision, so that every system computes the same.

/// Filter of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MeshoptFilter {
    /// The elements stay.
    None,
    /// Unit vectors, from two numbers to three.
    Octahedral,
    /// Rotations, from three numbers to four.
    Quaternion,
    /// Floats, from a mantissa and an exponent.
    Exponential,
    /// Colors, from luma and chrominance to red, green and blue.
    Color,
}

impl MeshoptFilter {
    /// Returns the filter of this name.
    pub(super) fn named(name: &str) -> Option<Self> {
        match name {
            "NONE" => Some(Self::None),
            "OCTAHEDRAL" => Some(Self::Octahedral),
            "QUATERNION" => Some(Self::Quaternion),
            "EXPONENTIAL" => Some(Self::Exponential),
            "COLOR" => Some(Self::Color),
            _ => None,
        }
    }

    /// Returns whether elements of `stride` bytes, a multiple of 4, can be filtered.
    pub(super) fn allows(self, stride: usize) -> bool {
        match self {
            Self::None | Self::Exponential => true,
            Self::Octahedral | Self::Color => [4, 8].contains(&stride),
            Self::Quaternion => stride == 8,
        }
    }

    /// Filters elements of `stride` bytes in place.
    pub(super) fn apply(self, stride: usize, bytes: &mut [u8]) {
        match self {
            Self::None => {}
            Self::Octahedral if stride == 4 => bytes4(bytes, |element| {
                let [x, y, one, rest] = element.map(|byte| byte as i8);
                let [x, y, z] = octahedral([x, y, one].map(f32::from), 127.0);
                [x as i8, y as i8, z as i8, rest].map(|number| number as u8)
            }),
            Self::Octahedral => words4(bytes, |[x, y, one, rest]| {
                let [x, y, z] = octahedral([x, y, one].map(f32::from), 32_767.0);
                [x as i16, y as i16, z as i16, rest]
            }),
            Self::Quaternion => words4(bytes, quaternion),
            Self::Exponential => {
                let (numbers, _) = bytes.as_chunks_mut::<4>();
                numbers.iter_mut().for_each(|number| *number = exponential(*number));
            }
            Self::Color if stride == 4 => bytes4(bytes, |[luma, co, cg, alpha]| {
                let signed = |byte: u8| i32::from(byte as i8);
                color([luma.into(), signed(co), signed(cg), alpha.into()], 255.0).map(|number| number as u8)
            }),
            Self::Color => words4(bytes, |[luma, co, cg, alpha]| {
                let unsigned = |word: i16| i32::from(word as u16);
                let numbers = [unsigned(luma), co.into(), cg.into(), unsigned(alpha)];
                color(numbers, 65_535.0).map(|number| number as u16 as i16)
            }),
        }
    }
}

/// Replaces all elements of four bytes.
fn bytes4(bytes: &mut [u8], filter: impl Fn([u8; 4]) -> [u8; 4]) {
    let (elements, _) = bytes.as_chunks_mut::<4>();
    elements.iter_mut().for_each(|element| *element = filter(*element));
}

/// Replaces all elements of four 16-bit numbers.
fn words4(bytes: &mut [u8], filter: impl Fn([i16; 4]) -> [i16; 4]) {
    let (elements, _) = bytes.as_chunks_mut::<8>();
    for element in elements {
        let [a, b, c, d, e, f, g, h] = *element;
        let words = [[a, b], [c, d], [e, f], [g, h]].map(i16::from_le_bytes);
        let [[a, b], [c, d], [e, f], [g, h]] = filter(words).map(i16::to_le_bytes);
        *element = [a, b, c, d, e, f, g, h];
    }
}

/// Returns the unit vector, times `largest`, of a point on an octahedron: its x and y, and the number that means 1.
fn octahedral([x, y, one]: [f32; 3], largest: f32) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|number| (number / length * largest).round())
}

/// Returns the rotation whose three smaller components are given, times the square root of two, with the place of the
/// largest one in the two lowest bits of the last number.
fn quaternion([x, y, z, one]: [i16; 4]) -> [i16; 4] {
    let range = std::f32::consts::FRAC_1_SQRT_2;
    let scale = f32::from(one | 3);
    let [x, y, z] = [x, y, z].map(|number| f32::from(number) / scale * range);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut rotation = [w, x, y, z].map(|number| (number * 32_767.0).round() as i16);
    rotation.rotate_right((one & 3) as usize);
    rotation
}

/// Returns the float of a mantissa, the lower three bytes, and an exponent to the base 2.
fn exponential(bytes: [u8; 4]) -> [u8; 4] {
    let number = i32::from_le_bytes(bytes);
    let (exponent, mantissa) = (number >> 24, number << 8 >> 8);
    // Exact: 2 to the exponent is a double, and so is its product with 24 bits.
    let power = f64::from_bits(((exponent + 1023) as u64) << 52);
    ((f64::from(mantissa) * power) as f32).to_le_bytes()
}

/// Returns red, green, blue and alpha, each 0..`largest`, of luma, orange, green and alpha. The position of
/// the highest bit of alpha is the number of bits of all numbers.
fn color([luma, orange, green, alpha]: [i32; 4], largest: f32) -> [f32; 4] {
    let bits = 32 - alpha.leading_zeros();
    let all = (1 << bits) - 1;
    let opacity = alpha & (all >> 1);
    let opacity = opacity << 1 | opacity & 1;
    let rgb = [luma + orange - green, luma + green, luma - orange - green, opacity];
    let scale = largest / all as f32;
    rgb.map(|number| (number as f32 * scale).round())
}
