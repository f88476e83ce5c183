//! Cycles repeat the keys of a channel before and after them.

use dragonfly_anim::cycle::{CycleMode, CycleRange, Cycles, cycled, value_and_slope};
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::sample_channel;
use glam::Vec3;

const ALL: [Interpolation; 3] = [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline];

/// Returns three keys from 1 s to 3 s, at 0, 4 and `last` along x.
fn keys(interpolation: Interpolation, last: f32) -> Channel<Vec3> {
    let values = [0.0, 4.0, last].map(|x| Vec3::X * x);
    let values: Vec<Vec3> = match interpolation {
        Interpolation::CubicSpline => values
            .iter()
            .enumerate()
            .flat_map(|(key, &at)| [Vec3::X * 0.5, at, Vec3::X * (1.0 + key as f32)])
            .collect(),
        Interpolation::Step | Interpolation::Linear | Interpolation::Closest => values.to_vec(),
    };
    Channel::new([1.0, 1.5, 3.0], values, interpolation)
}

fn cycles(mode: CycleMode, before: CycleRange, after: CycleRange) -> Cycles {
    Cycles { mode, before, after, most_keys: 10_000, same_time: 1e-4 }
}

fn repeated(channel: &Channel<Vec3>, cycles: &Cycles) -> Channel<Vec3> {
    cycled(channel, [0, 2], cycles, |channel, time| value_and_slope(channel, Vec3::ZERO, time)).unwrap()
}

fn at(channel: &Channel<Vec3>, time: f32) -> f32 {
    sample_channel(channel, Vec3::ZERO, time).x
}

#[test]
fn each_cycle_has_the_values_of_its_mode() {
    for (interpolation, mode) in ALL.into_iter().flat_map(|interpolation| {
        [CycleMode::Repeat, CycleMode::Offset, CycleMode::Mirror].map(|mode| (interpolation, mode))
    }) {
        // A repeated curve ends as it starts; the others need not.
        let last = if mode == CycleMode::Repeat { 0.0 } else { 2.5 };
        let before = keys(interpolation, last);
        let after = repeated(&before, &cycles(mode, CycleRange::Count(2), CycleRange::Count(3)));
        assert_eq!(after.len(), 2 * 6 + 1, "{mode:?}");
        assert_eq!(after.range(), Some((-3.0, 9.0)));
        for cycle in -2..=3_i32 {
            for part in [0.1_f32, 0.3, 0.55, 1.2, 1.9] {
                let time = 1.0 + part;
                let (wanted, there) = match mode {
                    CycleMode::Repeat => (at(&before, time), time),
                    CycleMode::Offset => (at(&before, time) + 2.5 * cycle as f32, time),
                    CycleMode::Mirror if cycle % 2 != 0 => (at(&before, time), 4.0 - time),
                    CycleMode::Mirror => (at(&before, time), time),
                };
                let now = at(&after, there + 2.0 * cycle as f32);
                assert!(
                    (now - wanted).abs() < 1e-4,
                    "{interpolation:?} {mode:?} {cycle} {part}: {now} {wanted}"
                );
            }
        }
    }
}

#[test]
fn cycles_end_at_a_limit_with_the_curve_as_it_is_there() {
    for interpolation in [Interpolation::Linear, Interpolation::CubicSpline] {
        let before = keys(interpolation, 2.5);
        let whole = repeated(&before, &cycles(CycleMode::Mirror, CycleRange::Count(2), CycleRange::Count(2)));
        let until = cycles(CycleMode::Mirror, CycleRange::Until(-1.3), CycleRange::Until(5.2));
        let part = repeated(&before, &until);
        assert_eq!(part.range(), Some((-1.3, 5.2)));
        for step in 0..=65 {
            let time = -1.3 + 0.1 * step as f32;
            assert!((at(&part, time) - at(&whole, time)).abs() < 1e-3, "{interpolation:?} at {time}");
        }
    }
}

#[test]
fn keys_where_cycles_are_are_replaced_and_those_beyond_stay() {
    let times = [0.0, 1.0, 1.5, 2.0, 2.4, 5.0];
    let values: Vec<Vec3> = [9.0, 0.0, 1.0, 0.0, 7.0, 8.0].map(|x| Vec3::X * x).to_vec();
    let channel = Channel::new(times, values, Interpolation::Linear);
    let after = cycles(CycleMode::Repeat, CycleRange::Count(0), CycleRange::Count(1));
    let next =
        cycled(&channel, [1, 3], &after, |channel, time| value_and_slope(channel, Vec3::ZERO, time)).unwrap();
    assert_eq!(*next.times, [0.0, 1.0, 1.5, 2.0, 2.5, 3.0, 5.0]);
    let values: Vec<f32> = next.values.iter().map(|value| value.x).collect();
    assert_eq!(values, [9.0, 0.0, 1.0, 0.0, 1.0, 0.0, 8.0]);
}

#[test]
fn no_more_keys_are_made_than_allowed_and_nothing_to_repeat_is_none() {
    let channel = keys(Interpolation::Linear, 0.0);
    let mut many = cycles(CycleMode::Repeat, CycleRange::Count(0), CycleRange::Count(u32::MAX));
    many.most_keys = 100;
    assert!(repeated(&channel, &many).len() <= 100);
    let sample = |channel: &Channel<Vec3>, time| value_and_slope(channel, Vec3::ZERO, time);
    let none = cycles(CycleMode::Repeat, CycleRange::Count(0), CycleRange::Until(2.0));
    assert!(cycled(&channel, [0, 2], &none, sample).is_none());
    assert!(cycled(&channel, [1, 1], &many, sample).is_none());
    assert!(cycled(&channel, [0, 7], &many, sample).is_none());
}
