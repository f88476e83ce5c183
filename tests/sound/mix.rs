//! The mix of a scene at any time is the sum of its sounds as the script has them.

use crate::decode::{samples, wav};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::{StageAssets, StagePlan};
use dragonfly_kit::counting::count;
use dragonfly_kit::folder::Folder;
use dragonfly_sound::{MixedSounds, SoundMix, SoundSamples};
use std::sync::Arc;

/// Frames a second of the mix.
pub(crate) const RATE: f64 = 48_000.0;

/// Returns a sound of one value on the left and its negative on the right, `seconds` long.
pub(crate) fn flat(value: f32, seconds: f64) -> Arc<SoundSamples> {
    let folder = Folder::new("sound-flat");
    let path = folder.join("it.wav");
    wav(&path, 2, 1_000, &[value, -value].repeat((seconds * 1_000.0) as usize));
    Arc::new(samples(&path).expect("a sound"))
}

/// Returns the plan of a script with these actions.
pub(crate) fn plan(actions: &str) -> Arc<StagePlan> {
    let text =
        format!("<script version=\"1\" fps=\"24\"><cast/><par><wait dur=\"20\"/>{actions}</par></script>");
    let script = StageScript::read(text.as_str()).unwrap_or_else(|errors| panic!("{}", errors[0]));
    Arc::new(
        StagePlan::new(&script, &StageAssets::default()).unwrap_or_else(|errors| panic!("{}", errors[0])),
    )
}

fn scene(actions: &str, samples: &[Option<Arc<SoundSamples>>]) -> SoundMix {
    SoundMix::new(MixedSounds::Scene { plan: plan(actions), samples: samples.to_vec() })
}

/// Returns the frames from a time on.
fn mixed(mix: &mut SoundMix, from: f64, step: f64, frames: usize) -> Vec<[f32; 2]> {
    let mut out = vec![[0.0; 2]; frames];
    mix.add(from, step, &mut out);
    out
}

/// Returns the left side of one frame, far from where sounds begin and end.
fn left(mix: &mut SoundMix, time: f64) -> f32 {
    let [left, right] = mixed(mix, time, 1.0 / RATE, 64)[10];
    assert_eq!(left, -right);
    left
}

fn near(have: f32, want: f32) {
    assert!((have - want).abs() < 1e-3, "{have} instead of {want}");
}

#[test]
fn sounds_play_from_their_begin_to_their_end_with_their_loudness() {
    let sounds = "<sound src=\"a.wav\" begin=\"1\" end=\"3\" gain=\"0.5\"/><sound src=\"b.wav\" begin=\"2\" end=\"4\"/>";
    let mut mix = scene(sounds, &[Some(flat(0.5, 9.0)), Some(flat(0.125, 9.0))]);
    for (time, wanted) in [(0.5, 0.0), (1.5, 0.25), (2.5, 0.375), (3.5, 0.125), (4.5, 0.0)] {
        near(left(&mut mix, time), wanted);
    }
}

#[test]
fn a_sound_begins_at_its_frame_and_ends_without_a_click() {
    let mut mix = scene("<sound src=\"a.wav\" begin=\"1\" end=\"2\"/>", &[Some(flat(0.5, 9.0))]);
    let step = 1.0 / RATE;
    for ahead in [0, 1, 63, 127, 128, 300] {
        let frames = mixed(&mut mix, 1.0 - f64::from(ahead) * step, step, 600);
        let first = frames.iter().position(|frame| frame[0].abs() > 1e-4).expect("a sound");
        assert!(first.abs_diff(ahead as usize) <= 1, "{first} instead of {ahead}");
    }
    let frames = mixed(&mut mix, 1.99, step, 960);
    let jumps = frames.windows(2).map(|pair| (pair[1][0] - pair[0][0]).abs());
    assert!(jumps.fold(0.0, f32::max) < 0.01, "it fades");
    assert!(frames[..380].iter().all(|frame| (frame[0] - 0.5).abs() < 1e-3));
    assert!(frames[700..].iter().all(|frame| frame[0] == 0.0));
}

#[test]
fn fades_and_repeats_are_those_of_the_script() {
    let fading = "<sound src=\"a.wav\" begin=\"0\" end=\"4\" fade-in=\"2\" fade-out=\"1\"/>";
    let mut mix = scene(fading, &[Some(flat(0.8, 9.0))]);
    let (early, middle, late) = (left(&mut mix, 0.5), left(&mut mix, 2.5), left(&mut mix, 3.5));
    assert!(early > 0.01 && early < 0.5 && late > 0.01 && late < 0.7, "{early} {late}");
    near(middle, 0.8);
    // A ramp of half a second that repeats.
    let folder = Folder::new("sound-ramp");
    let path = folder.join("ramp.wav");
    let ramp: Vec<f32> = (0..500).map(|at| at as f32 / 500.0).collect();
    wav(&path, 1, 1_000, &ramp);
    let ramp = Arc::new(samples(&path).expect("a sound"));
    // Whether the plan knows how long the sound is or not.
    let three = "<sound src=\"a.wav\" begin=\"1\" repeat=\"3\"/>";
    for plan in [plan_with_length(three, 0.5), plan(three)] {
        let mut mix = SoundMix::new(MixedSounds::Scene { plan, samples: vec![Some(Arc::clone(&ramp))] });
        for (time, wanted) in [(1.25, 0.5), (1.75, 0.5), (2.1, 0.2), (2.4, 0.8), (2.6, 0.0)] {
            let [mixed, _] = mixed(&mut mix, time, 1.0 / RATE, 1)[0];
            assert!((mixed - wanted).abs() < 5e-3, "{mixed} at {time} s instead of {wanted}");
        }
        // Also in the block in which it starts again.
        let frames = mixed(&mut mix, 1.5 - 64.0 / RATE, 1.0 / RATE, 128);
        assert!(frames[100][0] < 0.05 && frames[20][0] > 0.9, "{:?}", frames[100]);
    }
}

/// Returns a plan that knows how long its sounds are.
fn plan_with_length(actions: &str, seconds: f64) -> Arc<StagePlan> {
    let text =
        format!("<script version=\"1\" fps=\"24\"><cast/><par><wait dur=\"20\"/>{actions}</par></script>");
    let script = StageScript::read(text.as_str()).unwrap_or_else(|errors| panic!("{}", errors[0]));
    let mut assets = StageAssets::default();
    assets.add_sound("a.wav", dragonfly_anim::stage::time::StageTime::from_seconds(seconds));
    Arc::new(StagePlan::new(&script, &assets).unwrap_or_else(|errors| panic!("{}", errors[0])))
}

#[test]
fn backwards_and_at_another_speed_each_moment_sounds_as_forwards() {
    let folder = Folder::new("sound-speeds");
    let path = folder.join("it.wav");
    let ramp: Vec<f32> = (0..4_000).map(|at| at as f32 / 4_000.0).collect();
    wav(&path, 1, 1_000, &ramp);
    let sound = Arc::new(samples(&path).expect("a sound"));
    let mut mix = SoundMix::new(MixedSounds::Take { begin: 0.5, samples: sound });
    for speed in [1.0, 0.25, 3.0, -1.0, -2.0] {
        let step = speed / RATE;
        for (number, [mixed, _]) in mixed(&mut mix, 2.0, step, 3_000).into_iter().enumerate() {
            let wanted = (2.0 + step * number as f64 - 0.5) / 4.0;
            assert!((f64::from(mixed) - wanted).abs() < 1e-3, "{mixed} instead of {wanted} at {speed} x");
        }
    }
}

#[test]
fn sounds_that_cannot_be_played_are_silent_and_mixing_allocates_nothing() {
    let sounds = "<sound src=\"a.wav\"/><sound src=\"b.wav\"/>".repeat(20);
    let mut samples = vec![None; 40];
    samples[1] = Some(flat(0.1, 9.0));
    let mut mix = scene(&sounds, &samples);
    near(left(&mut mix, 1.0), 0.1);
    let mut out = vec![[0.0; 2]; 4_096];
    let (allocated, ()) = count(|| {
        for at in 0..20 {
            mix.add(f64::from(at), 1.0 / RATE, &mut out);
        }
    });
    assert_eq!(allocated.bytes, 0);
}
