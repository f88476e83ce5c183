//! Fades between takes that run freely, and takes that play once.

use dragonfly_anim::blend::{FadeCurve, Faded, FreeFade, OneShot, Playback};
use dragonfly_anim::data::Take;
use dragonfly_anim::sample::loop_time;
use dragonfly_kit::counting::count;
use proptest::prelude::*;

/// Returns the distance between two times on a circle of `length` seconds.
fn apart(a: f32, b: f32, length: f32) -> f32 {
    let off = (a - b).rem_euclid(length);
    off.min(length - off)
}

proptest! {
    #[test]
    fn in_a_free_fade_each_take_is_where_it_would_be_alone(
        starts in (-2.0_f32..2.0, 0.0_f32..2.0),
        lengths in (0.2_f32..3.0, 0.2_f32..3.0),
        begin in (0.0_f32..1.0, 0.0_f32..1.0),
        seconds in 0.01_f32..2.0,
        steps in prop::collection::vec(0.0_f32..0.3, 1..40),
        smooth: bool,
    ) {
        let curve = if smooth { FadeCurve::SmoothStep } else { FadeCurve::Linear };
        let begin = (starts.0 + begin.0 * lengths.0, starts.1 + begin.1 * lengths.1);
        let from = Playback::new(starts.0, lengths.0, true).starting_at(begin.0);
        let to = Playback::new(starts.1, lengths.1, false).starting_at(begin.1);
        let mut fade = FreeFade::new(from, to, seconds, curve);
        let mut passed = 0.0;
        for dt in steps {
            passed += dt;
            let now = fade.advance(dt);
            let alone = loop_time(begin.0 + passed, starts.0, lengths.0);
            prop_assert!(apart(now.from_time, alone, lengths.0) < 1e-4, "{now:?}");
            let alone = (begin.1 + passed).min(starts.1 + lengths.1);
            prop_assert!((now.to_time - alone).abs() < 1e-4, "{now:?}");
            let x = (passed / seconds).min(1.0);
            let expected = if smooth { x * x * (3.0 - 2.0 * x) } else { x };
            prop_assert!((now.weight - expected).abs() < 1e-3, "{now:?} {expected}");
            prop_assert_eq!(fade.is_done(), now.weight == 1.0 && fade.is_done());
        }
        fade.advance(seconds);
        prop_assert!(fade.is_done() && fade.now().weight == 1.0);
    }

    #[test]
    fn a_one_shot_rises_stays_and_falls_with_its_take(
        length in 0.2_f32..3.0, fades in (0.0_f32..1.0, 0.0_f32..1.0), below in (0.2_f32..3.0, 0.0_f32..3.0),
        steps in prop::collection::vec(0.0_f32..0.3, 1..40),
    ) {
        // Both together are no longer than the take.
        let (fade_in, fade_out) = (fades.0 * length, fades.1 * (1.0 - fades.0) * length);
        let base = Playback::new(0.0, below.0, true).starting_at(below.1);
        let mut shot = OneShot::new(base, Playback::new(1.0, length, false), fade_in, fade_out, FadeCurve::Linear);
        prop_assert!(shot.now().weight == 0.0 || fade_in == 0.0);
        let mut passed = 0.0;
        for dt in steps {
            passed += dt;
            let now = shot.advance(dt);
            prop_assert!((now.to_time - (1.0 + passed).min(1.0 + length)).abs() < 1e-4, "{now:?}");
            prop_assert!(apart(now.from_time, loop_time(below.1 + passed, 0.0, below.0), below.0) < 1e-4);
            let left = length - passed;
            let expected = if left <= 0.0 { 0.0 } else { (passed / fade_in).min(left / fade_out).min(1.0) };
            let rounding = 1e-4 / fade_in.min(fade_out).max(1e-4);
            prop_assert!((now.weight - expected).abs() < rounding || left.abs() < 1e-4, "{now:?} {expected}");
            prop_assert!(shot.is_done() == (left <= 0.0) || left.abs() < 1e-4);
        }
    }
}

#[test]
fn a_fade_out_ends_with_the_take() {
    let walk = Playback::new(0.0, 1.0, true);
    let mut shot = OneShot::new(walk, Playback::new(5.0, 2.0, false), 0.25, 0.5, FadeCurve::Linear);
    let weights: Vec<f32> =
        (0..=8).map(|step| if step == 0 { shot.now().weight } else { shot.advance(0.25).weight }).collect();
    assert_eq!(weights, [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 0.0]);
    assert!(shot.is_done());
    assert_eq!(shot.now(), Faded { from_time: 0.0, to_time: 7.0, weight: 0.0 });
    // The base take continues alone.
    assert_eq!(shot.advance(0.75).from_time, 0.75);
    assert_eq!((shot.now().weight, shot.below().time()), (0.0, 0.75));
    // A one-shot plays once, even if the playback loops.
    let again = OneShot::new(walk, Playback::new(0.0, 1.0, true), 0.0, 0.0, FadeCurve::Linear);
    assert_eq!((again.now().weight, again.clone().advance(1.5).weight), (1.0, 0.0));
}

#[test]
fn fades_that_are_together_longer_than_the_take_are_shortened_in_proportion() {
    let stand = Playback::new(0.0, 0.0, true);
    // 3 s and 1 s over a take of 1 s: three quarters in, one quarter out.
    let mut shot = OneShot::new(stand, Playback::new(0.0, 1.0, false), 3.0, 1.0, FadeCurve::Linear);
    let weights: Vec<f32> = [0.375, 0.375, 0.125, 0.125].map(|dt| shot.advance(dt).weight).to_vec();
    assert_eq!(weights, [0.5, 1.0, 0.5, 0.0]);
}

#[test]
fn a_take_stops_at_its_end_unless_it_loops() {
    let take = Take { start: 2.0, length: 1.5, ..Take::default() };
    let (mut once, mut round) = (Playback::once(&take), Playback::repeating(&take));
    assert_eq!((once.time(), round.time(), once.left()), (2.0, 2.0, 1.5));
    assert_eq!((once.advance(1.0), round.advance(1.0)), (3.0, 3.0));
    assert_eq!((once.advance(1.0), round.advance(1.0)), (3.5, 2.5));
    assert!(once.has_ended() && !round.has_ended());
    assert_eq!((once.left(), round.left()), (0.0, 1.0));
    assert_eq!((once.starting_at(0.0).time(), round.starting_at(1.0).time()), (2.0, 2.5));
    assert!(!once.starting_at(3.25).has_ended());
}

#[test]
fn a_fade_continues_from_another_fade() {
    let stand = Playback::new(0.0, 4.0, true);
    let mut first = FreeFade::new(stand, Playback::new(0.0, 1.0, false), 0.2, FadeCurve::SmoothStep);
    first.advance(0.7);
    let mut second = FreeFade::new(first.to(), stand, 0.2, FadeCurve::SmoothStep);
    let now = second.advance(0.1);
    assert!((now.from_time - 0.8).abs() < 1e-6 && (now.to_time - 0.1).abs() < 1e-6, "{now:?}");
    assert!((now.weight - 0.5).abs() < 1e-6, "{now:?}");
}

#[test]
fn the_result_does_not_depend_on_the_size_of_the_time_steps() {
    let run = |steps: usize| {
        let shot = Playback::new(0.0, 2.0, false);
        let mut fade = FreeFade::new(Playback::new(0.0, 0.3, true), shot, 1.5, FadeCurve::SmoothStep);
        let mut over = OneShot::new(Playback::new(0.0, 0.3, true), shot, 0.4, 0.9, FadeCurve::SmoothStep);
        for _ in 0..steps {
            fade.advance(1.25 / steps as f32);
            over.advance(1.25 / steps as f32);
        }
        [fade.now(), over.now()]
    };
    let exact = run(1);
    for steps in [3, 60, 144, 10_000] {
        for (a, b) in exact.into_iter().zip(run(steps)) {
            assert!(
                (a.weight - b.weight).abs() < 1e-4 && (a.to_time - b.to_time).abs() < 1e-4,
                "{a:?} {b:?}"
            );
            assert!(apart(a.from_time, b.from_time, 0.3) < 1e-4, "{a:?} {b:?}");
        }
    }
}

#[test]
fn invalid_takes_and_clocks_have_defined_results() {
    let hostile = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, -1.0, 0.0, 1e-45, 1.0];
    for start in hostile {
        for length in hostile {
            for repeats in [false, true] {
                let play = Playback::new(start, length, repeats);
                let other = Playback::new(0.5, 2.0, !repeats);
                for seconds in hostile {
                    for time in hostile {
                        let mut fade =
                            FreeFade::new(play.starting_at(time), other, seconds, FadeCurve::Linear);
                        let mut shot =
                            OneShot::new(other, play.starting_at(time), seconds, time, FadeCurve::Linear);
                        let mut over =
                            OneShot::new(play.starting_at(time), other, time, seconds, FadeCurve::Linear);
                        for now in [fade.advance(time), shot.advance(time), over.advance(time), shot.now()] {
                            assert!(now.from_time.is_finite() && now.to_time.is_finite(), "{now:?}");
                            assert!((0.0..=1.0).contains(&now.weight), "{now:?}");
                        }
                        assert!((0.5..=2.5).contains(&fade.now().to_time));
                    }
                }
            }
        }
    }
    // A take without length ends as soon as it starts.
    let nothing = Playback::new(1.0, 0.0, false);
    let shot = OneShot::new(Playback::new(0.0, 1.0, true), nothing, 0.5, 0.5, FadeCurve::Linear);
    assert!(shot.is_done() && shot.now().weight == 0.0);
    // A fade without length: the second take immediately.
    let fade = FreeFade::new(nothing, nothing, 0.0, FadeCurve::Linear);
    assert!(fade.is_done() && fade.now().weight == 1.0);
}

#[test]
fn advancing_allocates_nothing() {
    let play = Playback::new(0.0, 1.0, true);
    let mut fade = FreeFade::new(play, play, 0.5, FadeCurve::Linear);
    let mut shot = OneShot::new(play, play, 0.5, 0.5, FadeCurve::Linear);
    let (count, _) = count(|| (fade.advance(0.1), shot.advance(0.1)));
    assert_eq!(count.allocations, 0);
}
