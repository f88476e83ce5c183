//! The nearest point of an ellipse.

use glam::DVec2;

/// Number of bisections: more than f64 has bits.
const STEPS: usize = 80;

/// Returns `point` where it is inside the ellipse with half-axes `halves` along x and y (0 or more), else the nearest
/// point of its border.
///
/// A point outside is mirrored to the quarter where both coordinates are positive. It is on the border's normal in the
/// nearest point `n`:
///
/// ```text
/// n.x = a² p.x / (t + a²)    n.y = b² p.y / (t + b²)    with the one t ≥ 0 for which  (n.x / a)² + (n.y / b)² = 1
/// ```
///
/// The left side falls from above 1 at t = 0 to 0, so bisection finds t. A half-axis of 0 makes the ellipse a line.
pub(super) fn nearest_in_ellipse(point: DVec2, halves: DVec2) -> DVec2 {
    let DVec2 { x: a, y: b } = halves;
    if a == 0.0 || b == 0.0 {
        return point.clamp(-halves, halves);
    }
    if (point / halves).length_squared() <= 1.0 {
        return point;
    }
    let squares = halves * halves;
    let corner = point.abs();
    let below = |t: f64| squares * corner / (DVec2::splat(t) + squares);
    // At this t each of the two parts is at most ½.
    let (mut low, mut high) = (0.0, std::f64::consts::SQRT_2 * (halves * corner).max_element());
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        let outside = (below(middle) / halves).length_squared() > 1.0;
        *(if outside { &mut low } else { &mut high }) = middle;
    }
    below(high).copysign(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::Random;

    #[test]
    fn the_nearest_point_is_on_the_border_and_no_other_is_nearer() {
        let mut random = Random::new(5);
        for round in 0..300 {
            let halves = DVec2::new(random.between(0.01, 3.0).into(), random.between(0.01, 3.0).into());
            let point = DVec2::new(random.between(-4.0, 4.0).into(), random.between(-4.0, 4.0).into());
            let point = if round % 10 == 0 { DVec2::new(point.x, 0.0) } else { point };
            let nearest = nearest_in_ellipse(point, halves);
            if (point / halves).length_squared() <= 1.0 {
                assert_eq!(nearest, point);
                continue;
            }
            assert!(((nearest / halves).length_squared() - 1.0).abs() < 1e-9, "{point} {halves}: {nearest}");
            for step in 0..2_000 {
                let other = halves * DVec2::from_angle(step as f64 * std::f64::consts::TAU / 2_000.0);
                assert!(point.distance(nearest) <= point.distance(other) + 1e-9, "{point} {halves}");
            }
        }
    }

    #[test]
    fn an_ellipse_with_one_half_axis_of_zero_is_a_line_and_with_two_a_point() {
        let point = DVec2::new(-2.0, 0.5);
        assert_eq!(nearest_in_ellipse(point, DVec2::new(1.0, 0.0)), DVec2::new(-1.0, 0.0));
        assert_eq!(nearest_in_ellipse(point, DVec2::new(0.0, 3.0)), DVec2::new(0.0, 0.5));
        assert_eq!(nearest_in_ellipse(point, DVec2::ZERO), DVec2::ZERO);
    }
}
