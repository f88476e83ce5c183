//! The samples for the device follow the clock of the window, from command to command.

use crate::mix::flat;
use dragonfly_kit::counting::count;
use dragonfly_sound::{MixedSounds, OutputCommand, OutputVoice, SoundClock, SoundMix};
use flume::{Receiver, Sender};
use std::time::{Duration, Instant};

const RATE: u32 = 48_000;

struct VoiceBench {
    commands: Sender<OutputCommand>,
    freed: Receiver<OutputCommand>,
    voice: OutputVoice,
    begun: Instant,
}

impl VoiceBench {
    fn new() -> Self {
        let (commands, waiting) = flume::bounded(8);
        let (free, freed) = flume::bounded(8);
        Self { commands, freed, voice: OutputVoice::new(waiting, free), begun: Instant::now() }
    }

    /// Plays a sound of half of full scale from 1 s on, along a clock.
    fn play(&self, time_at: impl Fn(Duration) -> f64 + Send + 'static, speed: f64) {
        let mix = SoundMix::new(MixedSounds::Take { begin: 1.0, samples: flat(0.5, 1.0) });
        let clock = SoundClock { begun: self.begun, time_at: Box::new(time_at), speed };
        self.commands.send(OutputCommand::Play(Box::new(mix), clock)).unwrap();
    }

    /// Returns the left side of the frames from `after` on.
    fn played(&mut self, after: f64, frames: usize) -> Vec<f32> {
        let mut out = vec![[9.0; 2]; frames];
        self.voice.fill(self.begun + Duration::from_secs_f64(after), RATE, &mut out);
        out.into_iter().map(|frame| frame[0]).collect()
    }
}

fn is_near(samples: &[f32], wanted: f32) -> bool {
    samples.iter().all(|sample| (sample - wanted).abs() < 1e-3)
}

#[test]
fn there_is_silence_before_the_first_command_and_after_a_stop() {
    let mut bench = VoiceBench::new();
    assert!(is_near(&bench.played(0.0, 100), 0.0));
    bench.play(|passed| 1.2 + passed.as_secs_f64(), 1.0);
    assert!(is_near(&bench.played(0.0, 100), 0.5));
    bench.commands.send(OutputCommand::Stop).unwrap();
    assert!(is_near(&bench.played(0.1, 100), 0.0));
    // A mix that is no longer played goes back, and is freed there.
    assert!(matches!(
        bench.freed.try_iter().collect::<Vec<_>>()[..],
        [OutputCommand::Stop, OutputCommand::Play(..)]
    ));
}

#[test]
fn sounds_follow_the_clock_over_the_end_of_a_loop() {
    let mut bench = VoiceBench::new();
    // From 0 to 2 s and again: the sound is in the second half.
    bench.play(|passed| passed.as_secs_f64() % 2.0, 1.0);
    let frames = bench.played(0.0, RATE as usize * 6);
    for (second, part) in frames.chunks(RATE as usize).enumerate() {
        let wanted = if second % 2 == 1 { 0.5 } else { 0.0 };
        let inner = &part[600..RATE as usize - 600];
        assert!(is_near(inner, wanted), "second {second}");
    }
}

#[test]
fn a_clock_that_goes_back_and_forth_plays_backwards_on_its_way_back_and_a_paused_one_is_silent() {
    let mut bench = VoiceBench::new();
    // To 1.5 s and back.
    bench.play(|passed| 1.5 - (passed.as_secs_f64() - 0.5).abs(), 1.0);
    let frames = bench.played(0.0, RATE as usize * 2);
    assert!(is_near(&frames[600..RATE as usize - 600], 0.5), "from 1 to 1.5 s and back to 1");
    assert!(is_near(&frames[RATE as usize + 600..], 0.0), "before the sound");
    bench.play(|_| 1.5, 1.0);
    assert!(is_near(&bench.played(0.0, 1_000), 0.0));
}

#[test]
fn small_differences_of_the_clocks_leave_no_gap_and_large_ones_are_followed() {
    let mut bench = VoiceBench::new();
    bench.play(|passed| 1.0 + passed.as_secs_f64(), 1.0);
    let call = 0.02;
    let frames = (call * f64::from(RATE)) as usize;
    // Calls that come up to 10 ms early or late: each continues where the one before ended.
    for number in 0..20 {
        let late = if number % 2 == 0 { 0.01 } else { 0.0 };
        assert!(is_near(&bench.played(f64::from(number) * call + late, frames)[130..], 0.5), "call {number}");
    }
    // After a gap of two seconds the sound is over.
    assert!(is_near(&bench.played(2.5, 100), 0.0));
}

#[test]
fn filling_allocates_nothing_and_stays_within_full_scale() {
    let mut bench = VoiceBench::new();
    bench.play(|passed| 1.0 + passed.as_secs_f64(), 1.0);
    bench.played(0.0, 10);
    let mut out = vec![[0.0; 2]; 2_000];
    let at = bench.begun + Duration::from_millis(10);
    let (allocated, ()) = count(|| bench.voice.fill(at, RATE, &mut out));
    assert_eq!(allocated.bytes, 0);
    assert!(out.iter().flatten().all(|sample| sample.abs() <= 1.0));
}
