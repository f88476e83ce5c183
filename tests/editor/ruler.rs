//! Conversion between times and positions on the timeline.

use dragonfly::panels::ruler::{Ruler, frame_of, step_frame, step_key, thin, time_of};

fn ruler() -> Ruler {
    Ruler { left: 100.0, width: 800.0, start: 2.0, length: 4.0 }
}

#[test]
fn a_position_on_the_ruler_gives_its_time() {
    let ruler = ruler();
    assert_eq!(ruler.time_at(100.0), 2.0);
    assert_eq!(ruler.time_at(500.0), 4.0);
    assert_eq!(ruler.time_at(900.0), 6.0);
    for time in [2.0, 2.5, 3.21, 6.0] {
        assert!((ruler.time_at(ruler.x_of(time)) - time).abs() < 1e-4);
    }
}

#[test]
fn positions_outside_the_ruler_give_its_nearest_end() {
    assert_eq!(ruler().time_at(-1e9), 2.0);
    assert_eq!(ruler().time_at(1e9), 6.0);
    assert_eq!(Ruler { length: 0.0, ..ruler() }.time_at(500.0), 2.0);
    assert_eq!(Ruler { width: 0.0, ..ruler() }.time_at(500.0), 2.0);
}

#[test]
fn ticks_are_legible_at_any_length() {
    for length in [0.01, 0.3, 1.0, 7.7, 60.0, 3600.0, 1e6] {
        for rate in [24, 25, 30, 60] {
            let ruler = Ruler { left: 0.0, width: 1000.0, start: 0.0, length };
            let ticks = ruler.ticks(rate);
            assert!(!ticks.is_empty() && ticks.len() <= 2001, "{length} s: {} ticks", ticks.len());
            let majors: Vec<f32> =
                ticks.iter().filter(|tick| tick.major).map(|tick| ruler.x_of(tick.time)).collect();
            assert!(!majors.is_empty(), "{length} s at {rate} has no label");
            for pair in majors.windows(2) {
                assert!(pair[1] - pair[0] > 50.0, "{length} s at {rate}: labels overlap");
            }
        }
    }
}

#[test]
fn a_take_of_length_zero_has_one_tick() {
    assert_eq!(Ruler { length: 0.0, ..ruler() }.ticks(30).len(), 1);
}

#[test]
fn converting_a_frame_to_a_time_and_back_gives_the_same_frame() {
    for frame in [-3, 0, 1, 17, 100_000] {
        for rate in [24, 25, 30, 60] {
            assert_eq!(frame_of(time_of(frame, rate), rate), frame);
        }
    }
}

#[test]
fn a_frame_step_goes_to_the_adjacent_frame() {
    assert_eq!(step_frame(time_of(5, 30), 1, 30), time_of(6, 30));
    assert_eq!(step_frame(time_of(5, 30), -1, 30), time_of(4, 30));
    // Between frames 5 and 6.
    assert_eq!(step_frame(5.4 / 30.0, 1, 30), time_of(6, 30));
    assert_eq!(step_frame(5.4 / 30.0, -1, 30), time_of(5, 30));
}

#[test]
fn a_key_step_goes_to_the_next_key_and_not_to_the_one_at_the_playhead() {
    let keys = [0.0, 0.5, 1.0];
    assert_eq!(step_key(&keys, 0.5, true), Some(1.0));
    assert_eq!(step_key(&keys, 0.5, false), Some(0.0));
    assert_eq!(step_key(&keys, 0.7, true), Some(1.0));
    assert_eq!(step_key(&keys, 0.7, false), Some(0.5));
    assert_eq!(step_key(&keys, 1.0, true), None);
    assert_eq!(step_key(&[], 0.0, true), None);
}

#[test]
fn a_hundred_thousand_keys_draw_at_most_one_mark_per_pixel() {
    let keys: Vec<f32> = (0..100_000).map(|key| 2.0 + key as f32 * 4.0 / 100_000.0).collect();
    let marks = thin(&keys, &ruler(), 1.0);
    assert!(marks.len() <= 801, "{}", marks.len());
    assert_eq!(thin(&[2.0, 4.0, 6.0], &ruler(), 1.0), [2.0, 4.0, 6.0]);
}
