//! The side of the device: it plays the newest command, from one of its calls to the next.

use crate::mix::SoundMix;
use flume::{Receiver, Sender};
use std::time::{Duration, Instant};

/// Difference between the time that plays and the time that is shown from which on playback jumps.
const MOST_DIFFERENCE: Duration = Duration::from_millis(60);

/// The time that is shown, as a function of the time that has passed.
pub struct SoundClock {
    /// The moment at which it was started.
    pub begun: Instant,
    /// Returns the time shown, seconds, after this much time; it may jump, as at the end of a loop.
    pub time_at: Box<dyn Fn(Duration) -> f64 + Send>,
    /// Seconds shown for each second that passes; negative backwards.
    pub speed: f64,
}

impl std::fmt::Debug for SoundClock {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "SoundClock({} x)", self.speed)
    }
}

/// A command for the device.
#[derive(Debug)]
pub enum OutputCommand {
    /// Play these sounds along this clock, instead of what plays now.
    Play(Box<SoundMix>, SoundClock),
    /// Be silent.
    Stop,
}

/// The side of the device. It allocates nothing and locks nothing that the main thread holds for long.
pub struct OutputVoice {
    commands: Receiver<OutputCommand>,
    freed: Sender<OutputCommand>,
    now: OutputCommand,
    /// Time that was filled since the start of the clock.
    filled: Duration,
}

impl OutputVoice {
    /// Returns a silent voice. What it no longer needs goes to `freed`.
    pub fn new(commands: Receiver<OutputCommand>, freed: Sender<OutputCommand>) -> Self {
        Self { commands, freed, now: OutputCommand::Stop, filled: Duration::ZERO }
    }

    /// Fills frames of left and right, from -1 to 1, `rate` of them a second; the first one plays at `at`.
    pub fn fill(&mut self, at: Instant, rate: u32, frames: &mut [[f32; 2]]) {
        while let Ok(command) = self.commands.try_recv() {
            let old = std::mem::replace(&mut self.now, command);
            // Without a receiver it is freed here.
            let _ = self.freed.try_send(old);
            if let OutputCommand::Play(_, clock) = &self.now {
                self.filled = at.saturating_duration_since(clock.begun);
            }
        }
        frames.fill([0.0; 2]);
        let OutputCommand::Play(mix, clock) = &mut self.now else { return };
        // The device counts its own time; where both drift apart, it follows the time that is shown.
        let passed = at.saturating_duration_since(clock.begun);
        if passed.abs_diff(self.filled) > MOST_DIFFERENCE {
            self.filled = passed;
        }
        // In parts, so that a jump of the clock is where it belongs.
        for part in frames.chunks_mut(256) {
            let seconds = part.len() as f64 / f64::from(rate.max(1));
            let after = self.filled + Duration::from_secs_f64(seconds);
            let [from, to] = [self.filled, after].map(&clock.time_at);
            // A clock that goes back and forth changes its direction; one that starts again jumps.
            let is_jump = (to - from).abs() > 1.5 * seconds * clock.speed.abs();
            let way = if is_jump { seconds * clock.speed } else { to - from };
            if way != 0.0 {
                mix.add(from, way / part.len() as f64, part);
            }
            self.filled = after;
        }
        for side in frames.as_flattened_mut() {
            *side = side.clamp(-1.0, 1.0);
        }
    }
}
