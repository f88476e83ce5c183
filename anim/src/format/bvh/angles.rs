//! From a rotation to the numbers of the rotation channels of a joint, near the numbers that are there.

use super::channel::{BvhChannel, CHANNELS, ChannelList};
use crate::joint::EulerOrder;
use crate::trig::rotation_about;
use glam::{DQuat, DVec3};

/// Cosine of the second angle below which the first and the third turn about the same line, and only their sum counts.
const LOCKED: f64 = 1e-6;

/// Largest number of rounds of the search for channels that are no three different axes.
const ROUNDS: usize = 200;

/// Returns numbers for the rotation channels, in degrees, such that their product is `rotation`, or nearest to it where the
/// channels cannot express it. Of all such numbers those nearest to `near` are returned. Both lists have one number per
/// channel; those of position channels are `near`.
pub(super) fn angles(channels: &ChannelList, rotation: DQuat, near: &[f64]) -> [f64; CHANNELS] {
    let mut numbers = [0.0; CHANNELS];
    numbers[..near.len()].copy_from_slice(near);
    let (mut slots, mut axes, mut count) = ([0; CHANNELS], [0; CHANNELS], 0);
    for (slot, channel) in channels.iter().enumerate() {
        if let BvhChannel::Rotation(axis) = channel {
            (slots[count], axes[count]) = (slot, axis);
            count += 1;
        }
    }
    let (slots, axes) = (&slots[..count], &axes[..count]);
    let mut angles = [0.0; CHANNELS];
    for (angle, &slot) in angles.iter_mut().zip(slots) {
        *angle = numbers[slot].to_radians();
    }
    let old = angles;
    let order = EulerOrder::ALL.into_iter().find(|order| order.axes() == *axes);
    match order {
        Some(order) => angles[..3].copy_from_slice(&three(order, rotation, [old[0], old[1], old[2]])),
        None => search(axes, rotation, &mut angles[..count]),
    }
    for ((&slot, &angle), &old) in slots.iter().zip(&angles).zip(&old) {
        numbers[slot] = nearest(angle.to_degrees(), old.to_degrees());
    }
    numbers
}

/// Returns the angles of three different axes: of the two possibilities the one nearer to `old`, in radians.
fn three(order: EulerOrder, rotation: DQuat, old: [f64; 3]) -> [f64; 3] {
    let [first, second, third] = order.angles(rotation);
    if libm::cos(second).abs() < LOCKED {
        let mut angles = [first, second, old[2]];
        angles[0] = best(&order.axes(), rotation, &angles, 0);
        return angles;
    }
    let other = [first + std::f64::consts::PI, std::f64::consts::PI - second, third + std::f64::consts::PI];
    let distance = |angles: &[f64; 3]| -> f64 {
        let off =
            |(&angle, &old): (&f64, &f64)| nearest(angle.to_degrees(), old.to_degrees()) - old.to_degrees();
        angles.iter().zip(&old).map(off).map(|off| off * off).sum()
    };
    let one = [first, second, third];
    if distance(&other) < distance(&one) { other } else { one }
}

/// Changes one angle after the other until the product is nearest to `rotation`.
fn search(axes: &[usize], rotation: DQuat, angles: &mut [f64]) {
    for _ in 0..ROUNDS {
        let mut largest = 0.0_f64;
        for slot in 0..axes.len() {
            let angle = best(axes, rotation, angles, slot);
            largest = largest.max(
                (nearest(angle.to_degrees(), angles[slot].to_degrees()) - angles[slot].to_degrees()).abs(),
            );
            angles[slot] = angle;
        }
        if largest < 1e-9 {
            break;
        }
    }
}

/// Returns the angle of one turn with which the product of all is nearest to `rotation`, the others as they are.
fn best(axes: &[usize], rotation: DQuat, angles: &[f64], slot: usize) -> f64 {
    let product = |range: std::ops::Range<usize>| {
        range.fold(DQuat::IDENTITY, |product, slot| {
            product * rotation_about(DVec3::AXES[axes[slot]], angles[slot])
        })
    };
    let rest = product(0..slot).conjugate() * rotation * product(slot + 1..axes.len()).conjugate();
    2.0 * libm::atan2(rest.to_array()[axes[slot]], rest.w)
}

/// Returns `degrees` plus the number of whole turns with which it is nearest to `near`.
fn nearest(degrees: f64, near: f64) -> f64 {
    degrees + ((near - degrees) / 360.0).round() * 360.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels(axes: &[usize]) -> ChannelList {
        let mut channels = ChannelList::default();
        channels.push(BvhChannel::Position(1));
        for &axis in axes {
            channels.push(BvhChannel::Rotation(axis));
        }
        channels
    }

    fn error(a: DQuat, b: DQuat) -> f64 {
        2.0 * libm::acos(a.dot(b).abs().min(1.0))
    }

    #[test]
    fn the_numbers_that_made_a_rotation_are_found_again_from_numbers_near_them() {
        let orders: [&[usize]; 10] = [
            &[0, 1, 2],
            &[0, 2, 1],
            &[1, 0, 2],
            &[1, 2, 0],
            &[2, 0, 1],
            &[2, 1, 0],
            &[2, 0],
            &[1],
            &[],
            &[2, 0, 2],
        ];
        for axes in orders {
            let channels = channels(axes);
            for step in 0..200 {
                let step = f64::from(step);
                let numbers = [7.0, step * 37.0 - 3000.0, step * 11.3 - 900.0, step * 5.1 - 20.0];
                let numbers = &numbers[..channels.len()];
                let near: Vec<f64> = numbers.iter().map(|number| number + libm::sin(step) * 8.0).collect();
                let rotation = channels.rotation(numbers);
                let found = angles(&channels, rotation, &near);
                assert_eq!(found[0], near[0], "a position");
                let off = error(channels.rotation(&found[..numbers.len()]), rotation);
                // The search is slow where the first and the third of two axes are nearly the same line.
                let is_slow = axes == [2, 0, 2] && libm::sin(numbers[2].to_radians()).abs() < 0.3;
                assert!(off < if is_slow { 0.2 } else { 1e-6 }, "{axes:?} {numbers:?} {off}");
                if axes.len() == 3 && axes[0] != axes[2] {
                    // Not where two solutions are equally near.
                    let locked = libm::cos(numbers[2].to_radians()).abs() < 0.3;
                    let off = found.iter().zip(numbers).skip(1).all(|(a, b)| (a - b).abs() < 1e-6);
                    assert!(off || locked, "{axes:?} {numbers:?} {found:?}");
                }
            }
        }
    }

    #[test]
    fn where_two_axes_are_the_same_line_the_third_number_stays() {
        for order in EulerOrder::ALL {
            let channels = channels(&order.axes());
            for second in [90.0, -90.0, 270.0] {
                let numbers = [0.0, 30.0, second, 50.0];
                let rotation = channels.rotation(&numbers);
                let found = angles(&channels, rotation, &[0.0, 10.0, second + 1.0, 20.0]);
                assert!(error(channels.rotation(&found[..4]), rotation) < 1e-6, "{order:?} {found:?}");
                assert_eq!(found[3], 20.0_f64.to_radians().to_degrees(), "{order:?}");
            }
        }
    }

    #[test]
    fn channels_that_cannot_express_a_rotation_come_as_near_as_they_can() {
        let channels = channels(&[1]);
        let rotation = rotation_about(DVec3::new(0.6, 0.8, 0.0), 1.0);
        let best_error = error(channels.rotation(&angles(&channels, rotation, &[0.0, 0.0])[..2]), rotation);
        for degrees in 0..360 {
            assert!(best_error <= error(channels.rotation(&[0.0, f64::from(degrees)]), rotation) + 1e-12);
        }
    }
}
