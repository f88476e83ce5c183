//! From takes to final matrices: one character, one that plays two takes, and crowds.

use super::{Form, Ready};
use crate::case::Case;
use crate::play::{CROWDS, FRAMES, crowd, forward};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{Playing, Scratch, matrix, pose_character, pose_crowd};
use std::hint::black_box;

pub(super) fn cases<F: Form>(ready: &'static Ready, level: SimdLevel) -> Vec<Case> {
    let mut cases = vec![one::<F>(ready, level), one_of_two::<F>(ready, level)];
    cases.extend(CROWDS.map(|count| many::<F>(ready, level, count)));
    cases
}

fn one<F: Form>(ready: &'static Ready, level: SimdLevel) -> Case {
    let row = format!("pipeline/{}/1", ready.subject.name);
    Case::new(F::way(level), row, FRAMES, "character", move || {
        let (take, times) = (&F::takes(ready)[0], forward(&ready.subject.model.animation.takes[0]));
        let (mut scratch, mut finals) = (Scratch::new(&ready.rig), ready.finals());
        move || {
            for &time in &times {
                let layers = [Playing::new(take, time)];
                pose_character(level, &ready.rig, &ready.binding, &layers, &mut scratch, &mut finals);
                black_box(&finals);
            }
        }
    })
}

fn one_of_two<F: Form>(ready: &'static Ready, level: SimdLevel) -> Case {
    let row = format!("pipeline/{}/1_of_2_takes", ready.subject.name);
    Case::new(F::way(level), row, FRAMES, "character", move || {
        let takes = F::takes(ready);
        let times = forward(&ready.subject.model.animation.takes[0]);
        let second = 1 % takes.len();
        let (mut scratch, mut finals) = (Scratch::new(&ready.rig), ready.finals());
        move || {
            for &time in &times {
                let half = |take: usize| Playing { weight: 0.5, ..Playing::new(&takes[take], time) };
                let layers = [half(0), half(second)];
                pose_character(level, &ready.rig, &ready.binding, &layers, &mut scratch, &mut finals);
                black_box(&finals);
            }
        }
    })
}

fn many<F: Form>(ready: &'static Ready, level: SimdLevel, count: usize) -> Case {
    let row = format!("pipeline/{}/{count}", ready.subject.name);
    Case::new(F::way(level), row, count, "character", move || {
        let takes = F::takes(ready);
        let mut crowd = crowd(ready.subject, count);
        let play = |member: &crate::play::Member| [Playing::new(&takes[member.take], member.time)];
        let mut playing: Vec<[Playing<F>; 1]> = crowd.iter().map(play).collect();
        let mut scratch = Scratch::new(&ready.rig);
        let mut finals = vec![matrix::IDENTITY; ready.binding.joints() * count];
        move || {
            for (member, playing) in crowd.iter_mut().zip(&mut playing) {
                member.step();
                playing[0].time = member.time;
            }
            let characters = playing.iter().map(|layers| layers.as_slice());
            pose_crowd(level, &ready.rig, &ready.binding, characters, &mut scratch, &mut finals);
            black_box(&finals);
        }
    })
}
