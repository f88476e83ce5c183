//! Playback: times of a take, and crowds.

use crate::model::BenchModel;
use dragonfly_anim::data::Take;
use dragonfly_anim::sample::loop_time;
use dragonfly_kit::random::Random;

/// Number of frames played: somewhat more than a second at 60 Hz.
pub(crate) const FRAMES: usize = 80;

/// Returns the times of a take in three orders: forward and backward at 60 Hz, and random.
pub(crate) fn orders(take: &Take) -> [(&'static str, Vec<f32>); 3] {
    let mut random = Random::new(7);
    let forward = forward(take);
    let backward = forward.iter().rev().copied().collect();
    let anywhere = (0..256).map(|_| take.start + random.unit() * take.length).collect();
    [("forward", forward), ("backward", backward), ("random", anywhere)]
}

/// Returns [`FRAMES`] times of a take, forward at 60 Hz.
pub(crate) fn forward(take: &Take) -> Vec<f32> {
    (0..FRAMES).map(|frame| loop_time(take.start + frame as f32 / 60.0, take.start, take.length)).collect()
}

/// Numbers of characters in the crowds.
pub(crate) const CROWDS: [usize; 2] = [100, 1_000];

/// One character of a crowd: its take, time and speed.
#[derive(Clone, Copy)]
pub(crate) struct CrowdMember {
    pub(crate) take: usize,
    pub(crate) time: f32,
    start: f32,
    length: f32,
    speed: f32,
}

impl CrowdMember {
    /// Advances the time by a sixtieth of a second at the speed of the member, and starts again
    /// after the end of the take.
    pub(crate) fn step(&mut self) {
        self.time += self.speed / 60.0;
        if self.time >= self.start + self.length {
            self.time -= self.length;
        }
    }
}

/// Returns a crowd that plays the first three takes, each member at its own time and speed. The longest take is left out,
/// as in the prototype.
pub(crate) fn crowd(subject: &BenchModel, count: usize) -> Vec<CrowdMember> {
    let mut random = Random::new(3);
    let takes = &subject.model.animation.takes;
    let kinds = takes.len().clamp(1, 3);
    let member = |index: usize| {
        let take = index % kinds;
        let (start, length) = (takes[take].start, takes[take].length);
        CrowdMember {
            take,
            time: start + random.unit() * length,
            start,
            length,
            speed: random.between(0.8, 1.2),
        }
    };
    (0..count).map(member).collect()
}
