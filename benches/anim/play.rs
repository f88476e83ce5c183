//! What is played: times of a take, and crowds.

use crate::model::Subject;
use dragonfly_anim::data::Take;
use dragonfly_anim::sample::loop_time;
use dragonfly_kit::random::Random;

/// Frames of a second of play at 60 Hz, and somewhat more.
pub(crate) const FRAMES: usize = 80;

/// Orders in which a take's times come: forward and backward at 60 Hz, and at random.
pub(crate) fn ways(take: &Take) -> [(&'static str, Vec<f32>); 3] {
    let mut random = Random::new(7);
    let forward = forward(take);
    let backward = forward.iter().rev().copied().collect();
    let anywhere = (0..256).map(|_| take.start + random.unit() * take.length).collect();
    [("forward", forward), ("backward", backward), ("random", anywhere)]
}

/// [`FRAMES`] times of a take, forward at 60 Hz.
pub(crate) fn forward(take: &Take) -> Vec<f32> {
    (0..FRAMES).map(|frame| loop_time(take.start + frame as f32 / 60.0, take.start, take.length)).collect()
}

/// Sizes of the crowds.
pub(crate) const CROWDS: [usize; 2] = [100, 1_000];

/// One of a crowd: what it plays, where it is in it, and how fast it goes.
#[derive(Clone, Copy)]
pub(crate) struct Member {
    pub(crate) take: usize,
    pub(crate) time: f32,
    start: f32,
    length: f32,
    speed: f32,
}

impl Member {
    /// A sixtieth of a second later.
    pub(crate) fn step(&mut self) {
        self.time += self.speed / 60.0;
        if self.time >= self.start + self.length {
            self.time -= self.length;
        }
    }
}

/// A crowd that plays the first three takes, each at its own time and speed; the longest take is left out, as in the
/// prototype.
pub(crate) fn crowd(subject: &Subject, count: usize) -> Vec<Member> {
    let mut random = Random::new(3);
    let takes = &subject.model.animation.takes;
    let kinds = takes.len().clamp(1, 3);
    let member = |index: usize| {
        let take = index % kinds;
        let (start, length) = (takes[take].start, takes[take].length);
        Member { take, time: start + random.unit() * length, start, length, speed: random.between(0.8, 1.2) }
    };
    (0..count).map(member).collect()
}
