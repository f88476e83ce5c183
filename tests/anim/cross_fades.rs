//! Cross-fades between two cycles that stay in phase.

use dragonfly_anim::blend::{CrossFade, Cycle, FadeCurve, common_length};
use dragonfly_kit::counting::count;
use proptest::prelude::*;

/// Returns the last mark and the share of the way to the next one, computed from the times alone.
fn place(time: f32, start: f32, length: f32, marks: &[f32]) -> (usize, f64) {
    let inside = f64::from(time - start);
    // Every mark of the previous, the current and the next round.
    let all: Vec<(usize, f64)> = [-1.0, 0.0, 1.0]
        .iter()
        .flat_map(|round| {
            marks.iter().enumerate().map(move |(at, mark)| (at, f64::from(*mark) + round * f64::from(length)))
        })
        .collect();
    let at = all.iter().rposition(|(_, mark)| *mark <= inside).unwrap();
    (all[at].0, (inside - all[at].1) / (all[at + 1].1 - all[at].1))
}

/// Returns the distance between two phases, in steps from mark to mark, on a circle.
fn apart(a: (usize, f64), b: (usize, f64), marks: usize) -> f64 {
    let off = (a.0 as f64 + a.1 - b.0 as f64 - b.1).rem_euclid(marks as f64);
    off.min(marks as f64 - off)
}

/// Marks at increasing parts of a length.
fn marks(parts: &[f32], length: f32) -> Vec<f32> {
    let total: f32 = parts.iter().sum::<f32>() + 0.05;
    let mut at = 0.02;
    parts
        .iter()
        .map(|part| {
            at += part;
            length * (at / (total + 0.05))
        })
        .collect()
}

proptest! {
    #[test]
    fn a_cross_fade_keeps_phases_equal(
        lengths in (0.2_f32..3.0, 0.2_f32..3.0),
        starts in (-2.0_f32..2.0, 0.0_f32..2.0),
        parts in prop::collection::vec((0.05_f32..1.0, 0.05_f32..1.0), 0..5),
        seconds in 0.0_f32..2.0,
        steps in prop::collection::vec(0.0_f32..0.3, 1..40),
        begin in 0.0_f32..1.0,
    ) {
        let from_marks = marks(&parts.iter().map(|part| part.0).collect::<Vec<_>>(), lengths.0);
        let to_marks = marks(&parts.iter().map(|part| part.1).collect::<Vec<_>>(), lengths.1);
        let from = Cycle::new(starts.0, lengths.0).with_marks(from_marks.iter().map(|mark| mark + starts.0));
        let to = Cycle::new(starts.1, lengths.1).with_marks(to_marks.iter().map(|mark| mark + starts.1));
        prop_assume!(from.marks() == to.marks());
        let whole = [0.0];
        let from_marks = if parts.is_empty() { &whole[..] } else { &from_marks };
        let to_marks = if parts.is_empty() { &whole[..] } else { &to_marks };

        let begin = starts.0 + begin * lengths.0;
        let mut fade = CrossFade::new(from, to, seconds, FadeCurve::SmoothStep).starting_at(begin);
        prop_assert!((fade.now().from_time - begin).abs() < 1e-5 || (fade.now().from_time - begin).abs() > lengths.0 - 1e-5);
        let mut weight = 0.0;
        for dt in steps {
            let now = fade.advance(dt);
            prop_assert!((starts.0..=starts.0 + lengths.0).contains(&now.from_time));
            prop_assert!((starts.1..=starts.1 + lengths.1).contains(&now.to_time));
            let from = place(now.from_time, starts.0, lengths.0, from_marks);
            let to = place(now.to_time, starts.1, lengths.1, to_marks);
            prop_assert!(apart(from, to, from_marks.len()) < 2e-4, "{from:?} {to:?} {now:?}");
            prop_assert!(now.weight >= weight && now.weight <= 1.0);
            weight = now.weight;
        }
    }

    #[test]
    fn the_time_of_a_phase_converted_back_to_a_phase_gives_the_same_time(
        start in -5.0_f32..5.0, length in 0.1_f32..9.0, times in prop::collection::vec(0.0_f32..9.0, 0..6),
        phase in 0.0_f64..1.0,
    ) {
        let cycle = Cycle::new(start, length).with_marks(times.iter().map(|time| start + time));
        let time = cycle.time_at(phase);
        prop_assert!((start..=start + length).contains(&time));
        // Marks may be very close to each other; the time is compared.
        let again = cycle.time_at(cycle.phase_at(time));
        let off = (again - time).abs();
        prop_assert!(off < 2e-6 * (1.0 + start.abs() + length) || (off - length).abs() < 1e-5, "{time} {again}");
    }
}

#[test]
fn each_take_plays_at_its_own_speed_when_it_is_alone() {
    let (walk, run) = (Cycle::new(0.0, 1.0), Cycle::new(2.0, 0.5));
    let mut fade = CrossFade::new(walk, run, 1e-3, FadeCurve::Linear);
    fade.advance(1e-3);
    assert!(fade.is_done());
    let before = fade.now().to_time;
    let after = fade.advance(0.2).to_time;
    assert!((after - before - 0.2).abs() < 1e-6, "{before} {after}");
    // The start of a very long fade.
    let mut fade = CrossFade::new(Cycle::new(0.0, 1.0), Cycle::new(2.0, 0.5), 1e9, FadeCurve::Linear);
    assert!((fade.advance(0.25).from_time - 0.25).abs() < 1e-6);
}

#[test]
fn a_step_of_many_rounds_has_the_exact_result() {
    let cycle = || Cycle::new(0.0, 1.0).with_marks([0.1, 0.4]);
    let mut fade = CrossFade::new(cycle(), cycle(), 1.0, FadeCurve::Linear);
    // Phase 0 is the first mark.
    let now = fade.advance(7.25);
    assert!((now.to_time - 0.35).abs() < 1e-6 && now.weight == 1.0, "{now:?}");
    let now = fade.advance(1e6);
    assert!((now.to_time - 0.35).abs() < 1e-5, "{now:?}");
}

#[test]
fn at_half_weight_a_round_takes_the_mean_of_both_lengths() {
    // 3 s and 1 s: at weight ½ a round takes 2 s. In the middle of a very long linear fade the weight is nearly
    // constant.
    let mut fade = CrossFade::new(Cycle::new(0.0, 3.0), Cycle::new(0.0, 1.0), 2e6, FadeCurve::Linear);
    fade.advance(1e6);
    let before = fade.phase();
    fade.advance(0.5);
    assert!(((fade.phase() - before).rem_euclid(1.0) - 0.25).abs() < 1e-5, "{before} {}", fade.phase());
    assert_eq!(common_length([(3.0, 0.5), (1.0, 0.5)]), 2.0);
    assert_eq!(common_length([(3.0, 1.0), (1.0, 3.0), (9.0, f32::NAN), (9.0, -1.0)]), 1.5);
    assert_eq!(common_length([]), 0.0);
    assert_eq!(common_length([(f32::INFINITY, f32::INFINITY)]), f32::MAX);
}

#[test]
fn both_takes_reach_corresponding_marks_at_the_same_phase() {
    // From mark to mark, one take needs 0.3 s and 0.7 s, the other 0.5 s and 0.5 s.
    let walk = Cycle::new(0.0, 1.0).with_marks([0.1, 0.4]);
    let run = Cycle::new(0.0, 1.0).with_marks([0.5, 0.0]);
    let fade = CrossFade::new(walk, run, 1.0, FadeCurve::Linear).starting_at(0.1);
    assert_eq!((fade.now().from_time, fade.now().to_time), (0.1, 0.0));
    let fade = fade.clone().starting_at(0.25);
    assert!((fade.now().to_time - 0.25).abs() < 1e-6, "half of the first step: {:?}", fade.now());
    let fade = fade.clone().starting_at(0.75);
    assert!((fade.now().to_time - 0.75).abs() < 1e-6, "half of the second step: {:?}", fade.now());
    let fade = fade.clone().starting_at(0.05);
    assert!((fade.now().to_time - (0.5 + 0.5 * 0.65 / 0.7)).abs() < 1e-6, "{:?}", fade.now());
}

#[test]
fn different_numbers_of_marks_are_ignored() {
    let two = Cycle::new(0.0, 1.0).with_marks([0.1, 0.4]);
    let three = Cycle::new(0.0, 2.0).with_marks([0.1, 0.4, 0.5]);
    let fade = CrossFade::new(two, three, 1.0, FadeCurve::Linear).starting_at(0.25);
    assert_eq!((fade.now().from_time, fade.now().to_time), (0.25, 0.5));
}

#[test]
fn the_phase_hardly_depends_on_the_size_of_the_time_steps() {
    let fade = || {
        let walk = Cycle::new(0.0, 1.1).with_marks([0.1, 0.6]);
        CrossFade::new(walk, Cycle::new(0.0, 0.6).with_marks([0.0, 0.35]), 0.5, FadeCurve::SmoothStep)
    };
    let run = |steps: usize| {
        let mut fade = fade();
        for _ in 0..steps {
            fade.advance(1.0 / steps as f32);
        }
        fade.phase()
    };
    let exact = run(20_000);
    for steps in [30, 60, 144] {
        assert!((run(steps) - exact).abs() < 1e-3, "{steps}: {} {exact}", run(steps));
    }
    // A step that ends after the fade: the part after the fade is played at the speed of the second take, as with many
    // steps.
    assert!((run(2) - exact).abs() < 0.05, "{} {exact}", run(2));
}

#[test]
fn the_same_steps_give_the_same_bits() {
    let run = || {
        let mut fade = CrossFade::new(
            Cycle::new(0.0, 0.7083333),
            Cycle::new(0.0, 1.1583333),
            0.3,
            FadeCurve::SmoothStep,
        );
        (0..100)
            .map(|step| fade.advance(0.016 + step as f32 * 1e-5))
            .map(|now| (now.from_time.to_bits(), now.to_time.to_bits(), now.weight.to_bits()))
            .collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}

#[test]
fn fade_weights_increase_from_zero_to_one() {
    for curve in FadeCurve::ALL {
        assert_eq!((curve.weight(0.0), curve.weight(1.0), curve.weight(0.5)), (0.0, 1.0, 0.5));
        assert_eq!((curve.weight(-1.0), curve.weight(7.0), curve.weight(f64::NAN)), (0.0, 1.0, 0.0));
        let weights: Vec<f64> = (0..=100).map(|step| curve.weight(f64::from(step) / 100.0)).collect();
        assert!(weights.is_sorted());
    }
    assert_eq!(FadeCurve::SmoothStep.weight(0.25), 0.15625);
}

#[test]
fn invalid_cycles_and_clocks_have_defined_results() {
    let hostile = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, -1.0, 0.0, 1e-45, 1.0];
    for start in hostile {
        for length in hostile {
            let cycle = Cycle::new(start, length).with_marks(hostile);
            for seconds in hostile {
                let other = Cycle::new(0.5, 2.0).with_marks([0.6, 2.5].into_iter().take(cycle.marks()));
                let mut fade = CrossFade::new(cycle.clone(), other, seconds, FadeCurve::SmoothStep);
                for time in hostile {
                    fade = fade.starting_at(time);
                    let now = fade.advance(time);
                    assert!(now.from_time.is_finite() && (0.5..=2.5).contains(&now.to_time), "{now:?}");
                    assert!((0.0..=1.0).contains(&now.weight), "{now:?}");
                    assert!((0.0..1.0).contains(&fade.phase()));
                }
            }
        }
    }
    // A pose without duration has no phase; nothing moves, and nothing divides by zero.
    let mut fade = CrossFade::new(Cycle::new(3.0, 0.0), Cycle::new(4.0, 0.0), 1.0, FadeCurve::Linear);
    let now = fade.advance(0.5);
    assert_eq!((now.from_time, now.to_time, now.weight), (3.0, 4.0, 0.5));
    // Immediately, without a duration of the fade.
    assert_eq!(
        CrossFade::new(Cycle::new(0.0, 1.0), Cycle::new(0.0, 1.0), 0.0, FadeCurve::Linear).now().weight,
        1.0
    );
    for phase in [f64::NAN, f64::INFINITY, -1e-300, 7.25] {
        assert!((0.0..=1.0).contains(&Cycle::new(0.0, 1.0).time_at(phase)));
    }
}

#[test]
fn advancing_allocates_nothing() {
    let mut fade = CrossFade::new(Cycle::new(0.0, 1.0), Cycle::new(0.0, 2.0), 0.5, FadeCurve::Linear);
    let (count, _) = count(|| fade.advance(0.1));
    assert_eq!(count.allocations, 0);
}
