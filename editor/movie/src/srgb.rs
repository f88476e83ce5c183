//! The transfer function of sRGB, both ways, with the same results on every processor.

/// Linear light of each encoded byte, and the limits between them.
#[derive(Clone, Debug)]
pub(crate) struct SrgbTable {
    linear: [f32; 256],
    /// Largest linear value, exclusive, that is rounded to each byte.
    limits: [f32; 255],
}

impl SrgbTable {
    /// Computes the table.
    pub(crate) fn new() -> Self {
        let linear = std::array::from_fn(|byte| linear(byte as f64) as f32);
        Self { linear, limits: std::array::from_fn(linear_limit) }
    }

    /// Returns the linear light of a byte, from 0 to 1.
    pub(crate) fn decode(&self, byte: u8) -> f32 {
        self.linear[usize::from(byte)]
    }

    /// Returns the byte nearest to linear light: 0 for what is below 0 or no number, 255 above 1.
    pub(crate) fn encode(&self, linear: f32) -> u8 {
        if linear.is_nan() {
            return 0;
        }
        self.limits.partition_point(|limit| *limit <= linear) as u8
    }
}

fn linear_limit(byte: usize) -> f32 {
    linear(byte as f64 + 0.5) as f32
}

/// Returns the linear light of an encoded value from 0 to 255.
fn linear(value: f64) -> f64 {
    let value = value / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_is_encoded_as_it_was_decoded() {
        let table = SrgbTable::new();
        for byte in 0..=255 {
            assert_eq!(table.encode(table.decode(byte)), byte);
        }
        assert_eq!([f32::NAN, -1.0, 2.0, f32::INFINITY].map(|value| table.encode(value)), [0, 0, 255, 255]);
    }
}
