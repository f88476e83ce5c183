//! A rival: the shortest way to matrices that was found in a prototype, for takes that suit it.
//!
//! Its method, written anew with the vectors of this library:
//!
//! * keys at a uniform rate, all bones at each, so that two keys are two stretches of memory;
//! * rotations as three numbers of 16 bits within the range that each has in the whole take, the fourth from the length;
//!   which one is left out is chosen once for a bone and take, the one whose smallest magnitude is the largest;
//! * between keys a straight line, normalised; blocks of eight bones that do not move are copied;
//! * eight bones at once to matrices of three rows, then each times its parent, two rows in a register.
//!
//! It does less than the library: scale does not move, ranges are those of the whole take (8 mm of error on a finger of
//! a long one), nothing is checked, one interpolation. The prototype's approximate reciprocal root is an exact one
//! here.

mod take;

use crate::case::Case;
use crate::fast::{cast, ways};
use crate::model::Subject;
use crate::open::FRAMES;
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34, matrix34};
use dragonfly_anim::fast::simd::{Float4, Float8, Kernel, Level, Simd};
use dragonfly_anim::fast::{Pose, PoseBlock};
use std::hint::black_box;
use std::sync::Arc;
use take::SketchTake;

/// A subject in the sketch's layout.
struct Sketch {
    parents: Vec<u32>,
    joints: Vec<u32>,
    offsets: Vec<Matrix34>,
    takes: Vec<SketchTake>,
    bones: usize,
}

/// What a step works on.
struct State {
    pose: Pose,
    /// The identity first.
    roots: Vec<Matrix34>,
    finals: Vec<Matrix34>,
}

/// A step, or several.
struct Step<'a> {
    sketch: &'a Sketch,
    state: &'a mut State,
    take: usize,
    time: f32,
    what: What,
}

#[derive(Clone, Copy, PartialEq)]
enum What {
    Sample,
    ToRoot,
    Final,
    All,
}

impl Kernel for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { sketch, state, take, time, what } = self;
        if matches!(what, What::Sample | What::All) {
            sketch.takes[take].sample::<S>(time, state.pose.blocks_mut());
        }
        if matches!(what, What::ToRoot | What::All) {
            to_root::<S>(&sketch.parents, state.pose.blocks(), &mut state.roots);
        }
        if matches!(what, What::Final | What::All) {
            for ((out, &joint), offset) in state.finals.iter_mut().zip(&sketch.joints).zip(&sketch.offsets) {
                *out = product::<S>(&state.roots[joint as usize + 1], offset);
            }
        }
    }
}

#[inline(always)]
fn product<S: Simd>(a: &Matrix34, b: &Matrix34) -> Matrix34 {
    let (two, one) = (S::F8::load(a.first_chunk().unwrap()), S::F4::load(a.last_chunk().unwrap()));
    let rows = b.as_chunks::<4>().0;
    let (x, y, z) = (S::F8::twice(&rows[0]), S::F8::twice(&rows[1]), S::F8::twice(&rows[2]));
    let upper = two.spread::<0>().mul_add(x, two.keep_last());
    let lower = one.spread::<0>().mul_add(x.low(), one.keep_last());
    let upper = two.spread::<1>().mul_add(y, upper);
    let lower = one.spread::<1>().mul_add(y.low(), lower);
    let mut out = IDENTITY;
    two.spread::<2>().mul_add(z, upper).store(out.first_chunk_mut().unwrap());
    one.spread::<2>().mul_add(z.low(), lower).store(out.last_chunk_mut().unwrap());
    out
}

#[inline(always)]
fn to_root<S: Simd>(parents: &[u32], pose: &[PoseBlock], out: &mut [Matrix34]) {
    let mut local = [IDENTITY; 8];
    for (block, pose) in pose.iter().enumerate() {
        let [x, y, z, w] = S::F8::load_four(&pose.rotation);
        let [a, b, c] = S::F8::load_three(&pose.scale);
        let [tx, ty, tz] = S::F8::load_three(&pose.translation);
        let (x2, y2, z2, one) = (x + x, y + y, z + z, S::F8::splat(1.0));
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (not_x, not_y) = (x.neg_mul_add(x2, one), y.neg_mul_add(y2, one));
        let upper = [z.neg_mul_add(z2, not_y) * a, w.neg_mul_add(z2, xy) * b, w.mul_add(y2, xz) * c, tx];
        let middle = [w.mul_add(z2, xy) * a, z.neg_mul_add(z2, not_x) * b, w.neg_mul_add(x2, yz) * c, ty];
        let lower = [w.neg_mul_add(y2, xz) * a, w.mul_add(x2, yz) * b, y.neg_mul_add(y2, not_x) * c, tz];
        scatter::<S>(S::F8::transpose(upper), &mut local, 0);
        scatter::<S>(S::F8::transpose(middle), &mut local, 1);
        scatter::<S>(S::F8::transpose(lower), &mut local, 2);
        for (at, local) in local.iter().enumerate() {
            let bone = block * 8 + at;
            out[bone + 1] = product::<S>(&out[parents[bone] as usize], local);
        }
    }
}

/// One row of eight matrices.
#[inline(always)]
fn scatter<S: Simd>(twos: [S::F8; 4], local: &mut [Matrix34; 8], row: usize) {
    let [a, b, c, d, e, f, g, h] = local;
    twos[0].store_halves(&mut a.as_chunks_mut::<4>().0[row], &mut e.as_chunks_mut::<4>().0[row]);
    twos[1].store_halves(&mut b.as_chunks_mut::<4>().0[row], &mut f.as_chunks_mut::<4>().0[row]);
    twos[2].store_halves(&mut c.as_chunks_mut::<4>().0[row], &mut g.as_chunks_mut::<4>().0[row]);
    twos[3].store_halves(&mut d.as_chunks_mut::<4>().0[row], &mut h.as_chunks_mut::<4>().0[row]);
}

impl Sketch {
    fn new(subject: &Subject) -> Self {
        let skeleton = &subject.model.animation.skeleton;
        let bones = skeleton.len();
        let mut parents = vec![0; bones.div_ceil(8) * 8];
        for (slot, bone) in parents.iter_mut().zip(&skeleton.bones) {
            *slot = bone.parent.map_or(0, |parent| parent + 1);
        }
        let takes = subject.model.animation.takes.iter();
        Self {
            parents,
            joints: subject.skin().bones.clone(),
            offsets: subject.skin().offsets.iter().copied().map(matrix34).map(flushed).collect(),
            takes: takes.map(|take| SketchTake::new(skeleton, take)).collect(),
            bones,
        }
    }

    fn state(&self) -> State {
        State {
            pose: Pose::new(self.bones),
            roots: vec![IDENTITY; 1 + self.bones.div_ceil(8) * 8],
            finals: vec![IDENTITY; self.joints.len()],
        }
    }
}

/// Without subnormal numbers, as the fast path has it.
fn flushed(matrix: Matrix34) -> Matrix34 {
    matrix.map(|number| if number.abs() < 1e-12 { 0.0 } else { number })
}

pub(crate) fn cases(subject: &Subject) -> Vec<Case> {
    let (sketch, level) = (Arc::new(Sketch::new(subject)), Level::best());
    let (name, bones) = (subject.name, subject.bones());
    let mut cases = Vec::new();
    let mut case = |case: String, units: usize, unit, take: usize, times: Vec<f32>, what: What| {
        let (sketch, mut state) = (Arc::clone(&sketch), sketch.state());
        level.run(Step { sketch: &sketch, state: &mut state, take, time: times[0], what: What::All });
        cases.push(Case::new(format!("sketch/{case}"), units * times.len(), unit, move || {
            for &time in &times {
                level.run(Step { sketch: &sketch, state: &mut state, take, time, what });
                black_box(&state.finals);
                black_box(&state.pose);
            }
        }));
    };
    for (index, take) in subject.short_and_long() {
        for (way, times) in ways(take) {
            case(format!("sample/{name}/{}/{way}", take.name), bones, "bone", index, times, What::Sample);
        }
    }
    case(format!("to_root/{name}"), bones, "bone", 0, vec![0.3], What::ToRoot);
    case(format!("final/{name}"), subject.skin().bones.len(), "joint", 0, vec![0.3], What::Final);
    let (_, times) = ways(&subject.model.animation.takes[0])[0].clone();
    debug_assert_eq!(times.len(), FRAMES);
    case(format!("pipeline/{name}/1"), 1, "character", 0, times, What::All);
    cases.extend([100, 1_000].map(|count| crowd(subject, &sketch, level, count)));
    cases
}

fn crowd(subject: &Subject, sketch: &Arc<Sketch>, level: Level, count: usize) -> Case {
    let (sketch, mut state) = (Arc::clone(sketch), sketch.state());
    let mut cast = cast(subject, count);
    let mut out = vec![IDENTITY; sketch.joints.len() * count];
    let lengths: Vec<f32> = subject.model.animation.takes.iter().map(|take| take.length).collect();
    Case::new(format!("sketch/pipeline/{}/{count}", subject.name), count, "character", move || {
        for ((take, time, speed), out) in cast.iter_mut().zip(out.chunks_mut(sketch.joints.len())) {
            *time += *speed / 60.0;
            if *time >= lengths[*take] {
                *time -= lengths[*take];
            }
            level.run(Step { sketch: &sketch, state: &mut state, take: *take, time: *time, what: What::All });
            out.copy_from_slice(&state.finals);
        }
        black_box(&out);
    })
}
