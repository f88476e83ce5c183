//! The sketch: the fastest methods of a prototype, from takes to matrices and vertices, for takes that suit them.
//!
//! The methods, written again with the vectors of this library:
//!
//! * keys at a uniform rate, all bones at each, so that two keys are two stretches of memory;
//! * rotations as three numbers of 16 bits within the range of each in the whole take, and the fourth from the length of 1;
//!   the component left out is chosen once per bone and take: the one whose smallest magnitude is the largest;
//! * linear interpolation between keys, normalized; blocks of eight bones that do not move are copied;
//! * eight bones at once to matrices of three rows, then each multiplied by its parent, two rows in a register;
//! * for crowds another method, eight characters at once: [`lockstep`];
//! * vertices by the weighted sum of matrices: [`skinning`].
//!
//! It does less than the library: scale is constant, ranges are those of the whole take (8 mm of error on a finger of a
//! long one), nothing is checked, and there is one interpolation. The prototype's approximate reciprocal square root is
//! exact here. Tiny numbers become zero when takes and offsets are converted, as in the library, because subnormal numbers
//! slow down every operation.

mod kernels;
mod lockstep;
mod skinning;
mod take;

use crate::case::BenchCase;
use crate::model::BenchModel;
use crate::play::{CROWDS, CrowdMember, FRAMES, crowd, forward, orders};
use dragonfly_anim::fast::Pose;
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34, matrix34};
use dragonfly_anim::fast::simd::{Kernel, Simd, SimdLevel};
use std::hint::black_box;
use std::sync::OnceLock;
use take::SketchTake;

/// A model in the layout of the sketch.
struct Sketch {
    subject: &'static BenchModel,
    /// Index in [`SketchBuffers::roots`] of each lane's parent: 0, the identity, for a root, otherwise 1 + the parent
    /// bone.
    parents: Vec<u32>,
    joints: Vec<u32>,
    offsets: Vec<Matrix34>,
    takes: OnceLock<Vec<SketchTake>>,
}

/// Buffers that characters use one after the other.
struct SketchBuffers {
    pose: Pose,
    /// To-root matrices; the identity is the first.
    roots: Vec<Matrix34>,
}

impl Sketch {
    fn new(subject: &'static BenchModel) -> &'static Self {
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

    fn buffers(&self) -> SketchBuffers {
        SketchBuffers { pose: Pose::new(self.subject.bones()), roots: vec![IDENTITY; 1 + self.parents.len()] }
    }

    /// Returns a buffer for the final matrices of `count` characters.
    fn finals(&self, count: usize) -> Vec<Matrix34> {
        vec![IDENTITY; self.joints.len() * count]
    }
}

/// Returns `number`, or zero where it is nearly subnormal.
fn flushed(number: f32) -> f32 {
    if number.abs() < 1e-12 { 0.0 } else { number }
}

/// Steps from takes to final matrices.
#[derive(Clone, Copy, PartialEq)]
enum Steps {
    Sample,
    ToRoot,
    Final,
    All,
}

/// Runs `steps` for one character after the other.
struct SketchRun<'a, I> {
    sketch: &'a Sketch,
    takes: &'a [SketchTake],
    buffers: &'a mut SketchBuffers,
    steps: Steps,
    /// Index of the take, and time, of each character.
    playing: I,
    out: &'a mut [Matrix34],
}

impl<I: Iterator<Item = (usize, f32)>> Kernel for SketchRun<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { sketch, takes, buffers, steps, playing, out } = self;
        for ((take, time), out) in playing.zip(out.chunks_exact_mut(sketch.joints.len())) {
            if matches!(steps, Steps::Sample | Steps::All) {
                takes[take].sample::<S>(time, buffers.pose.blocks_mut());
            }
            if matches!(steps, Steps::ToRoot | Steps::All) {
                kernels::to_root::<S>(&sketch.parents, buffers.pose.blocks(), &mut buffers.roots);
            }
            if matches!(steps, Steps::Final | Steps::All) {
                kernels::finals::<S>(&buffers.roots, &sketch.joints, &sketch.offsets, out);
            }
        }
    }
}

pub(crate) fn cases(subject: &'static BenchModel) -> Vec<BenchCase> {
    let (sketch, name) = (Sketch::new(subject), subject.name);
    let mut cases = Vec::new();
    for (index, take) in subject.short_and_long() {
        let group = format!("sample/{name}/{}", take.name);
        for (order, times) in orders(take) {
            let units = subject.bones() * times.len();
            let case = one(sketch, format!("{group}/{order}"), units, "bone", Steps::Sample, (index, times));
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

/// Returns the case of one character that plays one take at several times.
fn one(
    sketch: &'static Sketch,
    task: String,
    units: usize,
    unit: &'static str,
    steps: Steps,
    (take, times): (usize, Vec<f32>),
) -> BenchCase {
    BenchCase::new("sketch", task, units, unit, move || {
        let (takes, mut buffers, mut out) = (sketch.takes(), sketch.buffers(), sketch.finals(1));
        let mut go = move |time: f32, steps: Steps| {
            let (buffers, out) = (&mut buffers, &mut out);
            let playing = std::iter::once((take, time));
            SimdLevel::best().run(SketchRun { sketch, takes, buffers, steps, playing, out });
            black_box((&buffers.pose, &buffers.roots, &out));
        };
        go(times[0], Steps::All);
        move || times.iter().for_each(|&time| go(time, steps))
    })
}

fn many(sketch: &'static Sketch, count: usize) -> BenchCase {
    let task = format!("pipeline/{}/{count}", sketch.subject.name);
    BenchCase::new("sketch", task, count, "character", move || {
        let (takes, mut buffers, mut out) = (sketch.takes(), sketch.buffers(), sketch.finals(count));
        let mut crowd = crowd(sketch.subject, count);
        let level = SimdLevel::best();
        move || {
            let playing = crowd.iter_mut().map(|member: &mut CrowdMember| {
                member.step();
                (member.take, member.time)
            });
            let (buffers, out) = (&mut buffers, &mut out);
            level.run(SketchRun { sketch, takes, buffers, steps: Steps::All, playing, out });
            black_box(&out);
        }
    })
}
