//! Rotations as numbers: three angles in a chosen order, or a quaternion.

use dragonfly_anim::joint::EulerOrder;
use glam::DQuat;

/// Returns the usual name: `XYZ`.
pub fn name(order: EulerOrder) -> &'static str {
    match order {
        EulerOrder::Xyz => "XYZ",
        EulerOrder::Xzy => "XZY",
        EulerOrder::Yxz => "YXZ",
        EulerOrder::Yzx => "YZX",
        EulerOrder::Zxy => "ZXY",
        EulerOrder::Zyx => "ZYX",
    }
}

/// Returns the order with that name.
pub fn order(text: &str) -> Option<EulerOrder> {
    EulerOrder::ALL.into_iter().find(|order| name(*order) == text)
}

/// Returns the rotation of three angles in degrees: those about x, y, z, whatever the order.
pub fn rotation(order: EulerOrder, degrees: [f64; 3]) -> DQuat {
    order.rotation(order.axes().map(|axis| (degrees[axis] % 360.0).to_radians()))
}

/// Returns three angles in degrees, those about x, y, z: between −180 and 180, the second one of the order between −90
/// and 90. If that one is 90 or −90, the last one of the order is 0.
pub fn degrees(order: EulerOrder, rotation: DQuat) -> [f64; 3] {
    let mut out = [0.0; 3];
    for (axis, angle) in order.axes().into_iter().zip(order.angles(rotation)) {
        out[axis] = angle.to_degrees();
    }
    out
}

/// Returns three angles in degrees, those about x, y, z: of all that describe the rotation, those nearest to `near`.
pub fn nearest(order: EulerOrder, rotation: DQuat, near: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = order.angles(rotation);
    // The other set of angles for the same rotation, whose middle angle is beyond a right angle.
    let half = std::f64::consts::PI;
    let best = [[a, b, c], [a + half, half - b, c + half]].map(|angles| {
        let mut numbers = [0.0; 3];
        for (angle, axis) in angles.into_iter().zip(order.axes()) {
            let degrees = angle.to_degrees();
            numbers[axis] = degrees + ((near[axis] - degrees) / 360.0).round() * 360.0;
        }
        let distance: f64 = (0..3).map(|axis| (numbers[axis] - near[axis]).abs()).sum();
        (distance, numbers)
    });
    if best[1].0 < best[0].0 - 1e-6 { best[1].1 } else { best[0].1 }
}

/// Serializes the order by its name.
pub mod by_name {
    use super::EulerOrder;
    use serde::{Deserialize, Deserializer, Serializer};

    /// Writes the name.
    pub fn serialize<S: Serializer>(order: &EulerOrder, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(super::name(*order))
    }

    /// Reads a name; the default order if it is unknown.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<EulerOrder, D::Error> {
        Ok(super::order(&String::deserialize(from)?).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::Random;

    fn angle_between(a: DQuat, b: DQuat) -> f64 {
        2.0 * (a - b).length().min((a + b).length())
    }

    #[test]
    fn the_angles_of_any_rotation_give_it_back() {
        let seed = dragonfly_kit::random::seed(0x7u64);
        println!("seed {seed}");
        let mut random = Random::new(seed);
        for round in 0..20_000 {
            let mut angle = || f64::from(random.unit()) * 360.0 - 180.0;
            let mut turn = [angle(), angle(), angle()];
            for order in EulerOrder::ALL {
                // Every fourth is at a gimbal lock, or next to one.
                if round % 4 == 0 {
                    let near = [0.0, 1e-9, 1e-5, 1e-3][round / 4 % 4];
                    turn[order.axes()[1]] = if round % 8 == 0 { 90.0 - near } else { -90.0 + near };
                }
                let wanted = rotation(order, turn);
                // Rounded to single precision, as in a model.
                let kept = wanted.as_quat().as_dquat().normalize();
                let read = degrees(order, kept);
                let back = rotation(order, read);
                assert!(angle_between(kept, back) < 4e-6, "{order:?} {turn:?} {read:?}");
                assert!(read[order.axes()[1]].abs() <= 90.0 + 1e-9);
                assert!(read.iter().all(|angle| angle.abs() <= 180.0 + 1e-9));
            }
        }
    }

    #[test]
    fn angles_without_gimbal_lock_are_the_same_after_conversion() {
        for order in EulerOrder::ALL {
            for turn in [[30.0, 0.0, 0.0], [0.0, -45.0, 0.0], [10.0, 20.0, -30.0], [0.0, 0.0, 89.0]] {
                let read = degrees(order, rotation(order, turn).as_quat().as_dquat());
                let near = (0..3).all(|axis| (read[axis] - turn[axis]).abs() < 2e-5);
                assert!(near, "{order:?} {turn:?} {read:?}");
            }
        }
    }

    #[test]
    fn every_order_is_parsed_from_its_name() {
        for order in EulerOrder::ALL {
            assert_eq!(super::order(name(order)), Some(order));
        }
        assert_eq!(super::order("xyz"), None);
    }
}
