//! A value is kept between computed bounds without a panic, whatever the bounds are.

use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::between;

#[test]
fn a_value_is_kept_between_two_bounds_as_by_clamp() {
    let seed = seed(0xc1a);
    let mut random = Random::new(seed);
    for _ in 0..10_000 {
        let [value, a, b] = [(); 3].map(|()| random.between(-4.0, 4.0));
        let (low, high) = (a.min(b), a.max(b));
        assert_eq!(between(value, low, high), value.clamp(low, high), "seed {seed}");
    }
    assert_eq!(between(-1_isize, 0, 0), 0);
}

#[test]
fn bounds_in_the_wrong_order_or_without_a_value_do_not_panic() {
    for value in [-5.0_f32, 0.5, 5.0] {
        assert_eq!(between(value, 1.0, 0.0), 1.0, "the lower bound wins");
        assert_eq!(between(value, 0.0, f32::NAN), value.max(0.0));
        assert_eq!(between(value, f32::NAN, 0.0), value.min(0.0));
    }
    assert!(between(f32::NAN, 0.0, 1.0).is_nan());
}
