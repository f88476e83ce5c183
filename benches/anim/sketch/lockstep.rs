//! The sketch's other way for crowds: eight characters of one rig in lockstep, one a lane.
//!
//! A step of one bone is then the same step for eight characters, without anything to be turned from rows to columns;
//! in return their keys come from eight places, the matrices of eight characters have to stay near at hand, and the
//! final ones have to be turned in the end.
//!
//! Keys: four numbers of 16 bits a rotation, as whole numbers of 2/65,535 from -1 on; translations as they are. All bones
//! move. Between keys a straight line, the short way, normalised. It leaves out what the sketch leaves out, and plays whole
//! eights only: a crowd of 100 is one of 104 here, and told per character.

use super::kernels::{scatter, to_parent};
use super::{Sketch, flushed};
use crate::case::Case;
use crate::play::{CROWDS, crowd};
use dragonfly_anim::data::{Skeleton, Take, Transform};
use dragonfly_anim::fast::PoseBlock;
use dragonfly_anim::fast::matrix::{IDENTITY, Matrix34};
use dragonfly_anim::fast::simd::{Float8, Kernel, Simd, SimdLevel};
use dragonfly_anim::sample::sample_take;
use std::hint::black_box;

/// Eight matrices of three rows, one a lane.
type Matrices = [[f32; 8]; 12];

/// A take, key after key, all bones in each.
struct LaneTake {
    start: f32,
    rate: f32,
    frames: usize,
    rotations: Vec<[u16; 4]>,
    translations: Vec<[f32; 4]>,
}

/// What one character has at a time: the bones' keys before and after, and how far between.
#[derive(Clone, Copy)]
struct Between<'a> {
    rotations: [&'a [[u16; 4]]; 2],
    translations: [&'a [[f32; 4]]; 2],
    mix: f32,
}

impl LaneTake {
    fn new(skeleton: &Skeleton, take: &Take) -> Self {
        let frames = ((take.length * 30.0).round() as usize + 1).max(2);
        let rate = if take.length > 0.0 { (frames - 1) as f32 / take.length } else { 1.0 };
        let (mut rotations, mut translations) = (Vec::new(), Vec::new());
        let mut poses = vec![Transform::IDENTITY; skeleton.len()];
        for frame in 0..frames {
            sample_take(Some(take), skeleton, take.start + frame as f32 / rate, &mut poses);
            for pose in &poses {
                let steps = |number: f32| ((number + 1.0) * (65_535.0 / 2.0) + 0.5) as u16;
                rotations.push(pose.rotation.to_array().map(steps));
                translations.push(pose.translation.extend(0.0).to_array().map(flushed));
            }
        }
        Self { start: take.start, rate, frames, rotations, translations }
    }

    fn between(&self, time: f32, bones: usize) -> Between<'_> {
        let at = ((time - self.start) * self.rate).clamp(0.0, (self.frames - 1) as f32);
        let frame = (at as usize).min(self.frames - 2);
        let [before, after] = [frame * bones..(frame + 1) * bones, (frame + 1) * bones..(frame + 2) * bones];
        Between {
            rotations: [&self.rotations[before.clone()], &self.rotations[after.clone()]],
            translations: [&self.translations[before], &self.translations[after]],
            mix: at - frame as f32,
        }
    }
}

/// The poses of eight characters: a block a bone.
#[inline(always)]
fn sample<S: Simd>(eight: &[Between; 8], pose: &mut [PoseBlock]) {
    let mix = S::F8::load(&eight.map(|one| one.mix));
    for (bone, out) in pose.iter_mut().enumerate() {
        let (mut turns, mut places) = ([[[0_u16; 8]; 4]; 2], [[[0_f32; 8]; 3]; 2]);
        for (lane, one) in eight.iter().enumerate() {
            for key in 0..2 {
                let (turn, place) = (&one.rotations[key][bone], &one.translations[key][bone]);
                for at in 0..4 {
                    turns[key][at][lane] = turn[at];
                }
                for at in 0..3 {
                    places[key][at][lane] = place[at];
                }
            }
        }
        let ([ax, ay, az, aw], [bx, by, bz, bw]) = (unpack::<S>(&turns[0]), unpack::<S>(&turns[1]));
        let away = aw.mul_add(bw, az.mul_add(bz, ay.mul_add(by, ax * bx))).sign();
        let x = (bx.flipped_by(away) - ax).mul_add(mix, ax);
        let y = (by.flipped_by(away) - ay).mul_add(mix, ay);
        let z = (bz.flipped_by(away) - az).mul_add(mix, az);
        let w = (bw.flipped_by(away) - aw).mul_add(mix, aw);
        let length = w.mul_add(w, z.mul_add(z, y.mul_add(y, x * x)));
        let shrink = S::F8::splat(1.0) / length.sqrt();
        S::F8::store_four([x * shrink, y * shrink, z * shrink, w * shrink], &mut out.rotation);
        for (out, (before, after)) in out.translation.iter_mut().zip(places[0].iter().zip(&places[1])) {
            let (before, after) = (S::F8::load(before), S::F8::load(after));
            (after - before).mul_add(mix, before).store(out);
        }
    }
}

#[inline(always)]
fn unpack<S: Simd>(key: &[[u16; 8]; 4]) -> [S::F8; 4] {
    let (step, least) = (S::F8::splat(2.0 / 65_535.0), S::F8::splat(-1.0));
    [
        S::F8::from_u16(&key[0]).mul_add(step, least),
        S::F8::from_u16(&key[1]).mul_add(step, least),
        S::F8::from_u16(&key[2]).mul_add(step, least),
        S::F8::from_u16(&key[3]).mul_add(step, least),
    ]
}

/// Row `row` of eight products.
#[inline(always)]
fn row<S: Simd>(left: &Matrices, row: usize, [x, y, z]: &[[S::F8; 4]; 3]) -> [S::F8; 4] {
    let [a, b, c, d] = [left[row * 4], left[row * 4 + 1], left[row * 4 + 2], left[row * 4 + 3]];
    let (a, b, c, d) = (S::F8::load(&a), S::F8::load(&b), S::F8::load(&c), S::F8::load(&d));
    [
        c.mul_add(z[0], b.mul_add(y[0], a * x[0])),
        c.mul_add(z[1], b.mul_add(y[1], a * x[1])),
        c.mul_add(z[2], b.mul_add(y[2], a * x[2])),
        c.mul_add(z[3], b.mul_add(y[3], a.mul_add(x[3], d))),
    ]
}

/// `to_root` of each bone of eight characters; `out` begins with the identity.
#[inline(always)]
fn to_root<S: Simd>(parents: &[u32], pose: &[PoseBlock], out: &mut [Matrices]) {
    for (bone, (pose, &parent)) in pose.iter().zip(parents).enumerate() {
        let local = to_parent::<S>(pose);
        let parent = &out[parent as usize];
        let (x, y, z) =
            (row::<S>(parent, 0, &local), row::<S>(parent, 1, &local), row::<S>(parent, 2, &local));
        let to = out[bone + 1].as_chunks_mut::<4>().0;
        S::F8::store_four(x, &mut to[0]);
        S::F8::store_four(y, &mut to[1]);
        S::F8::store_four(z, &mut to[2]);
    }
}

/// The final matrices of eight characters, one character after the other.
#[inline(always)]
fn finals<S: Simd>(sketch: &Sketch, roots: &[Matrices], out: &mut [Matrix34]) {
    let mut turned = [IDENTITY; 8];
    for (at, (&joint, offset)) in sketch.joints.iter().zip(&sketch.offsets).enumerate() {
        let root = &roots[joint as usize + 1];
        let spread = [spread::<S>(offset, 0), spread::<S>(offset, 4), spread::<S>(offset, 8)];
        scatter::<S>(row::<S>(root, 0, &spread), &mut turned, 0);
        scatter::<S>(row::<S>(root, 1, &spread), &mut turned, 1);
        scatter::<S>(row::<S>(root, 2, &spread), &mut turned, 2);
        for (lane, matrix) in turned.iter().enumerate() {
            out[lane * sketch.joints.len() + at] = *matrix;
        }
    }
}

/// Four numbers from `first` on, each for all eight.
#[inline(always)]
fn spread<S: Simd>(matrix: &Matrix34, first: usize) -> [S::F8; 4] {
    [
        S::F8::splat(matrix[first]),
        S::F8::splat(matrix[first + 1]),
        S::F8::splat(matrix[first + 2]),
        S::F8::splat(matrix[first + 3]),
    ]
}

struct ToRoot<'a> {
    parents: &'a [u32],
    pose: &'a [PoseBlock],
    out: &'a mut [Matrices],
}

impl Kernel for ToRoot<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        to_root::<S>(self.parents, self.pose, self.out);
    }
}

/// From takes to final matrices, eight characters after eight.
struct Crowd<'a, I> {
    sketch: &'a Sketch,
    takes: &'a [LaneTake],
    pose: &'a mut [PoseBlock],
    roots: &'a mut [Matrices],
    /// What each of eight plays, and when.
    eights: I,
    out: &'a mut [Matrix34],
}

impl<I: Iterator<Item = [(usize, f32); 8]>> Kernel for Crowd<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { sketch, takes, pose, roots, eights, out } = self;
        for (eight, out) in eights.zip(out.chunks_exact_mut(sketch.joints.len() * 8)) {
            let eight = eight.map(|(take, time)| takes[take].between(time, pose.len()));
            sample::<S>(&eight, pose);
            to_root::<S>(&sketch.parents, pose, roots);
            finals::<S>(sketch, roots, out);
        }
    }
}

/// The identity first, then room for each bone.
fn roots(bones: usize) -> Vec<Matrices> {
    vec![IDENTITY.map(|number| [number; 8]); 1 + bones]
}

pub(super) fn cases(sketch: &'static Sketch) -> Vec<Case> {
    let mut cases = vec![chain(sketch)];
    cases.extend(CROWDS.map(|count| many(sketch, count)));
    cases
}

fn takes(sketch: &Sketch) -> Vec<LaneTake> {
    let animation = &sketch.subject.model.animation;
    animation.takes.iter().take(3).map(|take| LaneTake::new(&animation.skeleton, take)).collect()
}

fn chain(sketch: &'static Sketch) -> Case {
    let bones = sketch.subject.bones();
    Case::new("lockstep", format!("to_root/{}", sketch.subject.name), bones * 8, "bone", move || {
        let pose: Vec<PoseBlock> = crate::inputs::posed(sketch.subject, 0, 0.4)
            .into_iter()
            .map(|transform| {
                let mut block = PoseBlock::IDENTITY;
                (0..8).for_each(|lane| block.set(lane, transform));
                block
            })
            .collect();
        let (mut out, level) = (roots(bones), SimdLevel::best());
        move || {
            level.run(ToRoot { parents: &sketch.parents, pose: &pose, out: &mut out });
            black_box(&out);
        }
    })
}

fn many(sketch: &'static Sketch, count: usize) -> Case {
    let row = format!("pipeline/{}/{count}", sketch.subject.name);
    let count = count.next_multiple_of(8);
    Case::new("lockstep", row, count, "character", move || {
        let (takes, bones) = (takes(sketch), sketch.subject.bones());
        let (mut pose, mut roots) = (vec![PoseBlock::IDENTITY; bones], roots(bones));
        let (mut out, level) = (sketch.finals(count), SimdLevel::best());
        let mut crowd = crowd(sketch.subject, count);
        move || {
            let eights = crowd.as_chunks_mut::<8>().0.iter_mut().map(|eight| {
                eight.each_mut().map(|member| {
                    member.step();
                    (member.take, member.time)
                })
            });
            let (takes, pose, roots, out) = (&takes, &mut pose, &mut roots, &mut out);
            level.run(Crowd { sketch, takes, pose, roots, eights, out });
            black_box(out);
        }
    })
}
