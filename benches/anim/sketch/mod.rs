//! A rival: the shortest ways to matrices and vertices that were found in a prototype, for takes that suit it.
//!
//! Its methods, written anew with the vectors of this library:
//!
//! * keys at a uniform rate, all bones at each, so that two keys are two stretches of memory;
//! * rotations as three numbers of 16 bits within the range that each has in the whole take, the fourth from the length;
//!   which one is left out is chosen once for a bone and take, the one whose smallest magnitude is the largest;
//! * between keys a straight line, normalised; blocks of eight bones that do not move are copied;
//! * eight bones at once to matrices of three rows, then each times its parent, two rows in a register;
//! * for crowds another way, eight characters at once: [`lockstep`];
//! * vertices by the weighted sum of matrices: [`skinning`].
//!
//! It does less than the library: scale does not move, ranges are those of the whole take (8 mm of error on a finger of
//! a long one), nothing is checked, one interpolation. The prototype's approximate reciprocal root is an exact one
//! here. Tiny numbers are made zero when takes and offsets are brought to its layout, as the library does it, because
//! numbers too small for the usual form cost time in any sum.

mod kernels;
mod lockstep;
mod skinning;
mod take;

use crate::case::Case;
use crate::model::Subject;
use crate::play::{CROWDS, FRAMES, Member, crowd, forward, ways};
use dragonfly_anim::fast::Pose;
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34, matrix34};
use dragonfly_anim::fast::simd::{Kernel, Simd, SimdLevel};
use std::hint::black_box;
use std::sync::OnceLock;
use take::SketchTake;

/// A subject in the sketch's layout.
struct Sketch {
    subject: &'static Subject,
    /// One a lane: 0 for a root, else 1 + the parent.
    parents: Vec<u32>,
    joints: Vec<u32>,
    offsets: Vec<Matrix34>,
    takes: OnceLock<Vec<SketchTake>>,
}

/// Memory that characters use one after the other.
struct Room {
    pose: Pose,
    /// The identity first.
    roots: Vec<Matrix34>,
}

impl Sketch {
    fn new(subject: &'static Subject) -> &'static Self {
        let skeleton = &subject.model.animation.skeleton;
        let mut parents = vec![0; skeleton.len().div_ceil(8) * 8];
        for (slot, bone) in parents.iter_mut().zip(&skeleton.bones) {
            *slot = bone.parent.map_or(0, |parent| parent + 1);
        }
        let offsets = subject.skin().offsets.iter();
        Box::leak(Box::new(Self {
            subject,
            parents,
            joints: subject.skin().bones.clone(),
            offsets: offsets.map(|&offset| matrix34(offset).map(flushed)).collect(),
            takes: OnceLock::new(),
        }))
    }

    fn takes(&self) -> &[SketchTake] {
        let animation = &self.subject.model.animation;
        let made = |take| SketchTake::new(&animation.skeleton, take);
        self.takes.get_or_init(|| animation.takes.iter().map(|take| made(take)).collect())
    }

    fn room(&self) -> Room {
        Room { pose: Pose::new(self.subject.bones()), roots: vec![IDENTITY; 1 + self.parents.len()] }
    }

    /// Room for the final matrices of `count` characters.
    fn finals(&self, count: usize) -> Vec<Matrix34> {
        vec![IDENTITY; self.joints.len() * count]
    }
}

/// Without the numbers that are too small for the usual form.
fn flushed(number: f32) -> f32 {
    if number.abs() < 1e-12 { 0.0 } else { number }
}

/// Steps on the way from takes to final matrices.
#[derive(Clone, Copy, PartialEq)]
enum Steps {
    Sample,
    ToRoot,
    Final,
    All,
}

/// Takes `steps` for one character after the other.
struct Take<'a, I> {
    sketch: &'a Sketch,
    takes: &'a [SketchTake],
    room: &'a mut Room,
    steps: Steps,
    /// What each plays, and when.
    playing: I,
    out: &'a mut [Matrix34],
}

impl<I: Iterator<Item = (usize, f32)>> Kernel for Take<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { sketch, takes, room, steps, playing, out } = self;
        for ((take, time), out) in playing.zip(out.chunks_exact_mut(sketch.joints.len())) {
            if matches!(steps, Steps::Sample | Steps::All) {
                takes[take].sample::<S>(time, room.pose.blocks_mut());
            }
            if matches!(steps, Steps::ToRoot | Steps::All) {
                kernels::to_root::<S>(&sketch.parents, room.pose.blocks(), &mut room.roots);
            }
            if matches!(steps, Steps::Final | Steps::All) {
                kernels::finals::<S>(&room.roots, &sketch.joints, &sketch.offsets, out);
            }
        }
    }
}

pub(crate) fn cases(subject: &'static Subject) -> Vec<Case> {
    let (sketch, name) = (Sketch::new(subject), subject.name);
    let mut cases = Vec::new();
    for (index, take) in subject.short_and_long() {
        let group = format!("sample/{name}/{}", take.name);
        for (way, times) in ways(take) {
            let units = subject.bones() * times.len();
            let case = one(sketch, format!("{group}/{way}"), units, "bone", Steps::Sample, (index, times));
            cases.push(case.among(&group));
        }
    }
    let now = (0, vec![0.3]);
    cases.push(one(sketch, format!("to_root/{name}"), subject.bones(), "bone", Steps::ToRoot, now.clone()));
    cases.push(one(sketch, format!("final/{name}"), sketch.joints.len(), "joint", Steps::Final, now));
    let times = forward(&subject.model.animation.takes[0]);
    cases.push(one(sketch, format!("pipeline/{name}/1"), FRAMES, "character", Steps::All, (0, times)));
    cases.extend(CROWDS.map(|count| many(sketch, count)));
    cases.extend(skinning::cases(subject));
    cases.extend(lockstep::cases(sketch));
    cases
}

/// One character that plays one take at several times.
fn one(
    sketch: &'static Sketch,
    row: String,
    units: usize,
    unit: &'static str,
    steps: Steps,
    (take, times): (usize, Vec<f32>),
) -> Case {
    Case::new("sketch", row, units, unit, move || {
        let (takes, mut room, mut out) = (sketch.takes(), sketch.room(), sketch.finals(1));
        let mut go = move |time: f32, steps: Steps| {
            let (room, out) = (&mut room, &mut out);
            let playing = std::iter::once((take, time));
            SimdLevel::best().run(Take { sketch, takes, room, steps, playing, out });
            black_box((&room.pose, &room.roots, &out));
        };
        go(times[0], Steps::All);
        move || times.iter().for_each(|&time| go(time, steps))
    })
}

fn many(sketch: &'static Sketch, count: usize) -> Case {
    let row = format!("pipeline/{}/{count}", sketch.subject.name);
    Case::new("sketch", row, count, "character", move || {
        let (takes, mut room, mut out) = (sketch.takes(), sketch.room(), sketch.finals(count));
        let mut crowd = crowd(sketch.subject, count);
        let level = SimdLevel::best();
        move || {
            let playing = crowd.iter_mut().map(|member: &mut Member| {
                member.step();
                (member.take, member.time)
            });
            let (room, out) = (&mut room, &mut out);
            level.run(Take { sketch, takes, room, steps: Steps::All, playing, out });
            black_box(&out);
        }
    })
}
