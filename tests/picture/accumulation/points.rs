//! The sub-frames cover pixel, lens, light and time evenly, for any number of them.

use dragonfly_anim::stage::time::{StageRate, StageTime};
use dragonfly_picture::{FILTER_RADIUS, FrameSampling, SampledFrame, SubFrame};
use glam::Vec2;

const COUNTS: [u32; 8] = [2, 3, 7, 16, 24, 64, 100, 1024];

fn sub_frames(samples: u32, samples_per_pixel: u32) -> Vec<SubFrame> {
    let frame = SampledFrame::new(FrameSampling { samples, ..FrameSampling::default() }, StageTime::ZERO);
    (0..samples).map(|index| frame.sub_frame(index, samples_per_pixel)).collect()
}

/// Returns whether one number is in each part of 0..1, which is cut into equal parts by their count.
fn is_even(numbers: impl Iterator<Item = f64>) -> bool {
    let numbers: Vec<f64> = numbers.collect();
    let mut parts: Vec<usize> =
        numbers.iter().map(|number| (number * numbers.len() as f64) as usize).collect();
    parts.sort_unstable();
    parts.iter().copied().eq(0..numbers.len())
}

fn mean(points: impl Iterator<Item = Vec2>) -> Vec2 {
    let points: Vec<Vec2> = points.collect();
    points.iter().sum::<Vec2>() / points.len() as f32
}

#[test]
fn each_part_of_time_and_threshold_has_one_sub_frame() {
    for count in COUNTS {
        let all = sub_frames(count, 4);
        assert!(is_even(all.iter().map(|one| one.shutter)), "{count}");
        assert!(is_even(all.iter().map(|one| f64::from(one.threshold))), "{count}");
        for point in [|one: &SubFrame| one.lens, |one: &SubFrame| one.light] {
            assert!(all.iter().all(|one| point(one).length() < 1.0), "{count}");
            assert!(is_even(all.iter().map(|one| f64::from(point(one).length_squared()))), "{count}");
            let middle = mean(all.iter().map(point));
            assert!(count < 16 || middle.length() < 0.1, "{count}: {middle}");
        }
    }
}

#[test]
fn positions_in_the_pixel_have_the_width_of_the_filter() {
    // The variance of the filter, and of the samples of a pixel that has four.
    let (filter, own) = (0.076_737 * FILTER_RADIUS * FILTER_RADIUS, 5.0 / 64.0);
    for (samples_per_pixel, expected) in [(1, filter), (4, filter - own)] {
        for count in [64, 1024] {
            let all = sub_frames(count, samples_per_pixel);
            let middle = mean(all.iter().map(|one| one.pixel));
            assert!(middle.length() < 0.03, "{count}: {middle}");
            let variance = mean(all.iter().map(|one| one.pixel * one.pixel));
            for axis in variance.to_array() {
                assert!((f64::from(axis) / expected - 1.0).abs() < 0.08, "{count}: {axis}, not {expected}");
            }
        }
    }
}

#[test]
fn lens_light_and_time_do_not_depend_on_each_other() {
    for count in [24, 48, 64] {
        let all = sub_frames(count, 4);
        let columns: Vec<Vec<f64>> = [
            |one: &SubFrame| one.shutter - 0.5,
            |one: &SubFrame| f64::from(one.pixel.x),
            |one: &SubFrame| f64::from(one.pixel.y),
            |one: &SubFrame| f64::from(one.lens.x),
            |one: &SubFrame| f64::from(one.lens.y),
            |one: &SubFrame| f64::from(one.light.x),
            |one: &SubFrame| f64::from(one.light.y),
        ]
        .map(|number| all.iter().map(number).collect())
        .to_vec();
        for (at, a) in columns.iter().enumerate() {
            for (other, b) in columns.iter().enumerate().skip(at + 1) {
                let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                let correlation = product(a, b) / (product(a, a) * product(b, b)).sqrt();
                assert!(correlation.abs() < 0.45, "{count}: {at} and {other}: {correlation}");
            }
        }
    }
}

#[test]
fn sub_frames_are_around_the_time_of_their_frame_at_exact_times() {
    let rate = StageRate::new(24_000, 1001).expect("a rate");
    let sampling = FrameSampling { samples: 8, shutter: 90.0, rate, ..FrameSampling::default() };
    let time = rate.frame(1000);
    let seconds = |frame: &SampledFrame| -> Vec<f64> {
        (0..8).map(|index| frame.seconds(&frame.sub_frame(index, 4))).collect()
    };
    let frame = SampledFrame::new(sampling, time);
    let all = seconds(&frame);
    let (first, last) = (all[0], all[7]);
    let tick = 1.0 / 705_600_000.0;
    assert!(((first + last) / 2.0 - time.seconds()).abs() < 2.0 * tick, "{first} to {last}");
    assert!((last - first - 7.0 / 8.0 * 0.25 * 1001.0 / 24_000.0).abs() < 2.0 * tick);
    for at in &all {
        assert_eq!(StageTime::from_seconds(*at).seconds(), *at, "a whole number of ticks");
    }
    // A shot that begins with the frame shows nothing of the shot before.
    let cut = seconds(&frame.within((time, time + rate.frame(20))));
    assert!(cut.iter().all(|at| *at >= time.seconds()) && (cut[7] - last).abs() < 0.01);
    assert!(cut.windows(2).all(|two| two[0] < two[1]));
    let single = SampledFrame::new(FrameSampling { samples: 1, ..sampling }, time);
    assert_eq!(single.seconds(&single.sub_frame(0, 4)), time.seconds());
}
