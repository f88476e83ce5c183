//! Rounding of values outside segments: constants, and rotations stored whole.

use super::stored::RoundingGrid;
use glam::Quat;

/// Bits of a component of a rotation stored whole: as exact as single precision is after a few products.
pub(super) const WHOLE_BITS: u32 = 20;
/// Marks floats instead of rounded numbers.
pub(super) const FLOATS: u32 = 32;
/// Largest number of bits of rounded numbers.
pub(super) const MOST_BITS: u32 = 24;
/// Upper bound of every component but the largest.
const LARGEST: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// Splits a unit quaternion into the index of its largest component and the other three in order, each a number of
/// `bits` bits (2..=24).
pub(super) fn rotation_numbers(rotation: Quat, bits: u32) -> (u32, [u32; 3]) {
    let components = rotation.to_array();
    let dropped = (1..4).fold(
        0,
        |best: usize, at| {
            if components[at].abs() > components[best].abs() { at } else { best }
        },
    );
    let sign = if components[dropped] < 0.0 { -1.0 } else { 1.0 };
    let middle = ((1_u32 << (bits - 1)) - 1) as f32;
    let mut others = (0..4).filter(|&at| at != dropped).map(|at| components[at] * sign);
    let numbers = std::array::from_fn(|_| {
        let number = (others.next().unwrap_or(0.0) / LARGEST * middle).round();
        (number.clamp(-middle, middle) + middle) as u32
    });
    (dropped as u32, numbers)
}

/// Returns the rotation that [`rotation_numbers`] split; any numbers give some unit quaternion.
pub(super) fn rotation_from(dropped: u32, numbers: [u32; 3], bits: u32) -> Quat {
    let middle = ((1_u32 << (bits - 1)) - 1) as f32;
    let others = numbers.map(|number| ((number as f32 - middle) / middle).clamp(-1.0, 1.0) * LARGEST);
    let squares: f32 = others.iter().map(|other| other * other).sum();
    let mut components = [(1.0 - squares).max(0.0).sqrt(); 4];
    let mut others = others.into_iter();
    for (at, component) in components.iter_mut().enumerate() {
        if at != dropped as usize % 4 {
            *component = others.next().unwrap_or(0.0);
        }
    }
    Quat::from_array(components).normalize()
}

impl RoundingGrid {
    /// Returns a rotation as it will be decoded.
    pub(super) fn rotation(&self, rotation: Quat) -> Quat {
        if self.rotation_bits == FLOATS {
            return rotation;
        }
        let (dropped, numbers) = rotation_numbers(rotation, self.rotation_bits);
        rotation_from(dropped, numbers, self.rotation_bits)
    }

    /// Returns the number of steps from zero; the translation is `step * number`.
    pub(super) fn number(&self, value: f32) -> i32 {
        let most = (1_i32 << (self.translation_bits.clamp(2, MOST_BITS) - 1)) - 1;
        (value / self.step).round().clamp(-most as f32, most as f32) as i32
    }

    /// Returns a component of a translation as it will be decoded.
    pub(super) fn component(&self, value: f32) -> f32 {
        if self.translation_bits == FLOATS { value } else { self.number(value) as f32 * self.step }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn a_rotation_comes_back_within_its_step_and_the_identity_exactly() {
        let mut random = Random::new(seed(5));
        for bits in [2, 8, 12, 16, WHOLE_BITS, MOST_BITS] {
            let back = |rotation: Quat| {
                let (dropped, numbers) = rotation_numbers(rotation, bits);
                rotation_from(dropped, numbers, bits)
            };
            assert_eq!(back(Quat::IDENTITY), Quat::IDENTITY);
            for _ in 0..1000 {
                let mut number = || random.between(-1.0, 1.0);
                let rotation = Quat::from_xyzw(number(), number(), number(), number()).normalize();
                let got = back(rotation);
                let off = (got - rotation).length().min((got + rotation).length());
                assert!(off < 2.5 / ((1 << bits) - 2) as f32 + 3e-7, "{bits} {rotation} {got}");
            }
        }
    }
}
